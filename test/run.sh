#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# All that must hold: every test in a release build, those of hierarchies and queries under AddressSanitizer and
# UndefinedBehaviorSanitizer, and those of them that use threads under ThreadSanitizer. Installs what is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/setup.sh release
bash cmake/setup.sh asan
bash cmake/setup.sh tsan
bash examples/demo/fetch_scans.sh build/demo || printf 'test/run.sh: no scans: what needs them is skipped\n' >&2

failed=()
for preset in tsan asan release; do # release last: its summary is what one wants to see
  printf '== testing build/%s\n' "$preset"
  ctest --preset "$preset" --parallel "$(nproc)" || failed+=("$preset")
done

# What was not tested, be it that something was missing when it was configured or when it ran, and what to do.
for preset in tsan asan release; do
  skipped="$(sed -n '/: Skipped$/{n;p}' "build/$preset/Testing/Temporary/LastTest.log" 2>/dev/null | sort | uniq -c | sort -rn)" || true
  missing="$(sed 's/^/        /' "build/$preset/not_tested.txt" 2>/dev/null)" || true
  if [[ -n "$skipped$missing" ]]; then
    printf '== not tested in build/%s (number of tests, what is missing, what to do)\n' "$preset"
    printf '%s\n' "$skipped" "$missing" | sed '/^$/d'
  fi
done
if ((${#failed[@]})); then
  printf 'test/run.sh: tests failed in: %s\n' "${failed[*]}" >&2
  exit 1
fi
