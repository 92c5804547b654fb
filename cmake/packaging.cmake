# SPDX-License-Identifier: BSD-3-Clause
# Three .deb packages, with VTK, CGAL, urdfdom, Python and VTK's Python one more each, by
# `cmake --workflow --preset package` or, from any build, by `cpack -G DEB`. The build of ParaView's plugin has one.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The pcl_bsh authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)

set(CPACK_COMPONENTS_ALL libs dev)
if(PCL_BSH_BUILD_PARAVIEW)
  set(CPACK_COMPONENTS_ALL paraview)
elseif(PCL_BSH_BUILD_TOOLS)
  list(APPEND CPACK_COMPONENTS_ALL tools)
endif()
if(PCL_BSH_BUILD_CERTIFY)
  list(APPEND CPACK_COMPONENTS_ALL certify)
endif()
if(TARGET pcl_bsh_vtk)
  list(APPEND CPACK_COMPONENTS_ALL vtk)
endif()
if(TARGET pcl_bsh_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
if(TARGET pcl_bsh_python_vtk)
  list(APPEND CPACK_COMPONENTS_ALL python_vtk)
endif()
if(TARGET pcl_bsh_self_filter)
  list(APPEND CPACK_COMPONENTS_ALL self_filter)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

set(CPACK_DEBIAN_LIBS_PACKAGE_NAME "libpcl-bsh${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
set(CPACK_DEBIAN_LIBS_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBS_DESCRIPTION "The shared libraries.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpcl-bsh-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libpcl-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Headers and CMake package.")
set(CPACK_COMPONENT_DEV_DEPENDS libs)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME pcl-bsh-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "Programs for the command line.")
set(CPACK_COMPONENT_TOOLS_DEPENDS libs)

set(CPACK_DEBIAN_CERTIFY_PACKAGE_NAME pcl-bsh-certify)
set(CPACK_DEBIAN_CERTIFY_PACKAGE_SECTION science)
set(CPACK_COMPONENT_CERTIFY_DESCRIPTION "Exact certification of sphere hierarchies; under GPL-3.0-or-later, by CGAL.")
set(CPACK_COMPONENT_CERTIFY_DEPENDS libs)

set(CPACK_DEBIAN_VTK_PACKAGE_NAME libpcl-bsh-vtk)
set(CPACK_DEBIAN_VTK_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_VTK_DESCRIPTION "Hierarchies and flags as VTK's data, pictures of them; library and headers.")
set(CPACK_COMPONENT_VTK_DEPENDS libs)
if(TARGET pcl_bsh_vtk) # for the programs that draw
  set(CPACK_COMPONENT_TOOLS_DEPENDS libs vtk)
endif()

set(CPACK_DEBIAN_SELF_FILTER_PACKAGE_NAME pcl-bsh-self-filter)
set(CPACK_DEBIAN_SELF_FILTER_PACKAGE_SECTION science)
set(CPACK_COMPONENT_SELF_FILTER_DESCRIPTION "Cuts a robot, as its URDF has it, out of what its own sensors see.")
set(CPACK_COMPONENT_SELF_FILTER_DEPENDS libs)

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-pcl-bsh)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${PCL_BSH_PYTHON_DEPENDS}")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Where point clouds collide, for NumPy's arrays.")
set(CPACK_COMPONENT_PYTHON_DEPENDS libs)

set(CPACK_DEBIAN_PYTHON_VTK_PACKAGE_NAME python3-pcl-bsh-vtk)
set(CPACK_DEBIAN_PYTHON_VTK_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_VTK_PACKAGE_DEPENDS "python3-vtk9")
set(CPACK_COMPONENT_PYTHON_VTK_DESCRIPTION "Filters for point clouds in the pipelines of VTK's Python.")
set(CPACK_COMPONENT_PYTHON_VTK_DEPENDS python vtk)

# What Python compiles beside the package's modules is no file of the package: dpkg alone would leave it.
foreach(component IN ITEMS PYTHON PYTHON_VTK)
  set(package "${CPACK_DEBIAN_${component}_PACKAGE_NAME}")
  set(scripts "")
  foreach(script IN ITEMS postinst prerm)
    configure_file("${PROJECT_SOURCE_DIR}/cmake/debian/${script}.in" "${PROJECT_BINARY_DIR}/debian/${package}/${script}" @ONLY)
    list(APPEND scripts "${PROJECT_BINARY_DIR}/debian/${package}/${script}")
  endforeach()
  set(CPACK_DEBIAN_${component}_PACKAGE_CONTROL_EXTRA "${scripts}")
endforeach()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PARAVIEW_PACKAGE_NAME pcl-bsh-paraview)
set(CPACK_DEBIAN_PARAVIEW_PACKAGE_SECTION science)
set(CPACK_COMPONENT_PARAVIEW_DESCRIPTION "Collisions and distances of point clouds in ParaView: a plugin.")

# What the binaries link to becomes what the packages depend on; our own libraries are found where they were built.
if(NOT PCL_BSH_BUILD_PARAVIEW) # nothing links to a plugin
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
endif()
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/pcl_bsh" "${PROJECT_BINARY_DIR}/pcl_bsh/io"
    "${PROJECT_BINARY_DIR}/pcl_bsh/io/files"
    "${PROJECT_BINARY_DIR}/pcl_bsh/certify" "${PROJECT_BINARY_DIR}/pcl_bsh/vtk" "${PROJECT_BINARY_DIR}/pcl_bsh/site"
    "${PROJECT_BINARY_DIR}/filters")

# Each package tells under which licence it is, where Debian's do.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER "${component}" name)
  set(licence "${PROJECT_SOURCE_DIR}/LICENSE")
  if(component STREQUAL "certify")
    set(licence "${PROJECT_SOURCE_DIR}/pcl_bsh/certify/LICENSE")
  endif()
  install(FILES "${licence}" RENAME copyright COMPONENT ${component}
          DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME}")
endforeach()

include(CPack)
