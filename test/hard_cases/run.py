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


def answer(command, case):
    arguments = [FOLDER / case["a"], FOLDER / case["b"], repr(case["clearance"])]
    arguments += [repr(float(x)) for x in case.get("pose", IDENTITY)]
    try:
        run = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "no answer in 60 s"
    if run.returncode < 0:
        return "crash"
    return run.stdout.strip() if run.returncode == 0 else "error"


def main(arguments):
    if not arguments or any("=" not in argument for argument in arguments):
        sys.stderr.write(__doc__)
        return 2
    programs = [argument.split("=", 1) for argument in arguments]
    cases = json.loads((FOLDER / "cases.json").read_text())["cases"]
    print("| case | exact |" + "".join(f" {name} |" for name, _ in programs))
    print("|---|---|" + "---|" * len(programs))
    wrong = [0] * len(programs)
    for number, group in itertools.groupby(cases, key=lambda case: case["name"].split(",")[0].split()[0]):
        group = list(group)
        truths = [str(case["colliding_pairs"]) for case in group]
        cells = []
        for i, (_, command) in enumerate(programs):
            answers = [answer(shlex.split(command), case) for case in group]
            missed = sum(found != truth for found, truth in zip(answers, truths))
            wrong[i] += missed
            cells.append("right" if missed == 0 else f"**{answers[0]}**" if len(group) == 1 else f"**{missed} wrong**")
        if any(cell != "right" for cell in cells):
            exact = truths[0] if len(group) == 1 else f"{len(group)} cases"
            print(f"| {number} | {exact} |" + "".join(f" {cell} |" for cell in cells), flush=True)
    print(f"| wrong, of {len(cases)} | |" + "".join(f" {count} |" for count in wrong))
    return 1 if wrong[0] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
