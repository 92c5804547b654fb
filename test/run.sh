#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs all tests in a release build, a part of them (hierarchies, queries, memory, fuzz targets) under AddressSanitizer
# and UndefinedBehaviorSanitizer, and those of the part that use threads under ThreadSanitizer. The tests of the core are
# compiled once, for the release build. Installs the packages that are missing.
#   PCL_SOURCE_TEST_DIR=FOLDER bash test/run.sh     FOLDER: test/ of PCL's sources (`apt-get source pcl`): PCL's own tests of
#                                                   its search classes run on ours, too
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ -n "${CI:-}" ]]; then export PCL_BSH_WERROR=ON; fi # elsewhere a newer compiler's warnings stop nobody
bash cmake/setup.sh release
bash cmake/setup.sh asan
bash cmake/setup.sh tsan
bash examples/demo/fetch_scans.sh build/demo || printf 'test/run.sh: the scans could not be fetched: tests that need them are skipped\n' >&2

failed=()
for preset in tsan asan release; do # release last: its summary is read most
  printf '== testing build/%s\n' "$preset"
  ctest --preset "$preset" --parallel "$(nproc)" || failed+=("$preset")
done

# Parts that were not tested, because something was missing at configuration or at run time, with a
# remedy.
for preset in tsan asan release; do
  skipped="$(sed -n '/: Skipped$/{n;p}' "build/$preset/Testing/Temporary/LastTest.log" 2>/dev/null | sort | uniq -c | sort -rn)" || true
  missing="$(sed 's/^/        /' "build/$preset/not_tested.txt" 2>/dev/null)" || true
  if [[ -n "$skipped$missing" ]]; then
    printf '== not tested in build/%s (number of tests, what is missing, what to do)\n' "$preset"
    printf '%s\n' "$skipped" "$missing" | sed '/^$/d'
  fi
done
if [[ -s build/not_installed.txt ]]; then
  printf '== not installed\n'
  cat build/not_installed.txt
fi
if ((${#failed[@]})); then
  printf 'test/run.sh: tests failed in: %s\n' "${failed[*]}" >&2
  exit 1
fi
