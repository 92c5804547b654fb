# SPDX-License-Identifier: BSD-3-Clause
# The core holds code for the instruction sets that were asked for, and for no others. Highway names the namespace of each,
# and versions of Highway differ in the sets they know.
#
#   cmake -D NM=nm -D LIBRARY=<libpcl_bsh_core> -D "SETS=SSE2;AVX2" -D HIGHWAY=<folder of hwy/> -P instruction_sets.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND "${NM}" --demangle --defined-only "${LIBRARY}" OUTPUT_VARIABLE symbols ERROR_QUIET)
string(REGEX MATCHALL "pcl_bsh::N_[A-Z0-9_]+::" generated "${symbols}")
list(REMOVE_DUPLICATES generated)
list(TRANSFORM generated REPLACE "pcl_bsh::N_(.*)::" "\\1")

list(GET HIGHWAY 0 folder)
file(STRINGS "${folder}/hwy/detect_targets.h" sse2 REGEX "define HWY_SSE2 ")
if(NOT sse2) # Highway's code without vectors stands for it; its name depends on the compiler
  list(TRANSFORM SETS REPLACE "^SSE2$" SCALAR)
  list(TRANSFORM generated REPLACE "^EMU128$" SCALAR)
endif()
list(SORT SETS)
list(SORT generated)
if(NOT generated STREQUAL SETS)
  message(FATAL_ERROR "${LIBRARY}: is compiled for '${generated}' instead of '${SETS}'")
endif()
message(STATUS "compiled for ${generated}")
