#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The .deb package of the plugin holds the plugin alone and asks for the ParaView that it was built for. Its unpacked
# content works: the test of the plugin runs on that, and ParaView loads it from the folder that PV_PLUGIN_PATH names.
#   bash package_test.sh CPACK BUILD FOLDER PLUGIN_TEST PVBATCH...
set -euo pipefail
cpack="$1" build="$2" folder="$3" plugin_test="$4" pvbatch=("${@:5}")
fail() { printf '%s\n' "$*" >&2; exit 1; }

rm -rf "$folder"
mkdir -p "$folder"
"$cpack" --config "$build/CPackConfig.cmake" -G DEB -B "$folder" >/dev/null
packages=("$folder"/*.deb)
[[ ${#packages[@]} == 1 && "${packages[0]##*/}" == pcl-bsh-paraview_*_*.deb ]] || fail "packages: ${packages[*]}"
depends="$(dpkg-deb --field "${packages[0]}" Depends)"
for package in paraview libtbb12 libhwy1; do
  [[ ", $depends" == *", $package "* ]] || fail "Depends: $depends: not of $package"
done
[[ "$depends" != *libvtk9* && "$depends" != *libpcl-* ]] || fail "Depends: $depends: of PCL, or of another VTK"

dpkg-deb --extract "${packages[0]}" "$folder/root"
mapfile -t files < <(cd "$folder/root" && find . -type f)
plugin="${files[0]}"
[[ ${#files[@]} == 1 && "$plugin" == ./usr/lib/*/paraview-5.11/plugins/BoundingSphereHierarchies/*.so ]] ||
  fail "files: ${files[*]}"
mkdir "$folder/results"
"${pvbatch[@]}" "$plugin_test" "$folder/root/$plugin" "$folder/results"
cat >"$folder/loaded.py" <<'END'
from paraview import simple
assert simple.PointCloudCollision and simple.BoundingSpheres
print("loaded")
END
told="$(PV_PLUGIN_PATH="$(dirname "$folder/root/$plugin")" "${pvbatch[@]}" "$folder/loaded.py")"
[[ "$told" == *loaded* ]] || fail "PV_PLUGIN_PATH: $told"
