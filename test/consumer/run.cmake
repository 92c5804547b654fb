# SPDX-License-Identifier: BSD-3-Clause
# Installs a build of pcl_bsh to an empty prefix, then configures, builds and runs this project against it.
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -P run.cmake
cmake_minimum_required(VERSION 3.25)
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --install "${PCL_BSH_BUILD}" --prefix "${WORK}/prefix")

run(${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D
    "CMAKE_PREFIX_PATH=${WORK}/prefix")
execute_process(COMMAND ${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/refused" -G Ninja -D
                        "CMAKE_PREFIX_PATH=${WORK}/prefix" -D PCL_BSH_COMPONENTS=tree RESULT_VARIABLE status
                OUTPUT_QUIET ERROR_VARIABLE text)
if(status EQUAL 0 OR NOT text MATCHES "no[ \n]+component[ \n]+tree")
  message(FATAL_ERROR "the component `tree` was not refused by its name: status ${status}, ${text}")
endif()

# What is installed to copy from is built with what is installed.
file(GLOB samples "${WORK}/prefix/share/doc/pcl_bsh/cpp")
run(${CMAKE_COMMAND} -S "${samples}" -B "${WORK}/samples" -G Ninja -D CMAKE_BUILD_TYPE=Debug -D
    "CMAKE_PREFIX_PATH=${WORK}/prefix" -D "CMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror")
run(${CMAKE_COMMAND} --build "${WORK}/samples")
foreach(program IN ITEMS filter_chain search_chain own_stage)
  execute_process(COMMAND "${WORK}/samples/pcl_bsh_${program}" RESULT_VARIABLE status ERROR_VARIABLE text)
  if(NOT status EQUAL 2 OR NOT text MATCHES "^usage: pcl_bsh_${program} ")
    message(FATAL_ERROR "pcl_bsh_${program}: status ${status}, ${text}")
  endif()
endforeach()
run(${CMAKE_COMMAND} --build "${WORK}/build")
run("${WORK}/build/core_only")
run("${WORK}/build/own_point_type")
run("${WORK}/build/site_error")
if(EXISTS "${WORK}/build/certified")
  run("${WORK}/build/certified")
endif()
if(EXISTS "${WORK}/build/spheres_file")
  run("${WORK}/build/spheres_file" "${WORK}/spheres.vtp")
endif()
