# SPDX-License-Identifier: BSD-3-Clause
# For find_package(pcl_bsh). Components: libs, dev (headers, CMake package), with the programs tools, with VTK vtk, its
# library and headers, with CGAL certify, which is all that falls under the GPL, and python (pcl_bsh/python).
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pcl_bsh")
set(libraries pcl_bsh_core pcl_bsh_files pcl_bsh_search pcl_bsh_filters pcl_bsh_documents pcl_bsh_io pcl_bsh_pipeline
              pcl_bsh_sites)
install(
  TARGETS ${libraries}
  EXPORT pcl_bsh
  LIBRARY COMPONENT libs NAMELINK_COMPONENT dev
  ARCHIVE COMPONENT dev
  FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT dev)
install(EXPORT pcl_bsh FILE pcl_bshTargets.cmake NAMESPACE pcl_bsh:: DESTINATION "${package_dir}" COMPONENT dev)

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/pcl_bshConfig.cmake.in" "${PROJECT_BINARY_DIR}/pcl_bshConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pcl_bshConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(
  FILES "${PROJECT_BINARY_DIR}/pcl_bshConfig.cmake" "${PROJECT_BINARY_DIR}/pcl_bshConfigVersion.cmake"
  DESTINATION "${package_dir}"
  COMPONENT dev)

if(PCL_BSH_BUILD_CERTIFY) # find_package(pcl_bsh COMPONENTS certify)
  install(
    TARGETS pcl_bsh_certify
    EXPORT pcl_bsh_certify
    LIBRARY COMPONENT certify
    ARCHIVE COMPONENT certify
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT certify)
  install(EXPORT pcl_bsh_certify FILE pcl_bsh_certifyTargets.cmake NAMESPACE pcl_bsh:: DESTINATION "${package_dir}"
          COMPONENT certify)
endif()

if(TARGET pcl_bsh_vtk) # find_package(pcl_bsh COMPONENTS vtk)
  install(
    TARGETS pcl_bsh_vtk
    EXPORT pcl_bsh_vtk
    LIBRARY COMPONENT vtk
    ARCHIVE COMPONENT vtk
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT vtk)
  install(EXPORT pcl_bsh_vtk FILE pcl_bsh_vtkTargets.cmake NAMESPACE pcl_bsh:: DESTINATION "${package_dir}" COMPONENT vtk)
endif()
