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
import itertools
import json
import pathlib
import shlex
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent / "surfaces"


def answer(command, kind, case):
    arguments = [kind, FOLDER / case.get("points", case.get("other", "")), FOLDER / case["mesh"], repr(case["clearance"])]
    arguments += [repr(float(x)) for x in case.get("pose", [])]
    try:
        run = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "no answer in 60 s"
    if run.returncode < 0:
        return "crash"
    return run.stdout.strip() if run.returncode == 0 else None


def wrong_of(found, truth, surface_told):
    if found is None or not found.isdigit():
        return found
    return sum(f != t and (surface_told or t != "2") for f, t in zip(found, truth)) + abs(len(found) - len(truth))


def main(arguments):
    if not arguments or any("=" not in argument for argument in arguments):
        sys.stderr.write(__doc__)
        return 2
    programs = [argument.split("=", 1) for argument in arguments]
    cases = [case for case in json.loads((FOLDER / "cases.json").read_text())["cases"] if "open_edges" not in case]
    print("| case | records |" + "".join(f" {name} |" for name, _ in programs))
    print("|---|---|" + "---|" * len(programs))
    first_wrong = 0
    for case in cases:
        labels = "".join(map(str, case.get("labels", []))) if "points" in case else ""
        count = None
        cells = []
        for i, (_, command) in enumerate(programs):
            command = shlex.split(command)
            found = answer(command, "within", case)
            count = len(found) if i == 0 else count
            truth = "".join("1" if k in set(case["colliding"]) else "0" for k in range(count))
            missed = wrong_of(found, truth, True)
            cell = "no answer" if missed is None else "right" if missed == 0 else f"**{missed}**"
            misled = 0
            if labels:
                found = answer(command, "labels", case)
                misled = wrong_of(found, labels, found is not None and "2" in found)
                cell += "; " + ("no answer" if misled is None else "right" if misled == 0 else f"**{misled}**")
            first_wrong += i == 0 and bool(missed or misled)
            cells.append(cell)
        if any(cell not in ("right", "right; right") for cell in cells):
            print(f"| {case['name']} | {count} |" + "".join(f" {cell} |" for cell in cells), flush=True)
    print(f"| cases | {len(cases)} |" + " |" * len(programs))
    return 1 if first_wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
