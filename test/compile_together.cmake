# SPDX-License-Identifier: BSD-3-Clause
# Tests are compiled many files at a time: what they include takes longer to read and to instantiate than they do
# themselves. Their texts follow each other in one file, each from its unnamed namespace on in a namespace that is named after
# the file, so that no names clash.
#   cmake -D OUT=<file to write> -D "FILES=<files>" -D FOLDER=<what names in messages are relative to> -P compile_together.cmake

if(CMAKE_SCRIPT_MODE_FILE)
  set(joined "")
  foreach(file IN LISTS FILES)
    file(READ "${file}" text)
    cmake_path(GET file STEM name)
    if(text MATCHES "\nnamespace {\n")
      string(REPLACE "\nnamespace {\n" "\nnamespace in_${name} { namespace {\n" text "${text}")
      string(REGEX REPLACE "^(.*\n)(} // namespace pcl_bsh)" "\\1}\\2" text "${text}") # the last one
    endif()
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY "${FOLDER}" OUTPUT_VARIABLE shown)
    string(APPEND joined "#line 1 \"${shown}\"\n${text}")
  endforeach()
  file(WRITE "${OUT}" "${joined}")
  return()
endif()

# Sets `compiled` to the files to compile for a room, relative to the folder of these sources or of their build. Most
# are joined, up to so many bytes. Files stay alone that define functions of others, include themselves again or read
# PCL's headers in another way. Small files suit a developer of one test; large ones instantiate templates less often,
# and compile all tests in fewer seconds.
set(PCL_BSH_BYTES_TOGETHER 170000 CACHE STRING "Bytes of tests that are compiled as one file; g++ takes 2 GB for the default")
mark_as_advanced(PCL_BSH_BYTES_TOGETHER)
function(pcl_bsh_compile_together compiled room)
  set(alone "")
  set(bytes 0)
  set(group 1)
  foreach(file IN LISTS ARGN)
    file(STRINGS "${file}" special REGEX "foreach_target|PCL_NO_PRECOMPILE")
    if(special OR NOT file MATCHES "_test\\.cpp$")
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
      list(APPEND alone "${file}")
      continue()
    endif()
    file(SIZE "${file}" size)
    math(EXPR bytes "${bytes} + ${size}")
    if(bytes GREATER PCL_BSH_BYTES_TOGETHER)
      math(EXPR group "${group} + 1")
      set(bytes ${size})
    endif()
    list(APPEND files_${group} "${file}")
  endforeach()
  foreach(i RANGE 1 ${group})
    if(files_${i})
      set(out "together/${room}_${i}.cpp")
      add_custom_command(
        OUTPUT "${out}" DEPENDS ${files_${i}} "${CMAKE_CURRENT_FUNCTION_LIST_FILE}" VERBATIM
        COMMAND ${CMAKE_COMMAND} -D "OUT=${CMAKE_CURRENT_BINARY_DIR}/${out}" -D "FILES=${files_${i}}" -D "FOLDER=${PROJECT_SOURCE_DIR}" -P
                "${CMAKE_CURRENT_FUNCTION_LIST_FILE}")
      list(APPEND joined "${out}")
    endif()
  endforeach()
  set(${compiled} ${joined} ${alone} PARENT_SCOPE)
endfunction()
