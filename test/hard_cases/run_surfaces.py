#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds any programs against the hard cases of surfaces and solids, and prints a table in Markdown.

    run_surfaces.py NAME=COMMAND...

Each command is run as `COMMAND within INPUT MESH.off CLEARANCE [POSE]` and, where the mesh is closed and the input is
points, `COMMAND labels ...`: it prints a digit for each record of the input (run `hard_surfaces_peers` for what they
mean), or fails where it has no answer. It has 60 s. A cell has how many records are wrong; insides beside, where
wrong labels count as well; *on the surface* counts as inside or outside for a program that tells no surface. Rows in
which all are right are left out. The exit code is 1 where the first program is wrong.
"""
import json
import pathlib
import shlex
import sys

import run

FOLDER = pathlib.Path(__file__).resolve().parent / "surfaces"


def answer(command, kind, case):
    arguments = [kind, FOLDER / case.get("points", case.get("other", "")), FOLDER / case["mesh"], repr(case["clearance"])]
    return run.output(command, arguments + [repr(float(x)) for x in case.get("pose", [])], None)


def wrong_of(found, truth, surface_told):
    """How many digits are wrong; or what there is instead of digits."""
    if found is None or not found.isdigit():
        return found or "none"
    return str(sum(f != t and (surface_told or t != "2") for f, t in zip(found, truth)) + abs(len(found) - len(truth)))


def answers(programs):
    """@param programs names and commands
    @return a row for each case: under the name of each program how many records are wrong, and after a semicolon how
    many insides are; none: it does not answer"""
    for case in json.loads((FOLDER / "cases.json").read_text())["cases"]:
        if "open_edges" in case:
            continue
        labels = "".join(map(str, case.get("labels", []))) if "points" in case else ""
        row = {"case": case["name"]}
        for i, (name, command) in enumerate(programs):
            command = shlex.split(command)
            found = answer(command, "within", case)
            if i == 0:
                row["records"] = str(len(found))
            truth = "".join("1" if k in set(case["colliding"]) else "0" for k in range(int(row["records"])))
            row[name] = wrong_of(found, truth, True)
            if labels:
                found = answer(command, "labels", case)
                row[name] += "; " + wrong_of(found, labels, found is not None and "2" in found)
        yield row


def table(rows, names):
    """The lines of a table in Markdown, as its rows become known. A case counts as wrong where its program answered."""
    def cell(text):
        return "; ".join("right" if part == "0" else part if part == "none" else f"**{part}**" for part in text.split("; "))
    yield "| case | records |" + "".join(f" {name} |" for name in names)
    yield "|---|---|" + "---|" * len(names)
    cases, wrong = 0, [0] * len(names)
    for row in rows:
        cells = [cell(row[name]) for name in names]
        cases += 1
        wrong = [count + ("**" in text) for count, text in zip(wrong, cells)]
        if any("**" in text for text in cells):
            yield f"| {row['case']} | {row['records']} |" + "".join(f" {text} |" for text in cells)
    yield f"| cases, of them wrong | {cases} |" + "".join(f" {count} |" for count in wrong)


if __name__ == "__main__":
    sys.exit(run.main(sys.argv[1:], __doc__, answers, table, lambda row, name: set(row[name].split("; ")) == {"0"}))
