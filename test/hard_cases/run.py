#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds any programs against the catalogue of hard cases, and prints a table in Markdown.

    run.py NAME=COMMAND...

Each command is run as `COMMAND A.pcd B.pcd CLEARANCE POSE`, where POSE is the twelve numbers of T_a_b, row by row (the
last row is 0 0 0 1), and prints how many ordered pairs of a point of a and a point of b, moved by T_a_b, have a
distance <= CLEARANCE. It may crash, and has 60 s. cases.json has the answers of exact arithmetic. Cases of one number
share a row; rows in which all are right are left out. The exit code is 1 where the first program is wrong.
"""
import itertools
import json
import pathlib
import shlex
import subprocess
import sys

IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
FOLDER = pathlib.Path(__file__).resolve().parent


def output(command, arguments, error):
    """The output of a program; `error` where it fails"""
    try:
        run = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "no answer in 60 s"
    if run.returncode < 0:
        return "crash"
    return run.stdout.strip() if run.returncode == 0 else error


def answer(command, case):
    arguments = [FOLDER / case["a"], FOLDER / case["b"], repr(case["clearance"])]
    return output(command, arguments + [repr(float(x)) for x in case.get("pose", IDENTITY)], "error")


def answers(programs):
    """@param programs names and commands @return a row for each case, with the answer of each program under its name"""
    for case in json.loads((FOLDER / "cases.json").read_text())["cases"]:
        yield {"case": case["name"], "exact": str(case["colliding_pairs"]),
               **{name: answer(shlex.split(command), case) for name, command in programs}}


def table(rows, names):
    """The lines of a table in Markdown, as its rows become known."""
    yield "| case | exact |" + "".join(f" {name} |" for name in names)
    yield "|---|---|" + "---|" * len(names)
    wrong, cases = [0] * len(names), 0
    for number, group in itertools.groupby(rows, key=lambda row: row["case"].split(",")[0].split()[0]):
        group = list(group)
        cases += len(group)
        cells = []
        for i, name in enumerate(names):
            missed = sum(row[name] != row["exact"] for row in group)
            wrong[i] += missed
            cells.append("right" if missed == 0 else f"**{group[0][name]}**" if len(group) == 1 else f"**{missed} wrong**")
        if any(cell != "right" for cell in cells):
            exact = group[0]["exact"] if len(group) == 1 else f"{len(group)} cases"
            yield f"| {number} | {exact} |" + "".join(f" {cell} |" for cell in cells)
    yield f"| wrong, of {cases} | |" + "".join(f" {count} |" for count in wrong)


def main(arguments, usage, answers, table, is_right):
    """Prints the table of the programs that the arguments name. @param is_right(row, name) @return the exit code"""
    if not arguments or any("=" not in argument for argument in arguments):
        sys.stderr.write(usage)
        return 2
    programs = [argument.split("=", 1) for argument in arguments]
    rows = []
    for line in table((rows.append(row) or row for row in answers(programs)), [name for name, _ in programs]):
        print(line, flush=True)
    return 0 if all(is_right(row, programs[0][0]) for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], __doc__, answers, table, lambda row, name: row[name] == row["exact"]))
