#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# All that must hold: every test in a release build, those of hierarchies and queries under AddressSanitizer and
# UndefinedBehaviorSanitizer, and those of them that use threads under ThreadSanitizer. Installs what is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/setup.sh release
bash cmake/setup.sh asan
bash cmake/setup.sh tsan

failed=()
for preset in tsan asan release; do # release last: its summary is what one wants to see
  printf '== testing build/%s\n' "$preset"
  ctest --preset "$preset" --parallel "$(nproc)" || failed+=("$preset")
done
if ((${#failed[@]})); then
  printf 'test/run.sh: tests failed in: %s\n' "${failed[*]}" >&2
  exit 1
fi
