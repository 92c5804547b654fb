#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every option that the help of a program names is completed, and nothing else; files are left to bash.
#   bash test/programs/completion.sh COMPLETION PROGRAM...
set -euo pipefail
source "$1"
compopt() { :; } # only known while bash completes
shift

complete_word() { # PROGRAM WORD
  COMP_WORDS=("$1" "$2") COMP_CWORD=1 COMPREPLY=()
  _pcl_bsh "$1" "$2" ""
}

failed=0
expect() { # WHAT FOUND WANTED
  [[ "$2" == "$3" ]] || { printf '%s: found `%s`, wanted `%s`\n' "$@" >&2; failed=1; }
}

for program in "$@"; do
  complete -p "$(basename "$program")" >/dev/null || failed=1
  options="$("$program" --help | grep -oE '^  (-h,)?--[a-z-]+' | grep -oE -- '--[a-z-]+')"
  [[ "$options" == --help*--* ]] || { printf '%s: no options in its help\n' "$program" >&2; failed=1; }
  complete_word "$program" --
  expect "$program, all" "$(printf '%s\n' "${COMPREPLY[@]%.}")" "$options"
  last="${options##*$'\n'}"
  complete_word "$program" "$last"
  expect "$program, one" "${COMPREPLY[*]%.}" "$last"
  complete_word "$program" --no-such-option
  expect "$program, none" "${COMPREPLY[*]}" ""
  complete_word "$program" scan
  expect "$program, a file" "${COMPREPLY[*]}" ""
done
exit "$failed"
