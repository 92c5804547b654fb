#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every option and subcommand that the help of a program names is in its manual page, with the exit codes and an example;
# groff and mandoc, where they are installed, have nothing to warn of.
#   bash test/tools/programs/man_pages.sh FOLDER_OF_PROGRAMS PAGE...
set -euo pipefail
programs="$1"
shift
failed=0
fail() { printf '%s\n' "$*" >&2; failed=1; }

(($#)) || fail "no pages"
for page in "$@"; do
  program="$programs/$(basename "$page" .1)"
  text="$(sed -e 's/\\-/-/g' "$page")"
  expect() { grep -qE -- "$1" <<<"$text" || fail "$page: no line matches $1"; }
  expect "^$(basename "$program") - [A-Z]"
  expect '^\.SH EXIT STATUS$'
  expect '^0 .*; 1 .*; 2 .*; 130 stopped by Ctrl.*C\.$'
  expect '^\.SH EXAMPLES$'
  subcommands="$("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')"
  for command in "" $subcommands; do
    [[ -z "$command" ]] || expect "^\.SS $(basename "$program") $command$"
    while read -r option; do
      expect "^\.B (-h,)?$option( |$)"
    done < <("$program" $command --help | sed -n '/^Options:/,/^[^ ]/s/^  \(-h,\)\{0,1\}\(--[^ ]*\).*/\2/p')
  done
  if command -v groff >/dev/null; then # groff-base, which man needs too
    warnings="$(groff -man -ww -Tutf8 -z "$page" 2>&1)"
    [[ -z "$warnings" ]] || fail "$page: groff: $warnings"
  fi
  if command -v mandoc >/dev/null; then # no date, so that a build is like the one before
    warnings="$(mandoc -T lint -W warning "$page" | grep -v 'missing date' || true)"
    [[ -z "$warnings" ]] || fail "$warnings"
  fi
done
exit "$failed"
