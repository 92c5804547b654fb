# SPDX-License-Identifier: BSD-3-Clause
# Compiles for AArch64 with Debian's compiler, and runs with qemu's user mode. The libraries that the core links are in
# build/aarch64-libraries: `bash cmake/aarch64_libraries.sh`.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source)
set(libraries "${source}/build/aarch64-libraries")
list(APPEND CMAKE_FIND_ROOT_PATH "${libraries}" /usr/aarch64-linux-gnu /)
list(APPEND CMAKE_PREFIX_PATH "${libraries}/usr")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${libraries}/usr/lib/aarch64-linux-gnu")
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64;-L;/usr/aarch64-linux-gnu;-E;LD_LIBRARY_PATH=${libraries}/usr/lib/aarch64-linux-gnu")
