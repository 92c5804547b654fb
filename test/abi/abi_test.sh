#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# abi.sh accepts what was described and what is added. It refuses a function that is gone and a longer struct, and names
# them; in another version it reports them alone. A longer struct that no public header declares is no change. It skips
# libraries of another compiler.
#   bash test/abi/abi_test.sh CXX FOLDER
set -euo pipefail
script="$(realpath "$(dirname "${BASH_SOURCE[0]}")/abi.sh")"
cxx="$1" folder="$2"
fail() { printf 'abi_test.sh: %s\n' "$*" >&2; exit 1; }
rm -rf "$folder"
mkdir -p "$folder/include" "$folder/lib" "$folder/descriptions"
cd "$folder"
echo 'file(COPY "${CMAKE_CURRENT_LIST_DIR}/include" "${CMAKE_CURRENT_LIST_DIR}/lib" DESTINATION "${CMAKE_INSTALL_PREFIX}")' \
  >cmake_install.cmake
cat >include/public.h <<'END'
namespace pcl_bsh {
struct Hidden;
struct Shown { int first; Hidden* hidden; MORE };
int kept(const Shown& shown);
int gone(const Shown& shown);
int added(const Shown& shown);
}
END
echo 'struct pcl_bsh::Hidden { int number; HIDDEN };' >hidden.h
cat >kept.cpp <<'END'
#include "public.h"
#include "hidden.h"
int pcl_bsh::kept(const Shown& shown) { return shown.hidden->number; }
END
cat >others.cpp <<'END'
#include "public.h"
namespace pcl_bsh {
#ifndef GONE
int gone(const Shown& shown) { return shown.first; }
#endif
#ifdef ADDED
int added(const Shown& shown) { return shown.first; }
#endif
}
END

build() { # VERSION OPTION...
  printf 'PCL_BSH_%s { global: *; };\n' "$1" >exports.map
  "$cxx" -g -O1 -fPIC -shared -Iinclude -DMORE= -DHIDDEN= kept.cpp others.cpp -o lib/libpcl_bsh_core.so \
    -Wl,--version-script=exports.map "-Wl,-soname,libpcl_bsh_core.so.$1" "${@:2}"
}
checked() { # STATUS PATTERN, of the last build
  local status=0
  bash "$script" check . descriptions >report.txt 2>&1 || status=$?
  ((status == $1)) && grep -q "$2" report.txt || fail "$3: status $status and not $1, or no '$2' in: $(cat report.txt)"
}
build 0.1
bash "$script" describe . descriptions >/dev/null
checked 0 '^== libpcl_bsh_core.so.0.1: since libpcl_bsh_core.so.0.1$' "nothing changed"
build 0.1 -DADDED
checked 0 '^== ' "a function more"
build 0.1 -UHIDDEN '-DHIDDEN=double more;'
checked 0 '^== ' "a hidden struct is longer"
build 0.1 -DGONE
checked 1 "\[D\] 'function int pcl_bsh::gone(" "a function is gone"
checked 1 '^abi.sh: libpcl_bsh_core.so.0.1: other than described: ' "a function is gone"
build 0.1 -UMORE '-DMORE=double more;'
checked 1 "'double more'" "a struct is longer"
build 0.2 -DGONE
checked 0 '1 Removed, 0 Changed, 0 Added function$' "a function is gone in another version"
objcopy --update-section .comment=<(printf 'GCC: (Other) 99.1.0\0') lib/libpcl_bsh_core.so
checked 77 '^abi.sh: skipped: ' "another compiler"
objcopy --strip-debug lib/libpcl_bsh_core.so
checked 1 'has no debug information: build the preset package$' "no debug information"
