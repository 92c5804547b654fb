#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a bare Debian in a folder, from the mirror that this machine's apt uses. Runs there, in a fresh clone of HEAD,
# the two commands of README.md, then what they leave out: packaging, the preset clang, the benchmarks. Says how long each
# takes. Needs root, 25 GB and hours; run it before every release, not in CI.
#   bash test/on_debian.sh VERSION [FOLDER]     VERSION: 12 or 13. FOLDER: is made anew; default /var/tmp/pcl_bsh_debian_VERSION
#   CCACHE_DIR=FOLDER bash test/on_debian.sh VERSION  keeps there what the compiler makes after the first command, so that a
#                                                   next call is quicker; its times are then no measure
# Fails when a command fails, when a compiler warns, or when the demonstration's cloud differs from that of another version
# in the folder beside.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
umask 022 # tests there run as other users, too

say() { printf '== %s\n' "$*"; }
die() { printf 'on_debian.sh: %s\n' "$*" >&2; exit 1; }
usage() { printf 'on_debian.sh: %s: write bash test/on_debian.sh 12, or 13\n' "$*" >&2; exit 2; }

(($# == 1 || $# == 2)) || usage "VERSION: is missing"
case "$1" in
  12) suite=bookworm ;;
  13) suite=trixie ;;
  *) usage "VERSION: is '$1'" ;;
esac
folder="$(realpath --canonicalize-missing "${2:-/var/tmp/pcl_bsh_debian_$1}")"
root="$folder/root"
[[ "$(id -u)" == 0 ]] || die "VERSION: a chroot needs root: run it by sudo"
command -v git >/dev/null || die "git: not found: install it"
if [[ -e "$folder" && ! -e "$folder/made_by_on_debian" && -n "$(ls -A "$folder")" ]]; then
  die "FOLDER: $folder holds what this script has not made: name another"
fi

# The first archive of Debian itself, in apt's order.
mirror="$(apt-get indextargets --format '$(ORIGIN)|$(LABEL)|$(REPO_URI)' 'Created-By: Packages' |
  sed -n 's/^Debian|Debian|//p' | head -n 1)"
[[ -n "$mirror" ]] || die "apt: its sources name no mirror of Debian, or apt-get update has not run"
if ! command -v debootstrap >/dev/null; then
  say "installing debootstrap"
  DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends debootstrap >/dev/null
fi

say "making Debian $1 ($suite) in $root from $mirror"
rm -rf --one-file-system "$folder"
mkdir -p "$folder"
touch "$folder/made_by_on_debian"
script="/usr/share/debootstrap/scripts/$suite"
[[ -e "$script" ]] || script=/usr/share/debootstrap/scripts/sid # an older debootstrap does not know a newer suite
for scheme in http https; do
  eval "$(apt-config shell "${scheme}_proxy" "Acquire::$scheme::Proxy")"
  export "${scheme}_proxy"
done
debootstrap --variant=minbase "$suite" "$root" "$mirror" "$script" >"$folder/debootstrap.log" 2>&1 ||
  die "debootstrap failed: see $folder/debootstrap.log"
apt-config dump Acquire::http Acquire::https Acquire::Check-Valid-Until Acquire::Check-Date >"$root/etc/apt/apt.conf.d/90host"
if [[ -e /etc/resolv.conf ]]; then cp --dereference /etc/resolv.conf "$root/etc/resolv.conf"; fi
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # no package starts a service
chmod +x "$root/usr/sbin/policy-rc.d"

[[ -z "$(git status --porcelain)" ]] || say "what is not committed is not tested"
git clone --quiet --no-hardlinks . "$root/srv/pcl_bsh"
if [[ -n "${CCACHE_DIR:-}" ]]; then mkdir -p "$CCACHE_DIR" "$root/root/.ccache"; fi

# Runs a command in the clone, and says how long it took: its last line goes to $folder/times.
inside() { # NAME COMMAND...
  local name="$1" log="$folder/$1.log" TIMEFORMAT="$1: %R s elapsed, %U s of processor time, and %S s of the system's"
  shift
  say "$name: $* (output in $log)"
  { time unshare --mount --propagation private bash -c '
      mount -t proc proc "$1/proc" && mount -t sysfs sysfs "$1/sys" && mount --rbind /dev "$1/dev" || exit
      if [[ -n "${CCACHE_DIR:-}" ]]; then mount --bind "$CCACHE_DIR" "$1/root/.ccache" || exit; fi
      cd / && exec chroot "$@"' - "$root" \
      /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      bash -c 'cd /srv/pcl_bsh && exec "$@"' - "$@" </dev/null >"$log" 2>&1 ||
      failed+=("$name"); } 2>>"$folder/times"
  tail -n 1 "$folder/times"
  if grep -m 5 ' warning: ' "$log"; then failed+=("$name, by the compiler's warnings"); fi
}
failed=()
inside first bash examples/run.sh
if ((${#failed[@]})); then die "the first command failed: see $folder/first.log"; fi
cloud="$(sha256sum "$root/srv/pcl_bsh/build/demo/building_collision.pcd" | cut -d ' ' -f 1)"
printf '%s\n' "$cloud" >"$folder/cloud.sha256"
say "the demonstration's cloud has the SHA-256 $cloud"
for other in "${folder%"_$1"}"_*/cloud.sha256; do
  if [[ -s "$other" && "$(cat "$other")" != "$cloud" ]]; then failed+=("the demonstration: another cloud than in $other"); fi
done
if [[ -n "${CCACHE_DIR:-}" ]]; then inside ccache apt-get install --yes --no-install-recommends ccache; fi
inside second bash test/run.sh
inside packaging ctest --preset packaging
inside clang bash -c 'cmake --preset clang && cmake --build --preset clang'
inside benchmarks bash -c 'cmake --preset benchmark && cmake --build --preset benchmark'

sed -n '/^== not /,$p' "$folder/second.log"
cat "$folder/times"
if ((${#failed[@]})); then
  for what in "${failed[@]}"; do printf 'on_debian.sh: failed: %s\n' "$what" >&2; done
  exit 1
fi
say "both commands pass on Debian $1"
