#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Everything that must hold: the tests of the release build, all tests but those of the programs under AddressSanitizer
# and UndefinedBehaviorSanitizer, the threaded ones under ThreadSanitizer. Installs what is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for preset in release asan tsan; do
  bash cmake/setup.sh "$preset"
done

failed=()
for preset in tsan asan release; do # release last: its summary is what one wants to see
  printf '== testing build/%s\n' "$preset"
  ctest --preset "$preset" --parallel "$(nproc)" || failed+=("$preset")
done
if ((${#failed[@]})); then
  printf 'test/run.sh: tests failed in: %s\n' "${failed[*]}" >&2
  exit 1
fi
