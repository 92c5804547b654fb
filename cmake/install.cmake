# SPDX-License-Identifier: BSD-3-Clause
# For find_package(pcl_bsh). Components: libs, dev (headers, CMake package), with the programs tools, and where they are
# built vtk, physics, ompl and certify, libraries with their headers (all that falls under the GPL is certify), python and
# self_filter.
include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pcl_bsh")

set(libraries "")
foreach(name IN ITEMS core files search filters documents io pipeline sites)
  if(TARGET pcl_bsh_${name})
    list(APPEND libraries pcl_bsh_${name})
  endif()
endforeach()
install(
  TARGETS ${libraries}
  EXPORT pcl_bsh
  LIBRARY COMPONENT libs NAMELINK_COMPONENT dev
  ARCHIVE COMPONENT dev
  FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT dev)
install(EXPORT pcl_bsh FILE pcl_bshTargets.cmake NAMESPACE pcl_bsh:: DESTINATION "${package_dir}" COMPONENT dev)
foreach(name IN ITEMS certify ompl physics vtk) # only for those who ask: find_package(pcl_bsh COMPONENTS certify)
  if(TARGET pcl_bsh_${name})
    install(
      TARGETS pcl_bsh_${name}
      EXPORT pcl_bsh_${name}
      LIBRARY COMPONENT ${name}
      ARCHIVE COMPONENT ${name}
      FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT ${name})
    install(EXPORT pcl_bsh_${name} FILE pcl_bsh_${name}Targets.cmake NAMESPACE pcl_bsh:: DESTINATION "${package_dir}"
            COMPONENT ${name})
  endif()
endforeach()

# For pkg-config: each shared library, and those that its headers need. pcl_bsh_vtk has none, for VTK has none.
function(pcl_bsh_install_pkg_config name component)
  set(PCL_BSH_LIBRARY pcl_bsh_${name})
  get_target_property(linked ${PCL_BSH_LIBRARY} INTERFACE_LINK_LIBRARIES)
  list(FILTER linked EXCLUDE REGEX "LINK_ONLY")
  list(TRANSFORM linked REPLACE "^Eigen3::Eigen$" eigen3)
  list(JOIN linked " " PCL_BSH_REQUIRES)
  get_target_property(defined ${PCL_BSH_LIBRARY} INTERFACE_COMPILE_DEFINITIONS)
  set(PCL_BSH_DEFINED "")
  if(defined)
    list(TRANSFORM defined PREPEND " -D")
    list(JOIN defined "" PCL_BSH_DEFINED)
  endif()
  set(PCL_BSH_LIBDIR "${CMAKE_INSTALL_LIBDIR}")
  set(PCL_BSH_INCLUDEDIR "${CMAKE_INSTALL_INCLUDEDIR}")
  file(RELATIVE_PATH PCL_BSH_PREFIX "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/") # from where the file is installed
  configure_file("${PROJECT_SOURCE_DIR}/cmake/pcl_bsh.pc.in" "${PROJECT_BINARY_DIR}/pkgconfig/${PCL_BSH_LIBRARY}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/pkgconfig/${PCL_BSH_LIBRARY}.pc" COMPONENT ${component}
          DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endfunction()
if(BUILD_SHARED_LIBS)
  foreach(name IN ITEMS core files search filters pipeline sites certify)
    if(TARGET pcl_bsh_${name})
      set(component dev)
      if(name STREQUAL "certify")
        set(component certify)
      endif()
      pcl_bsh_install_pkg_config(${name} ${component})
    endif()
  endforeach()
endif()

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/pcl_bshConfig.cmake.in" "${PROJECT_BINARY_DIR}/pcl_bshConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pcl_bshConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(
  FILES "${PROJECT_BINARY_DIR}/pcl_bshConfig.cmake" "${PROJECT_BINARY_DIR}/pcl_bshConfigVersion.cmake"
  DESTINATION "${package_dir}"
  COMPONENT dev)
