# SPDX-License-Identifier: BSD-3-Clause
# How everything of this project is compiled.

# No -march here, nor in any preset: code that sees PCL's headers must be aligned as libpcl was when it was compiled, or
# it crashes or, worse, returns empty clouds. Wider SIMD comes from run-time dispatch inside pcl_bsh_core.
function(pcl_bsh_target_defaults target)
  set_target_properties(${target} PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
  # A multiplication fused into an addition rounds once instead of twice: the same input would give other bits on
  # another instruction set.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    target_compile_options(${target} PRIVATE -U__ARM_FEATURE_FMA) # by which Eigen fuses them itself
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict) # GCC 12 suspects "text" + std::string
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-dangling-reference) # GCC 14 suspects each reference that a call returns
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(${target} PRIVATE -fsized-deallocation) # as g++ has it
  endif()
  if(PCL_BSH_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# Clang's sanitizers bring an operator new, and tests have one of their own. AddressSanitizer's is a shared library, where
# the tests' wins, which fails allocations. ThreadSanitizer's wins over the tests': none that is run there counts them.
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=address")
  # Not -print-runtime-dir: Debian's clang 19 names a folder there that it does not have.
  execute_process(COMMAND "${CMAKE_CXX_COMPILER}" -print-file-name=libclang_rt.asan-${CMAKE_SYSTEM_PROCESSOR}.so
                  OUTPUT_VARIABLE runtimes OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  cmake_path(GET runtimes PARENT_PATH runtimes)
  add_link_options(-shared-libsan "LINKER:-rpath,${runtimes}")
elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
  add_link_options("LINKER:-z,muldefs")
endif()

# Vectors of x86-64's baseline are emulated, and take a sanitizer longer to compile than all else: where the processor has
# AVX2, the core is for that alone. Eigen aligns as it does in tests that were compiled without.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") ? 0 : 1; }" PCL_BSH_AVX2_RUNS)
  if(PCL_BSH_AVX2_RUNS)
    add_compile_options(-mavx2 -mf16c -mpclmul -maes)
    add_compile_definitions(HWY_DISABLE_BMI2_FMA EIGEN_MAX_ALIGN_BYTES=16)
  endif()
endif()

# For what takes longer to compile than to run.
function(pcl_bsh_compile_fast target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 and 14 suspect std::string and Eigen's vectors
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
  endif()
endfunction()

# Other people's headers, which take longer to read than our files: once for all targets that name the same set. All
# other flags of these targets must be alike.
function(pcl_bsh_precompile target set)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess) # for ccache
    # GCC 12 suspects "text" + std::string, and does not know that a precompiled <string> is the system's. GCC 14 also
    # suspects std::sort of a few elements of an array.
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
  endif()
  get_property(first GLOBAL PROPERTY pcl_bsh_first_of_${set})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    set_property(GLOBAL PROPERTY pcl_bsh_first_of_${set} ${target})
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Highway's code for AArch64 is compiled for the vectors that all processors have. With a choice at run time g++ takes
# none of it into functions outside of that choice. Vectors of unknown length cannot be members of classes.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  add_compile_definitions(TOOLCHAIN_MISS_SYS_AUXV_H)
endif()

# Which symbols of a library are seen: of the visible ones, ours.
configure_file("${CMAKE_CURRENT_LIST_DIR}/exports.map.in" "${PROJECT_BINARY_DIR}/exports.map" @ONLY)
function(pcl_bsh_limit_exports target)
  target_link_options(${target} PRIVATE "LINKER:--version-script=${PROJECT_BINARY_DIR}/exports.map")
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${PROJECT_BINARY_DIR}/exports.map")
endfunction()

# A library named pcl_bsh_<name>, known inside and outside of the project as pcl_bsh::<name>. Its headers are C++17.
# Hidden is what no public header declares (pcl_bsh/export.h).
function(pcl_bsh_add_library name)
  add_library(pcl_bsh_${name} ${ARGN})
  add_library(pcl_bsh::${name} ALIAS pcl_bsh_${name})
  pcl_bsh_target_defaults(pcl_bsh_${name})
  target_compile_features(pcl_bsh_${name} PUBLIC cxx_std_17)
  set_target_properties(
    pcl_bsh_${name}
    PROPERTIES EXPORT_NAME ${name}
               INSTALL_RPATH "$ORIGIN" # wherever they are installed, they lie side by side
               VERIFY_INTERFACE_HEADER_SETS ${PROJECT_IS_TOP_LEVEL}
               CXX_VISIBILITY_PRESET hidden
               VISIBILITY_INLINES_HIDDEN ON
               DEFINE_SYMBOL "" # unused, and another one for each library would forbid them a common precompiled header
               VERSION ${PROJECT_VERSION}
               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(BUILD_SHARED_LIBS)
    pcl_bsh_limit_exports(pcl_bsh_${name})
  endif()
endfunction()

# install(), where anything is installed.
function(pcl_bsh_install)
  if(PCL_BSH_INSTALL)
    install(${ARGV})
  endif()
endfunction()

# g++ collects garbage after every 128 MB: without it, what includes PCL compiles a tenth faster and takes a fifth more memory.
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
cmake_host_system_information(RESULT megabytes QUERY TOTAL_PHYSICAL_MEMORY)
math(EXPR needed "2000 * (${processors} + 1)")
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT megabytes LESS needed)
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()

if(PROJECT_IS_TOP_LEVEL)
  find_program(CCACHE_PROGRAM ccache)
  mark_as_advanced(CCACHE_PROGRAM)
  if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    # ccache must be told that it may trust precompiled headers, and which options change nothing of what is compiled
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
                                    CCACHE_IGNOREOPTIONS=--param=ggc* "${CCACHE_PROGRAM}")
  endif()
endif()
