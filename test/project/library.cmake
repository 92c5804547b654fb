# SPDX-License-Identifier: BSD-3-Clause
# The preset library: built, installed, and used by another project. Without optimisation, for the flags of the preset are
# those of the release build; so assertions are compiled once, too.
#   cmake -D WORK=<folder of its own> -P library.cmake
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${test}/.." COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --preset library -B "${WORK}/library" -D CMAKE_BUILD_TYPE=Debug)
run(${CMAKE_COMMAND} --build "${WORK}/library")
run(${CMAKE_COMMAND} --install "${WORK}/library" --prefix "${WORK}/prefix")

set(consumer ${CMAKE_COMMAND} -S "${test}/consumer" -G Ninja -D CMAKE_BUILD_TYPE=Debug -D "CMAKE_PREFIX_PATH=${WORK}/prefix")
run(${consumer} -B "${WORK}/consumer" -D "PCL_BSH_COMPONENTS=core;search;filters")
run(${CMAKE_COMMAND} --build "${WORK}/consumer")
run("${WORK}/consumer/core_only")
run("${WORK}/consumer/own_point_type")
execute_process(COMMAND ${consumer} -B "${WORK}/refused" -D "PCL_BSH_COMPONENTS=pipeline" RESULT_VARIABLE status
                OUTPUT_QUIET ERROR_VARIABLE text)
if(status EQUAL 0 OR NOT text MATCHES "PCL_BSH_BUILD_PIPELINES")
  message(FATAL_ERROR "the component pipeline was not refused by the name of its switch: status ${status}, ${text}")
endif()
