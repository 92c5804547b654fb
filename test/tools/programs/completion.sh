#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every subcommand and option that the help of a program names is completed, and nothing else; files are left to bash.
#   bash test/tools/programs/completion.sh COMPLETION PROGRAM...
set -euo pipefail
source "$1"
compopt() { :; } # only known while bash completes
shift

complete_word() { # PROGRAM [SUBCOMMAND] WORD
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _pcl_bsh "$1" "${@: -1}" ""
}

failed=0
expect() { # WHAT FOUND WANTED
  [[ "$2" == "$3" ]] || { printf '%s: found `%s`, wanted `%s`\n' "$@" >&2; failed=1; }
}

expect_options() { # PROGRAM [SUBCOMMAND]
  local options last
  options="$("$@" --help | grep -oE '^  (-h,)?--[a-z-]+' | grep -oE -- '--[a-z-]+')"
  [[ "$options" == --help* ]] || { printf '%s: no options in its help\n' "$*" >&2; failed=1; }
  complete_word "$@" --
  expect "$*, all" "$(printf '%s\n' "${COMPREPLY[@]%.}")" "$options"
  last="${options##*$'\n'}"
  complete_word "$@" "$last"
  expect "$*, one" "${COMPREPLY[*]%.}" "$last"
  complete_word "$@" --no-such-option
  expect "$*, none" "${COMPREPLY[*]}" ""
  complete_word "$@" scan
  expect "$*, a file" "${COMPREPLY[*]}" ""
}

for program in "$@"; do
  complete -p "$(basename "$program")" >/dev/null || failed=1
  expect_options "$program"
  for subcommand in $("$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]*\)  .*/\1/p'); do
    complete_word "$program" "${subcommand:0:3}"
    expect "$program, subcommand" "${COMPREPLY[*]}" "$subcommand"
    expect_options "$program" "$subcommand"
  done
done
exit "$failed"
