#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Puts building.ply, a scanned building, and man.off, a man, into a folder. Both come from Debian's package libcgal-demo:
# as installed, or downloaded and unpacked without installing it (images that drop /usr/share/doc lose its files).
#   bash examples/demo/fetch_scans.sh FOLDER
set -euo pipefail

say() { printf '== %s\n' "$*"; }
die() { printf 'fetch_scans.sh: %s\n' "$*" >&2; exit 1; }

(($# == 1)) || die "FOLDER: is missing: say where the scans shall go"
folder="$1"
mkdir -p "$folder"
if [[ -s "$folder/building.ply" && -s "$folder/man.off" ]]; then exit 0; fi

work="$(mktemp -d "$folder/fetching.XXXXXX")"
trap 'rm -rf "$work"' EXIT

download() { (cd "$work" && apt-get -o APT::Sandbox::User=root -o Acquire::Retries=3 --quiet download libcgal-demo); }

update() {
  if [[ "$(id -u)" == 0 ]]; then apt-get update; else sudo apt-get update; fi
}

archive=/usr/share/doc/libcgal-demo/data.tar.gz
if [[ ! -r "$archive" ]]; then
  command -v apt-get >/dev/null || die "apt-get: not found: put building.ply and man.off of CGAL's data into $folder"
  say "downloading the demo scans (package libcgal-demo, 24 MB)"
  download 2>/dev/null || { update && download; } || die "libcgal-demo: cannot be downloaded: see the lines above"
  dpkg-deb --extract "$work"/libcgal-demo_*.deb "$work/package"
  archive="$(find "$work/package" -type f -name data.tar.gz -print -quit)"
  [[ -n "$archive" ]] || die "libcgal-demo: has no data.tar.gz: this needs the package of Debian 12 or 13"
fi

tar --extract --gzip --file "$archive" --directory "$work" --strip-components 2 \
  data/points_3/building.ply data/meshes/man.off || die "$archive: lacks the scans: this needs the package of Debian 12 or 13"
mv "$work/building.ply" "$work/man.off" "$folder/"
say "the demo scans are in $folder"
