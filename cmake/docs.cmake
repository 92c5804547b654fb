# SPDX-License-Identifier: BSD-3-Clause
# The target docs: pages of all public headers, <build>/docs/index.html. Whatever Doxygen warns of is an error.
find_program(DOXYGEN doxygen)
mark_as_advanced(DOXYGEN)
if(NOT DOXYGEN)
  return()
endif()

set(documented "")
foreach(target IN ITEMS pcl_bsh_core pcl_bsh_search pcl_bsh_filters pcl_bsh_pipeline pcl_bsh_sites pcl_bsh_vtk pcl_bsh_certify
                      pcl_bsh_physics pcl_bsh_ompl)
  if(TARGET ${target})
    get_target_property(headers ${target} HEADER_SET)
    get_target_property(source_dir ${target} SOURCE_DIR)
    foreach(header IN LISTS headers)
      cmake_path(ABSOLUTE_PATH header BASE_DIRECTORY "${source_dir}")
      list(APPEND documented "${header}")
    endforeach()
  endif()
endforeach()
list(FILTER documented EXCLUDE REGEX "\\.hpp$") # definitions of templates
list(JOIN documented "\" \\\n\"" PCL_BSH_DOCUMENTED)
configure_file("${PROJECT_SOURCE_DIR}/cmake/docs/Doxyfile.in" "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
add_custom_target(docs COMMAND "${DOXYGEN}" "${PROJECT_BINARY_DIR}/Doxyfile" VERBATIM
                  COMMENT "Pages of the public headers: docs/index.html")
