#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Unpacks the .deb packages of a build into an empty folder and runs what they bring, from there: each program, the sample
# pipelines and scenes, the Python package. Nothing of the build folder is used. (That the samples in C++ compile, the
# test project/consumer says.)
#   bash run.sh CPACK BUILD FOLDER [PYTHON]
set -euo pipefail
cpack="$1" build="$2" folder="$3" python="${4:-}"
fail() { printf 'packages: %s\n' "$*" >&2; exit 1; }

rm -rf "$folder"
mkdir -p "$folder/packages" "$folder/root"
"$cpack" --config "$build/CPackConfig.cmake" -G DEB -B "$folder/packages" >"$folder/cpack.log" || fail "$(cat "$folder/cpack.log")"
for package in "$folder"/packages/*.deb; do
  name="$(dpkg-deb --field "$package" Package)"
  dpkg-deb --extract "$package" "$folder/root"
  dpkg-deb --fsys-tarfile "$package" | tar --list >"$folder/$name.list"
  grep -q "/share/doc/$name/copyright$" "$folder/$name.list" || fail "$name: holds no licence"
done

prefix="$(dirname "$(find "$folder/root" -type d -name bin)")"
[[ -d "$prefix/bin" ]] || fail "no programs in $(ls "$folder/packages")"
while read -r file; do
  [[ "$(file --brief "$file")" == *", stripped"* ]] || fail "$file: is not stripped"
done < <(find "$prefix" -type f \( -path '*/bin/*' -o -name '*.so*' \))

export PATH="$prefix/bin:/usr/bin:/bin"
unset LD_LIBRARY_PATH PYTHONPATH
for program in "$prefix"/bin/*; do
  name="${program##*/}"
  "$name" --help >"$folder/help.txt" || fail "$name --help fails"
  [[ -s "$prefix/share/man/man1/$name.1" ]] || fail "$name: has no manual page"
  while read -r called; do # what an example calls is installed
    command -v "$called" >/dev/null || fail "$name --help calls $called, which no package holds"
  done < <(sed -n 's/^ *\(pcl_bsh_[a-z_]*\) .*/\1/p' "$folder/help.txt" | sort -u)
  linked="$(ldd "$program")"
  [[ "$linked" != *"not found"* ]] || fail "$name: $linked"
  ! grep libpcl_bsh_ <<<"$linked" | grep -vF "=> $prefix/" || fail "$name: links to another copy of pcl_bsh"
done

samples="$prefix/share/doc/pcl_bsh"
mkdir "$folder/work"
cd "$folder/work"
bash "$samples/pipelines/make_clouds.sh" . >/dev/null
for pipeline in "$samples"/pipelines/*.json; do
  [[ "$pipeline" == *.schema.json ]] || pcl_bsh_pipeline "$pipeline" >/dev/null || fail "$pipeline: fails"
done
for scene in "$samples"/scenes/*.json; do
  [[ "$scene" == *.schema.json ]] || pcl_bsh_scene "$scene" --out "scene_${scene##*/}" >/dev/null || fail "$scene: fails"
done
if command -v pcl_bsh_made_robot >/dev/null; then
  pcl_bsh_made_robot robot --frames 1 >/dev/null
  [[ -s robot/robot.urdf ]] || fail "pcl_bsh_made_robot: made no robot.urdf"
fi

packages="$(find "$folder/root" -type d -name dist-packages)"
if [[ -n "$packages" && -n "$python" ]]; then
  imported="$(PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$packages" "$python" -c \
    'import numpy, pcl_bsh; a = pcl_bsh.SphereHierarchy(numpy.zeros((1, 3))); print(pcl_bsh.__file__)')"
  [[ "$imported" == "$packages"/* ]] || fail "python imports $imported"
  for package in "$folder"/packages/python3-*.deb; do
    dpkg-deb --control "$package" "$folder/control"
    grep -q "py3clean -p $(dpkg-deb --field "$package" Package)$" "$folder/control/prerm" ||
      fail "$package: leaves __pycache__ behind"
    rm -r "$folder/control"
  done
fi
printf '%s packages: what they hold runs\n' "$(ls "$folder/packages" | wc -l)"
