# SPDX-License-Identifier: BSD-3-Clause
# Programs in a folder with nothing else, compiled against the installed libraries by what pkg-config says of them.
#   cmake -D PREFIX=<where they are installed> -D WORK=<folder of its own> -D CXX=g++ -P pkg_config.cmake
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message("skipped: pkg-config is not installed: install pkgconf")
  return()
endif()
file(GLOB files "${PREFIX}/lib*/pkgconfig/pcl_bsh_*.pc" "${PREFIX}/lib*/*/pkgconfig/pcl_bsh_*.pc")
if(NOT files)
  message(FATAL_ERROR "${PREFIX}: holds no .pc file")
endif()
list(GET files 0 folder)
cmake_path(GET folder PARENT_PATH folder)
cmake_path(GET folder PARENT_PATH libraries)
set(ENV{PKG_CONFIG_PATH} "${folder}")
foreach(file IN LISTS files) # each can be used: what it requires is there
  cmake_path(GET file STEM name)
  execute_process(COMMAND "${PKG_CONFIG}" --cflags --libs "${name} >= 0.1" OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()

file(REMOVE_RECURSE "${WORK}")
foreach(program IN ITEMS core_only=pcl_bsh_core own_point_type=pcl_bsh_filters)
  string(REPLACE "=" ";" library "${program}")
  list(POP_FRONT library program)
  file(COPY "${test}/consumer/${program}.cpp" DESTINATION "${WORK}")
  execute_process(COMMAND "${PKG_CONFIG}" --cflags --libs ${library} OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  execute_process(COMMAND "${CXX}" -std=c++17 ${program}.cpp ${flags} "-Wl,-rpath,${libraries}" -o ${program}
                  WORKING_DIRECTORY "${WORK}" COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${WORK}/${program}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
