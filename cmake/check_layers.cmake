# SPDX-License-Identifier: BSD-3-Clause
# Fails when a file includes something of a room above its own, or a library that its room must not know.
#   cmake -P cmake/check_layers.cmake
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH root)

# From the bottom up: a room may include itself and those before it.
set(core pcl_bsh/simd pcl_bsh/geometry pcl_bsh/hierarchy pcl_bsh/query pcl_bsh/traversal pcl_bsh/collision pcl_bsh/neighbors
    pcl_bsh/clusters pcl_bsh/trajectory pcl_bsh/scene pcl_bsh/report pcl_bsh/certify) # without PCL
set(rooms pcl_bsh/files ${core} pcl_bsh/search filters filters/cloud_files filters/pose_files filters/json filters/scene_files
    filters/reports filters/pipeline pcl_bsh/vtk examples/cli examples/tunnel examples/viewer examples/programs examples)

set(never "^vtk")                     # nowhere in these rooms, but for
set(allowed_pcl_bsh/vtk "^vtk")       # a room made for it, which only programs see
set(allowed_examples/viewer "^vtk")   # and the program that shows things
set(gpl "^(CGAL/|pcl_bsh/certify/)")  # only in pcl_bsh/certify, and in its program what that offers
set(gpl_program "^examples/(programs/pcl_bsh_certify\\.cpp|cli/certify_[a-z]+\\.h)$")
set(never_in_core "^(pcl/|pcl_bsh/files/|iostream$|fstream$)")

# The room of an included path, or empty when it is not one of ours.
function(room_of path room_variable)
  string(REGEX REPLACE "^pcl_bsh/filters/" "filters/" path "${path}")
  string(REGEX REPLACE "^(cli|tunnel|viewer)/" "examples/\\1/" path "${path}")
  set(found "")
  set(found_length 0)
  foreach(room IN LISTS rooms) # the longest match wins: filters/json, not filters
    string(LENGTH "${room}" length)
    if(length GREATER found_length AND path MATCHES "^${room}/")
      set(found "${room}")
      set(found_length ${length})
    endif()
  endforeach()
  set(${room_variable} "${found}" PARENT_SCOPE)
endfunction()

set(file_count 0)
set(defects "")
foreach(room IN LISTS rooms)
  list(FIND rooms "${room}" rank)
  file(GLOB_RECURSE files RELATIVE "${root}" "${root}/${room}/*.h" "${root}/${room}/*.hpp" "${root}/${room}/*.cpp")
  foreach(file IN LISTS files)
    room_of("${file}" own_room)
    if(NOT own_room STREQUAL room)
      continue() # a room inside this one, with its own turn
    endif()
    math(EXPR file_count "${file_count} + 1")
    file(STRINGS "${root}/${file}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^[^<\"]*[<\"]([^>\"]*)[>\"].*$" "\\1" path "${line}")
      room_of("${path}" included_room)
      list(FIND rooms "${included_room}" included_rank)
      if(included_rank GREATER rank)
        list(APPEND defects "${file}: includes ${path}: ${room} lies below ${included_room}")
      elseif(path MATCHES "\\.\\./")
        list(APPEND defects "${file}: includes ${path}: write the path from the project's root")
      elseif(DEFINED allowed_${room} AND path MATCHES "${allowed_${room}}")
        continue()
      elseif(path MATCHES "${never}" OR (room IN_LIST core AND path MATCHES "${never_in_core}"))
        list(APPEND defects "${file}: includes ${path}: not allowed in ${room}")
      elseif(path MATCHES "${gpl}" AND NOT room STREQUAL "pcl_bsh/certify" AND NOT (file MATCHES "${gpl_program}" AND path
                                                                                        MATCHES "^pcl_bsh/"))
        list(APPEND defects "${file}: includes ${path}: only pcl_bsh_certify may bring the GPL in")
      endif()
    endforeach()
  endforeach()
endforeach()

if(file_count EQUAL 0)
  message(FATAL_ERROR "no files found under ${root}")
endif()
if(defects)
  list(JOIN defects "\n  " text)
  message(FATAL_ERROR "these includes break the layers:\n  ${text}")
endif()
message(STATUS "${file_count} files keep to their layers")
