#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The figures of README.md, BENCHMARK.md and RESULTS.md are rows of results/*.csv, made by the programs here.

    tables.py check             # compares the documents with the rows
    tables.py write             # writes the tables anew from the rows
    tables.py rows BUILD [CSV]  # runs the programs of a built preset `benchmark` (make_rows.py): all, or those that make CSV

A table names what makes it by the line before it: `<!-- rows: flags, of flags_terrain.csv -->`, where `flags` is a function
of row_tables.py. A table of times without such a line is wrong.
"""
import argparse
import pathlib
import re
import sys

sys.dont_write_bytecode = True  # no folders beside the sources
import make_rows  # noqa: E402
from row_tables import TABLES, ratio, rows_of, short  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = ("BENCHMARK.md", "test/benchmark/RESULTS.md")


def readme():
    """The README's rows about what BENCHMARK.md has tables of: beginnings of lines, and how they go on."""
    of_flags = rows_of("flags_terrain.csv").where(order="scan", d="5.00")
    ours, nanoflann, kd_tree = (short(round(of_flags.one("total [ms]", racer=racer))) for racer in ("pcl_bsh", "nanoflann", "pcl_kdtree"))
    yield f"| flags: a million points against a million, 5 spacings, both built | {ours} ms | nanoflann {nanoflann} ms, PCL's k-d tree {kd_tree} ms |"
    of_miss = rows_of("rigid_100k.csv").where(query="any", **{"class": "near miss"})
    ours, fcl = (short(round(of_miss.one("median [us]", racer=racer))) for racer in ("pcl_bsh", "fcl"))
    kd_tree = short(of_miss.one("median [us]", racer="pcl_kdtree"))
    yield f"| two bodies of 100,000 points, a near miss | {ours} us | FCL, by hand {fcl} us; PCL's k-d tree {kd_tree} us |"
    of_all = rows_of("distances.csv").where(scene="terrain", limit="none")
    ours, nanoflann, kd_tree = (short(round(of_all.one("least [ms]", racer=racer))) for racer in ("pcl_bsh", "nanoflann", "pcl_kdtree"))
    yield f"| the distance of each of a million points | {ours} ms | nanoflann {nanoflann} ms, PCL's k-d tree {kd_tree} ms |"
    of_balls = rows_of("search.csv").where(scene="terrain", task="probes")
    nanoflann, kd_tree = (ratio(of_balls.one("ratio", racer=racer)) for racer in ("nanoflann", "pcl_kdtree"))
    yield f"| any point in a ball, 50,000 balls | 1 | nanoflann {nanoflann} times, PCL's k-d tree {kd_tree} times as long |"


# Documents ------------------------------------------------------------------------------------------------------------

TIMES = re.compile(r"\d (?:ms|us|s|M|MB)\b|\[ms\]|peer time|MB/s|milliseconds|microseconds")
MARK = re.compile(r"<!-- rows: (\w+), of ([\w.]+) -->")


def written(lines):
    """The lines of a document, with the tables that their marks name."""
    lines, out, i = list(lines), [], 0
    while i < len(lines):
        out.append(lines[i])
        i += 1
        if mark := MARK.fullmatch(out[-1]):
            if mark.group(1) not in TABLES:
                raise ValueError(f"there is no table {mark.group(1)}")
            while i < len(lines) and lines[i].startswith("|"):
                i += 1
            out += list(TABLES[mark.group(1)](rows_of(mark.group(2))))
    return out


def unmarked(lines):
    """How many tables with times each section has that no mark makes."""
    counts, section, i = {}, "", 0
    while i < len(lines):
        if match := re.match(r"#+ (.*)", lines[i]):
            section = match.group(1)
        if lines[i].startswith("|"):
            first = i
            while i < len(lines) and lines[i].startswith("|"):
                i += 1
            text = "\n".join(lines[first:i])
            marked = any(MARK.fullmatch(line) for line in lines[max(0, first - 1):first])
            if not marked and TIMES.search(" ".join(lines[max(0, first - 6):first]) + text):
                counts[section] = counts.get(section, 0) + 1
        else:
            i += 1
    return counts


def check():
    wrong = []
    named = []
    for document in DOCUMENTS:
        lines = (SOURCE / document).read_text().splitlines()
        named += [mark.group(1) for line in lines if (mark := MARK.fullmatch(line))]
        for number, (is_there, made) in enumerate(zip(lines, written(lines)), 1):
            if is_there != made:
                wrong.append(f"{document}:{number}: {is_there}\n  instead of what the rows say: {made}")
                break
        for section, count in unmarked(lines).items():
            wrong.append(f"{document}: {section}: {count} tables with times name no rows: give each a line <!-- rows: ... -->")
    wrong += [f"{', '.join(DOCUMENTS)}: no table {name}: give it a line <!-- rows: ... -->" for name in TABLES if name not in named]
    there = (SOURCE / "README.md").read_text().splitlines()
    wrong += [f"README.md: there is no line of what the rows say: {line}" for line in readme() if line not in there]
    if wrong:
        print("\n".join(wrong))
    return 1 if wrong else 0


def write():
    for document in DOCUMENTS:
        file = SOURCE / document
        file.write_text("\n".join(written(file.read_text().splitlines())) + "\n")
    file = SOURCE / "README.md"
    lines = file.read_text().splitlines()
    for made in readme():
        beginning = made.split(" | ")[0]
        lines = [made if line.startswith(beginning + " |") else line for line in lines]
    file.write_text("\n".join(lines) + "\n")
    return 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("what", choices=["check", "write", "rows"])
    parser.add_argument("build", type=pathlib.Path, nargs="?", default=SOURCE / "build" / "release")
    parser.add_argument("csv", nargs="*")
    options = parser.parse_args()
    if options.what == "rows":
        return make_rows.make(options.build.resolve(), options.csv)
    return check() if options.what == "check" else write()


if __name__ == "__main__":
    sys.exit(main())
