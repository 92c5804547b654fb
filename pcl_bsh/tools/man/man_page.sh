#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes the manual page of a program from what its --help says, and that of each of its subcommands.
#   bash man_page.sh VERSION PROGRAM PAGE
set -euo pipefail
version="$1" program="$2" page="$3"
name="$(basename "$program")"

# Lines of --help become sections; two blanks begin an entry, deep ones go on with it, and what comes after the last list
# of entries is text. Only what is laid out by hand (examples, tables) keeps its lines.
roff() { # WHOLE PAGE: 1, or SUBCOMMAND: 0
  awk -v page="$1" -v name="$name" -v version="$version" '
    function plain(text) {
      gsub(/\\/, "\\e", text)
      gsub(/-/, "\\-", text)
      sub(/^[.\047]/, "\\\\\\&&", text)
      return text
    }
    function section(title) { print (page ? ".SH " : ".SS ") toupper(title); kept = 0 }
    function keep(on) {
      if (on && !kept) print ".PP\n.nf"
      if (!on && kept) print ".fi"
      kept = on
    }
    NR == 1 && page {
      sub(/\.$/, "")
      printf ".TH %s 1 \"\" \"pcl_bsh %s\" \"pcl_bsh\"\n.SH NAME\n%s \\- %s\n", toupper(name), version, name, plain($0)
      next
    }
    NR == 1 { sub(/\.$/, ""); print plain($0) "."; next }
    !footer && /^Usage: / {
      sub(/^Usage: /, "")
      if (page) print ".SH SYNOPSIS"
      else print ".PP"
      sub(/^.*\/pcl_bsh_/, "pcl_bsh_")
      print ".B " plain($0)
      next
    }
    !footer && /^[A-Z][A-Za-z ]*:$/ { sub(/:$/, ""); if (page) section($0); entries = 1; next }
    !footer && entries && /^  [^ ]/ {
      line = substr($0, 3)
      gap = match(line, /  +/)
      print ".TP\n.B " plain(gap ? substr(line, 1, gap - 1) : line)
      if (gap) print plain(substr(line, gap + RLENGTH))
      next
    }
    !footer && entries && /^ +[^ ]/ { sub(/^ +/, ""); print plain($0); next }
    /^ *$/ { if (footer) { keep(0); print ".PP" } next }
    !page { exit }
    {
      if (!footer) { section("Description"); footer = 1 }
      if (/^Exit codes?: /) { keep(0); section("Exit status"); sub(/^Exit codes?: /, ""); exited = 1 }
      else if (/^Examples?:/) {
        keep(0)
        if (!examples++) section("Examples")
        else print ".PP"
        sub(/^Examples?: */, "")
        if ($0 == "") next
      }
      else if (exited && !examples && /^[A-Z]/) { section("Notes"); exited = 0 }
      keep(/^  /)
      print plain($0)
    }
    END { keep(0) }
  ' | awk '/^\.PP$/ { waits = !headed; next } # no paragraph is empty
    waits && !/^\.S[HS] / { print ".PP" } { waits = 0; headed = /^\.S[HS] / } { print }'
}

# Help is read to its end, whatever is made of it: programs tell when nobody reads what they say.
{
  help="$("$program" --help)"
  roff 1 <<<"$help"
  subcommands="$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")"
  [[ -z "$subcommands" ]] || printf '.SH SUBCOMMANDS, EACH WITH ITS OPTIONS\n'
  for subcommand in $subcommands; do
    printf '.SS %s %s\n' "${name//-/\\-}" "$subcommand"
    help="$("$program" "$subcommand" --help)"
    roff 0 <<<"$help"
  done
} >"$page.part"
mv "$page.part" "$page"
