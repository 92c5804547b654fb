# SPDX-License-Identifier: BSD-3-Clause
# Lists the tests of an executable for CTest: an entry for each suite, ROOM/SUITE, or several where it has many tests.
# Starting a process, under a sanitizer above all, takes longer than most tests.
#   cmake -D EXECUTABLE=<program> -D "EMULATOR=<command that runs it>" -D ROOM=<name> -D LABEL=<label>
#         -D FILTER=<GoogleTest's filter> -D LIST=<file to write> -P discover_suites.cmake
cmake_minimum_required(VERSION 3.25)
set(most_tests 24) # of an entry: the last one shall not keep one processor busy alone
set(seconds 600)
if(EMULATOR) # some fifteen times as slow
  set(seconds 9000)
endif()
execute_process(COMMAND ${EMULATOR} "${EXECUTABLE}" --gtest_list_tests "--gtest_filter=${FILTER}" OUTPUT_VARIABLE text
                TIMEOUT 120 COMMAND_ERROR_IS_FATAL ANY)
cmake_path(GET LIST PARENT_PATH folder)
set(entries "")
set(suite "")
set(tests "")

macro(close_entry)
  if(tests)
    list(LENGTH tests count)
    list(JOIN tests ":" filter)
    math(EXPR part "${part} + 1")
    set(name "${ROOM}/${suite}")
    if(part GREATER 1)
      string(APPEND name ".${part}")
    endif()
    string(APPEND entries "add_test([=[${name}]=]")
    foreach(word IN ITEMS ${EMULATOR} "${EXECUTABLE}" "--gtest_filter=${filter}")
      string(APPEND entries " [=[${word}]=]")
    endforeach()
    string(APPEND entries ")\nset_tests_properties([=[${name}]=] PROPERTIES WORKING_DIRECTORY [=[${folder}]=] "
                          "TIMEOUT ${seconds} COST ${count} LABELS [=[${LABEL}]=])\n")
    set(tests "")
  endif()
endmacro()

string(REGEX REPLACE "[][;]" " " text "${text}") # which lists would take amiss: in what follows a #
string(REGEX MATCHALL "[^\n]+" lines "${text}")
foreach(line IN LISTS lines)
  string(REGEX REPLACE " *#.*" "" line "${line}")
  if(line MATCHES "^([^ ]+)\\.$")
    close_entry()
    set(suite "${CMAKE_MATCH_1}")
    set(part 0)
  elseif(line MATCHES "^  ([^ ]+)$")
    list(APPEND tests "${suite}.${CMAKE_MATCH_1}")
    list(LENGTH tests count)
    if(count EQUAL most_tests)
      close_entry()
    endif()
  endif()
endforeach()
close_entry()
file(WRITE "${LIST}" "${entries}")
