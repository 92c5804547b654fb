# SPDX-License-Identifier: BSD-3-Clause
# PCL's test/search/test_search.cpp and test_kdtree.cpp, compiled as they are; a header in front of them puts our class
# in place of their KdTree. They are not copied here: PCL_SOURCE_TEST_DIR, a variable of CMake's cache or of the
# environment (which counts where both are set), names the folder test/ of a source tree of the PCL in use.
set(PCL_SOURCE_TEST_DIR "" CACHE PATH "PCL's folder test/: its own tests of search classes are run on ours")
if(NOT "$ENV{PCL_SOURCE_TEST_DIR}" STREQUAL "")
  get_filename_component(given "$ENV{PCL_SOURCE_TEST_DIR}" ABSOLUTE BASE_DIR "${PROJECT_SOURCE_DIR}")
  set_property(CACHE PCL_SOURCE_TEST_DIR PROPERTY VALUE "${given}")
endif()
if(NOT PCL_SOURCE_TEST_DIR)
  pcl_bsh_not_tested("PCL's own tests of search classes" "set PCL_SOURCE_TEST_DIR to the folder test/ of PCL's sources")
  return()
endif()

function(pcl_bsh_add_conformance_test name)
  set(source "${PCL_SOURCE_TEST_DIR}/search/${name}.cpp")
  if(NOT EXISTS "${source}")
    pcl_bsh_not_tested("${source}" "it does not exist: set PCL_SOURCE_TEST_DIR to the folder test/ of PCL's sources")
    return()
  endif()
  add_executable(pcl_${name} "${source}")
  set_target_properties(pcl_${name} PROPERTIES CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON)
  target_compile_options(pcl_${name} PRIVATE -include "${CMAKE_CURRENT_SOURCE_DIR}/search/in_place_of_kdtree.h" -w)
  target_include_directories(pcl_${name} PRIVATE "${PCL_SOURCE_TEST_DIR}/include" "${PROJECT_SOURCE_DIR}")
  target_link_libraries(pcl_${name} PRIVATE pcl_bsh_search pcl_search pcl_octree pcl_kdtree pcl_io GTest::gtest)
  add_test(NAME pcl/${name} COMMAND pcl_${name} ${ARGN})
  set_tests_properties(pcl/${name} PROPERTIES LABELS pcl TIMEOUT 300)
endfunction()

pcl_bsh_add_conformance_test(test_search "${PCL_SOURCE_TEST_DIR}/table_scene_mug_stereo_textured.pcd")
pcl_bsh_add_conformance_test(test_kdtree)
