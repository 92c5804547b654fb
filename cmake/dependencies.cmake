# SPDX-License-Identifier: BSD-3-Clause
# Everything comes from the packages listed in packages.txt: what core, search and filters need, then what is shared by
# components. A package that only one component needs is looked for in the component's CMakeLists.txt.

if(NOT PROJECT_IS_TOP_LEVEL)
  set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON) # whoever links our libraries sees what these link
endif()
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED) # headers of Multiprecision
find_package(TBB 2021 REQUIRED CONFIG)
find_package(hwy 1.0 REQUIRED CONFIG)
if(PCL_BSH_WITHOUT_PCL OR PCL_BSH_BUILD_PIPELINES OR PCL_BSH_BUILD_SITES OR PCL_BSH_BUILD_VTK)
  find_package(nlohmann_json 3.11 REQUIRED CONFIG)
  find_package(FastFloat REQUIRED CONFIG) # 3 or later: its package names itself compatible with its own major version alone
  find_package(pugixml 1.10 REQUIRED CONFIG)
endif()
if(PCL_BSH_BUILD_TOOLS)
  find_package(CLI11 2 REQUIRED CONFIG)
endif()
# Without what they need, tests are left out: who only runs the programs need not install it.
if(PCL_BSH_BUILD_TESTS)
  find_package(GTest 1.12 QUIET CONFIG)
  find_package(nanoflann 1.4 QUIET CONFIG)
  if(NOT GTest_FOUND OR NOT nanoflann_FOUND)
    message(STATUS "No tests: GoogleTest or nanoflann (libgtest-dev, libgmock-dev, libnanoflann-dev) is not found")
    set(PCL_BSH_BUILD_TESTS OFF)
  endif()
endif()
if(PCL_BSH_WITHOUT_PCL)
  return()
endif()

set(pcl_components common search filters)
if(PCL_BSH_BUILD_PIPELINES OR PCL_BSH_BUILD_SITES)
  find_path(KAINJOW_INCLUDE_DIR kainjow/mustache.hpp REQUIRED)
  mark_as_advanced(KAINJOW_INCLUDE_DIR)
  find_package(pugixml 1.12 REQUIRED CONFIG)
  find_path(LIBZIP_INCLUDE_DIR zip.h REQUIRED) # its CMake package asks for programs of other Debian packages
  find_library(LIBZIP_LIBRARY zip REQUIRED)
  mark_as_advanced(LIBZIP_INCLUDE_DIR LIBZIP_LIBRARY)
  list(APPEND pcl_components features segmentation)
endif()
if(PCL_BSH_BUILD_TESTS OR PCL_BSH_BUILD_TOOLS) # algorithms that are given our search class
  list(APPEND pcl_components io features segmentation keypoints registration surface)
endif()
# Tests read and write clouds by pcl_io, and need nothing of what it would drag in for cameras and windows.
set(unwanted VTK OpenNI OpenNI2 libusb)
foreach(package IN LISTS unwanted)
  set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON)
endforeach()
list(REMOVE_DUPLICATES pcl_components)
find_package(PCL 1.13 REQUIRED QUIET COMPONENTS ${pcl_components})
foreach(package IN LISTS unwanted)
  unset(CMAKE_DISABLE_FIND_PACKAGE_${package})
endforeach()

if(PCL_BSH_BUILD_BENCHMARKS)
  find_package(nanoflann 1.4 REQUIRED CONFIG)
endif()
