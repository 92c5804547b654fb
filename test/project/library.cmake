# SPDX-License-Identifier: BSD-3-Clause
# The preset library: built, installed, and used by another project. Objects that another build compiles by the same
# commands are taken from there.
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -D WERROR=ON -P library.cmake
# WERROR: as that build has it
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
include("${CMAKE_CURRENT_LIST_DIR}/reuse.cmake")

file(REMOVE_RECURSE "${WORK}")
set(library "${WORK}/library")
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${PCL_BSH_REUSE};.")
run(${CMAKE_COMMAND} --preset library -S "${test}/.." -B "${library}" -D "PCL_BSH_WERROR=${WERROR}")
unset(ENV{CMAKE_CXX_COMPILER_LAUNCHER})
pcl_bsh_list_reused("${library}" ".")
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
