# SPDX-License-Identifier: BSD-3-Clause
# Three .deb packages, with VTK, CGAL, Bullet, OMPL, urdfdom, Python and VTK's Python one more each, by
# `cmake --workflow --preset package` or, from any build, by `cpack -G DEB`. The build of ParaView's plugin has one.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The pcl_bsh authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

# The package of an installed component, where its target is built; after the description, the components it needs.
macro(pcl_bsh_add_package component target package section description)
  if(TARGET ${target})
    string(TOUPPER "${component}" name)
    list(APPEND CPACK_COMPONENTS_ALL ${component})
    set(CPACK_DEBIAN_${name}_PACKAGE_NAME "${package}")
    set(CPACK_DEBIAN_${name}_PACKAGE_SECTION ${section})
    set(CPACK_COMPONENT_${name}_DESCRIPTION "${description}")
    set(CPACK_COMPONENT_${name}_DEPENDS ${ARGN})
    set(licence "${PROJECT_SOURCE_DIR}/LICENSE") # each package tells its own, where Debian's do
    if("${component}" STREQUAL "certify")
      set(licence "${PROJECT_SOURCE_DIR}/pcl_bsh/certify/LICENSE")
    endif()
    install(FILES "${licence}" RENAME copyright COMPONENT ${component}
            DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/${package}")
  endif()
endmacro()

set(libraries_of_tools libs)
if(TARGET pcl_bsh_viewer)
  list(APPEND libraries_of_tools vtk)
endif()
if(TARGET pcl_bsh_physics)
  list(APPEND libraries_of_tools physics)
endif()
pcl_bsh_add_package(libs pcl_bsh_search "libpcl-bsh${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}" libs
                    "The shared libraries.")
pcl_bsh_add_package(dev pcl_bsh_search libpcl-bsh-dev libdevel "Headers and CMake package." libs)
pcl_bsh_add_package(tools pcl_bsh_collide pcl-bsh-tools science "Programs for the command line." ${libraries_of_tools})
pcl_bsh_add_package(certify pcl_bsh_certify pcl-bsh-certify science
                    "Exact certification of sphere hierarchies; under GPL-3.0-or-later, by CGAL." libs)
pcl_bsh_add_package(physics pcl_bsh_physics libpcl-bsh-physics libs
                    "Bodies that fall and rest on point clouds, by Bullet; library and headers." libs)
pcl_bsh_add_package(ompl pcl_bsh_ompl libpcl-bsh-ompl-dev libdevel
                    "Validators for OMPL's planners, among point clouds; headers." dev)
pcl_bsh_add_package(vtk pcl_bsh_vtk libpcl-bsh-vtk libs
                    "Hierarchies and flags as VTK's data, pictures of them; library and headers." libs)
pcl_bsh_add_package(self_filter pcl_bsh_self_filter pcl-bsh-self-filter science
                    "Cuts a robot, as its URDF has it, out of what its own sensors see." libs)
pcl_bsh_add_package(arm pcl_bsh_arm pcl-bsh-arm science
                    "Where a robot with joints collides with point clouds; certified motions." libs)
pcl_bsh_add_package(python pcl_bsh_python python3-pcl-bsh python "Where point clouds collide, for NumPy's arrays." libs)
pcl_bsh_add_package(python_vtk pcl_bsh_python_vtk python3-pcl-bsh-vtk python
                    "Filters for point clouds in the pipelines of VTK's Python." python vtk)
pcl_bsh_add_package(paraview BoundingSphereHierarchies pcl-bsh-paraview science
                    "Collisions and distances of point clouds in ParaView: a plugin.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libpcl-dev")
set(CPACK_DEBIAN_OMPL_PACKAGE_DEPENDS "libompl-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${PCL_BSH_PYTHON_DEPENDS}")
set(CPACK_DEBIAN_PYTHON_VTK_PACKAGE_DEPENDS "python3-vtk9")

# Python's compiled files beside the package's modules belong to no package: dpkg alone would leave them.
foreach(component IN ITEMS PYTHON PYTHON_VTK)
  if(NOT DEFINED CPACK_DEBIAN_${component}_PACKAGE_NAME)
    continue()
  endif()
  set(package "${CPACK_DEBIAN_${component}_PACKAGE_NAME}")
  set(scripts "")
  foreach(script IN ITEMS postinst prerm)
    configure_file("${PROJECT_SOURCE_DIR}/cmake/debian/${script}.in" "${PROJECT_BINARY_DIR}/debian/${package}/${script}" @ONLY)
    list(APPEND scripts "${PROJECT_BINARY_DIR}/debian/${package}/${script}")
  endforeach()
  set(CPACK_DEBIAN_${component}_PACKAGE_CONTROL_EXTRA "${scripts}")
endforeach()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Libraries that the binaries link to become dependencies of the packages; our own are found where they were built.
if(NOT PCL_BSH_BUILD_PARAVIEW) # nothing links to a plugin
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
endif()
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/pcl_bsh" "${PROJECT_BINARY_DIR}/pcl_bsh/io"
    "${PROJECT_BINARY_DIR}/pcl_bsh/io/files"
    "${PROJECT_BINARY_DIR}/pcl_bsh/certify" "${PROJECT_BINARY_DIR}/pcl_bsh/physics"
    "${PROJECT_BINARY_DIR}/pcl_bsh/vtk" "${PROJECT_BINARY_DIR}/pcl_bsh/site"
    "${PROJECT_BINARY_DIR}/filters")

include(CPack)

if(CMAKE_CXX_FLAGS_RELEASE MATCHES "-g") # by the preset package
  enable_testing()
  add_test(NAME abi COMMAND bash "${PROJECT_SOURCE_DIR}/test/abi/abi.sh" check "${PROJECT_BINARY_DIR}")
  set_tests_properties(abi PROPERTIES TIMEOUT 600 SKIP_RETURN_CODE 77)
endif()
