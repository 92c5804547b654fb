# SPDX-License-Identifier: BSD-3-Clause
# The preset library: built, installed, and used by another project. Objects that another build compiles by the same
# commands are taken from there.
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -P library.cmake
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${test}/.." COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# What the compiler is told in a build, without the folder and what launches it.
function(read_commands build result)
  file(STRINGS "${build}/compile_commands.json" lines REGEX "^ *\"command\": ")
  list(TRANSFORM lines REPLACE "${build}" "")
  list(TRANSFORM lines REPLACE "^.*(clang|g|c)[+][+] " "")
  set(${result} "${lines}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK}")
set(library "${WORK}/library")
set(list "${WORK}/reused.txt")
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "bash;${CMAKE_CURRENT_LIST_DIR}/reuse.sh;${PCL_BSH_BUILD};${list}")
run(${CMAKE_COMMAND} --preset library -B "${library}" -D PCL_BSH_WERROR=ON)
unset(ENV{CMAKE_CXX_COMPILER_LAUNCHER})
read_commands("${library}" wanted)
read_commands("${PCL_BSH_BUILD}" compiled)
foreach(command IN LISTS wanted)
  if(command IN_LIST compiled AND command MATCHES " -o ([^ ]+) ")
    file(APPEND "${list}" "${CMAKE_MATCH_1}\n")
  endif()
endforeach()
run(${CMAKE_COMMAND} --build "${library}")
run(${CMAKE_COMMAND} --install "${library}" --prefix "${WORK}/prefix")

set(consumer ${CMAKE_COMMAND} -S "${test}/consumer" -G Ninja -D CMAKE_BUILD_TYPE=Debug -D "CMAKE_PREFIX_PATH=${WORK}/prefix")
run(${consumer} -B "${WORK}/consumer" -D "PCL_BSH_COMPONENTS=core\;search\;filters")
run(${CMAKE_COMMAND} --build "${WORK}/consumer")
run("${WORK}/consumer/core_only")
run("${WORK}/consumer/own_point_type")
execute_process(COMMAND ${consumer} -B "${WORK}/refused" -D "PCL_BSH_COMPONENTS=pipeline" RESULT_VARIABLE status
                OUTPUT_QUIET ERROR_VARIABLE text)
if(status EQUAL 0 OR NOT text MATCHES "PCL_BSH_BUILD_PIPELINES")
  message(FATAL_ERROR "the component pipeline was not refused by the name of its switch: status ${status}, ${text}")
endif()
