# SPDX-License-Identifier: BSD-3-Clause
# Fails unless a header compiles alone, and under the flag given is refused with a message of ours.
#   cmake -D CXX=g++ -D INCLUDES=/usr/include/eigen3 -D HEADER=pcl_bsh/geometry/rounding.h -D FLAG=-ffast-math
#         -D "MESSAGE=cannot be compiled with -ffast-math" -P refused_flags.cmake
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH root)

set(command ${CXX} -std=c++17 -fsyntax-only -x c++ "-I${root}")
foreach(folder IN LISTS INCLUDES)
  list(APPEND command -isystem "${folder}")
endforeach()

execute_process(COMMAND ${command} "${root}/${HEADER}" RESULT_VARIABLE failure ERROR_VARIABLE said)
if(failure)
  message(FATAL_ERROR "${HEADER} does not compile at all:\n${said}")
endif()

execute_process(COMMAND ${command} ${FLAG} "${root}/${HEADER}" RESULT_VARIABLE failure ERROR_VARIABLE said)
if(NOT failure)
  message(FATAL_ERROR "${HEADER} compiles with ${FLAG}, which it must refuse")
endif()
string(FIND "${said}" "${MESSAGE}" place)
if(place EQUAL -1)
  message(FATAL_ERROR "${HEADER} with ${FLAG} fails, but not with '${MESSAGE}':\n${said}")
endif()
