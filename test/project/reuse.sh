#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A compiler's launcher: copies an object of another build where that one is listed, and compiles otherwise.
#   bash reuse.sh BUILD LIST COMPILER OPTION...
set -euo pipefail
build="$1" list="$2"
shift 2
object="" dependencies=""
for ((i = 1; i < $#; ++i)); do
  next=$((i + 1))
  if [[ "${!i}" == -o ]]; then object="${!next}"; fi
  if [[ "${!i}" == -MF ]]; then dependencies="${!next}"; fi
done
if [[ -n "$object" && -f "$build/$object" ]] && grep -qxF "$object" "$list"; then
  cp "$build/$object" "$object"
  printf '%s:\n' "$object" >"$dependencies"
else
  exec "$@"
fi
