# SPDX-License-Identifier: BSD-3-Clause
# The project as a part of another one, which lies in a folder with nothing else: by FetchContent of a local path, and by
# add_subdirectory().
#
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -D WERROR=ON -P subdirectory.cmake
# WERROR: as that build has it
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
cmake_path(GET test PARENT_PATH root)
include("${CMAKE_CURRENT_LIST_DIR}/reuse.cmake")

file(REMOVE_RECURSE "${WORK}")
foreach(way IN ITEMS FetchContent=_deps/pcl_bsh-build add_subdirectory=pcl_bsh)
  string(REPLACE "=" ";" prefix "${way}")
  list(POP_FRONT prefix way)
  set(parent "${WORK}/${way}")
  file(COPY "${CMAKE_CURRENT_LIST_DIR}/subdirectory/CMakeLists.txt" "${test}/consumer/core_only.cpp"
            "${test}/consumer/own_point_type.cpp" DESTINATION "${parent}")
  set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${PCL_BSH_REUSE};${prefix}")
  run(${CMAKE_COMMAND} -S "${parent}" -B "${parent}/build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_EXPORT_COMPILE_COMMANDS=ON
      -D "PCL_BSH_SOURCES=${root}" -D "WAY=${way}" -D "PCL_BSH_WERROR=${WERROR}")
  unset(ENV{CMAKE_CXX_COMPILER_LAUNCHER})
  pcl_bsh_list_reused("${parent}/build" "${prefix}")
  run(${CMAKE_COMMAND} --build "${parent}/build")
  run("${parent}/build/core_only")
  run("${parent}/build/own_point_type")

  execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir "${parent}/build" -N OUTPUT_VARIABLE tests)
  if(NOT tests MATCHES "Total Tests: 0")
    message(FATAL_ERROR "${way}: pcl_bsh's tests are among those of its parent: ${tests}")
  endif()
  run(${CMAKE_COMMAND} --install "${parent}/build" --prefix "${parent}/prefix")
  file(GLOB_RECURSE installed RELATIVE "${parent}/prefix" "${parent}/prefix/*")
  if(NOT installed STREQUAL "bin/core_only")
    message(FATAL_ERROR "${way}: its parent installs '${installed}'")
  endif()
endforeach()
