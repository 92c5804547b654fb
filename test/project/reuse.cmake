# SPDX-License-Identifier: BSD-3-Clause
# For scripts that build the project once more: objects that another build has compiled by the same commands are copied from
# there (reuse.sh). PCL_BSH_BUILD: the other build. WORK: the script's own folder.
set(PCL_BSH_REUSED "${WORK}/reused.txt")
set(PCL_BSH_REUSE "bash;${CMAKE_CURRENT_LIST_DIR}/reuse.sh;${PCL_BSH_BUILD};${PCL_BSH_REUSED}")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The compiler's arguments in a build, without folders, launchers, and what changes nothing of an object. PREFIX: the folder
# in which the project is built, below the build's own.
function(pcl_bsh_read_commands build prefix result)
  file(STRINGS "${build}/compile_commands.json" lines REGEX "^ *\"command\": ")
  cmake_path(APPEND build "${prefix}" OUTPUT_VARIABLE folder)
  cmake_path(NORMAL_PATH folder)
  string(REGEX REPLACE "/$" "" folder "${folder}")
  list(TRANSFORM lines REPLACE "${folder}" "")
  list(TRANSFORM lines REPLACE " -o ${prefix}/" " -o ")
  list(TRANSFORM lines REPLACE " --param=ggc[^ ]*" "")
  list(TRANSFORM lines REPLACE "^.*(clang|g|c)[+][+] " "")
  set(${result} "${lines}" PARENT_SCOPE)
endfunction()

# Between configuring, with the launcher ${PCL_BSH_REUSE};PREFIX, and building.
function(pcl_bsh_list_reused build prefix)
  pcl_bsh_read_commands("${build}" "${prefix}" wanted)
  pcl_bsh_read_commands("${PCL_BSH_BUILD}" "." compiled)
  set(count 0)
  foreach(command IN LISTS wanted)
    if(command IN_LIST compiled AND command MATCHES " -o ([^ ]+) ")
      file(APPEND "${PCL_BSH_REUSED}" "${CMAKE_MATCH_1}\n")
      math(EXPR count "${count} + 1")
    endif()
  endforeach()
  message(STATUS "${count} objects need not be compiled again")
endfunction()
