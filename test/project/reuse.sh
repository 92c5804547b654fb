#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A compiler's launcher: copies an object of another build where that one is listed, and compiles otherwise.
# PREFIX: the folder, below this build's, which stands for the other build; . for this build's own.
#   bash reuse.sh BUILD LIST PREFIX COMPILER OPTION...
set -euo pipefail
build="$1" list="$2" prefix="$3"
shift 3
object="" dependencies=""
for ((i = 1; i < $#; ++i)); do
  next=$((i + 1))
  if [[ "${!i}" == -o ]]; then object="${!next}"; fi
  if [[ "${!i}" == -MF ]]; then dependencies="${!next}"; fi
done
there="${object#"$prefix"/}"
if [[ -n "$object" && -f "$build/$there" ]] && grep -qxF "$there" "$list"; then
  cp "$build/$there" "$object"
  printf '%s:\n' "$object" >"$dependencies"
else
  exec "$@"
fi
