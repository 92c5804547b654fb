#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the tests by what they notice: changes the sources one place at a time, builds, and runs tests.

    mutate.py BUILD [--rooms flags,pairs] [--count 30] [--seed 1] [--only ID] [--list] [--report]

BUILD is a configured build folder, which the mutants are built in: of the preset `mutation`, say. Rooms are rows of the
table below. Each mutant changes a source in place, is built, and meets the tests of its room one executable after
another until one fails; then the source is as it was, also when this program is stopped. Results are lines of
BUILD/mutants.jsonl; mutants that have one are not tried again. --list prints the mutants that there are, --report the
score.
"""
import argparse
import collections
import datetime
import hashlib
import json
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]

# Folder of sources: the rooms whose tests are run, the first one first.
ROOMS = {
    "simd": ["geometry", "pairs", "flags", "distances", "query"],
    "geometry": ["geometry", "pairs", "symmetries", "query"],
    "hierarchy": ["hierarchy", "symmetries", "query"],
    "query": ["query", "flags", "pairs"],
    "traversal": ["pairs", "flags", "symmetries", "query"],
    "pairs": ["pairs", "symmetries", "query"],
    "flags": ["flags", "symmetries", "query"],
    "distances": ["distances", "symmetries", "query"],
    "neighbors": ["neighbors", "symmetries", "query"],
    "clusters": ["clusters", "query"],
    "surface": ["surface", "question"],
    "trajectory": ["trajectory", "symmetries", "query"],
    "roadmap": ["roadmap", "symmetries", "query"],
    "scene": ["scene", "query"],
    "clashes": ["clashes"],
    "question": ["question", "symmetries"],
    "site": ["site"],
    "io/files": ["files", "site"],
    "io/text": ["text", "clouds"],
    "io/poses": ["poses"],
    "io/json": ["json", "scenes"],
    "io/clouds": ["clouds"],
    "io/scenes": ["scenes"],
    "io/reports": ["reports"],
}

# Name, what is found (in code, without comments and strings), what takes its place.
OPERATORS = [
    ("boundary", r"(?<=[\w)\]] )<(?= [\w(\-!])", "<="),
    ("boundary", r"(?<=[\w)\]] )<=(?= )", "<"),
    ("boundary", r"(?<=[\w)\]] )>(?= [\w(\-!])", ">="),
    ("boundary", r"(?<=[\w)\]] )>=(?= )", ">"),
    ("comparison", r"(?<= )==(?= )", "!="),
    ("comparison", r"(?<= )!=(?= )", "=="),
    ("sign", r"(?<=[\w)\]] )\+(?= [\w(])", "-"),
    ("sign", r"(?<=[\w)\]] )-(?= [\w(])", "+"),
    ("term", r"(?<=[\w)\]]) [+-] \w[\w.]*(?=[;,)])", ""),
    ("factor", r"(?<=[\w)\]]) \* \w[\w.]*(?=[;,)])", ""),
    ("logic", r"(?<= )&&(?= )", "||"),
    ("logic", r"(?<= )\|\|(?= )", "&&"),
    ("negation", r"(?<=[(\s])!(?=[\w(])", ""),
    ("guard", r"(?<=if \()(?!constexpr)[^()]*(?:\([^()]*\)[^()]*)*(?=\) (?:return|continue|break|throw|failToWrite)\b)", "false"),
    ("half", r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?)(?![\w.])", r"(0.5 * \1)"),
    ("extreme", r"\bmax\(", "min("),
    ("extreme", r"\bmin\(", "max("),
    ("extreme", r"\bhn::Max\(", "hn::Min("),
    ("extreme", r"\bhn::Min\(", "hn::Max("),
    ("side", r"(?<=\W)a(?=\.(?:pose|hierarchy|view)\b)", "b"),
    ("side", r"(?<=\W)b(?=\.(?:pose|hierarchy|view)\b)", "a"),
    ("side", r"\bSide::a\b", "Side::b"),
    ("index", r"(?<=\[)(\w+)(?=\])(?!\s*\()", r"\1 + 1"),
    ("invalidation", r"^\s*\w[\w.>\-]*(?:clear|reset|invalidate|forget\w*|drop\w*|notify\w*)\([^;]*\);", ";"),
    ("unlock", r"^\s*const auto lock = [^;]*;", ";"),
    ("sync", r"^\s*sync\w*\([^;]*\);", ";"),
    ("sync", r"\bfsync\(\w+\) != 0", "false"),
    ("rounding", r"\broundUp\(", "roundDown("),
    ("rounding", r"\broundDown\(", "roundUp("),
]

Mutant = collections.namedtuple("Mutant", "id room file line column operator before after")


def code_of(line):
    """The line with comments and strings blanked, of the same length."""
    blank = lambda match: " " * len(match.group())
    line = re.sub(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'', blank, line)
    return re.sub(r"//.*", blank, line)


def mutants_of(room):
    folder = SOURCE / "pcl_bsh" / room
    for file in sorted(folder.rglob("*")):
        if file.suffix not in (".cpp", ".h"):
            continue
        name = file.relative_to(SOURCE).as_posix()
        for number, line in enumerate(file.read_text().splitlines(), 1):
            code = code_of(line)
            if re.match(r"\s*(#|template|static_assert|using|namespace|/?\*)", code) or "operator" in code:
                continue
            for operator, pattern, replacement in OPERATORS:
                for match in re.finditer(pattern, code):
                    text = line[match.start():match.end()]
                    after = match.expand(replacement)
                    # By what it changes, not by where: lines move.
                    key = hashlib.sha1(f"{name}|{line.strip()}|{match.start() - len(line) + len(line.lstrip())}|"
                                       f"{operator}|{after}".encode()).hexdigest()[:10]
                    changed = line[:match.start()] + after + line[match.end():]
                    yield Mutant(key, room, name, number, match.start(), operator, line, changed)


class Changed:
    """A source with a mutant in it. What it was is kept beside the results, in case this program is killed."""

    def __init__(self, build):
        self.kept = build / "mutated.json"

    def restore(self):
        if self.kept.exists():
            kept = json.loads(self.kept.read_text())
            (SOURCE / kept["file"]).write_text(kept["text"])
            self.kept.unlink()

    def put(self, mutant):
        file = SOURCE / mutant.file
        text = file.read_text()
        lines = text.splitlines(keepends=True)
        self.kept.write_text(json.dumps({"file": mutant.file, "text": text}))
        lines[mutant.line - 1] = mutant.after + "\n"
        file.write_text("".join(lines))


def build(folder, targets):
    return subprocess.run(["cmake", "--build", str(folder), "--target", *targets], capture_output=True, text=True)


def run_test(folder, room, limit):
    """None where all tests pass, else what failed first."""
    try:
        run = subprocess.run([str(folder / "test" / f"{room}_test"), "--gtest_fail_fast", "--gtest_brief=1"],
                             capture_output=True, text=True, errors="replace", timeout=limit, cwd=folder)
    except subprocess.TimeoutExpired:
        return "timed out", room
    if run.returncode == 0:
        return None
    failed = re.search(r"^\[  FAILED  \] (\S+)", run.stdout, re.MULTILINE)
    return "killed", failed.group(1).rstrip(",") if failed else f"{room}_test, which ended with {run.returncode}"


def trial(folder, mutant, changed, limits):
    result = dict(mutant._asdict(), date=datetime.date.today().isoformat())
    rooms = ROOMS[mutant.room]
    try:
        changed.put(mutant)
        for room in filter(limits.get, rooms):
            built = build(folder, [f"{room}_test"])
            if built.returncode != 0:
                return dict(result, result="not compiled")
            failed = run_test(folder, room, limits[room])
            if failed:
                return dict(result, result=failed[0], test=failed[1])
        return dict(result, result="survived", test=", ".join(filter(limits.get, rooms)))
    finally:
        changed.restore()


def report(results):
    counts = collections.Counter(result["result"] for result in results)
    tried = sum(counts.values()) - counts["not compiled"]
    noticed = counts["killed"] + counts["timed out"]
    print(f"{tried} mutants, {noticed} noticed ({100 * noticed / max(1, tried):.0f} %): {counts['killed']} killed, "
          f"{counts['timed out']} timed out, {counts['survived']} survived; {counts['not compiled']} more did not compile\n")
    print("| room | noticed | survived |\n|---|---|---|")
    for room in ROOMS:
        ours = [result["result"] for result in results if result["room"] == room]
        if ours:
            print(f"| {room} | {sum(result in ('killed', 'timed out') for result in ours)} | {ours.count('survived')} |")
    print("\n| survivor | operator | line | with |\n|---|---|---|---|")
    for result in results:
        if result["result"] == "survived":
            before, after = (result[key].strip().replace("|", "\\|") for key in ("before", "after"))
            print(f"| {result['id']} {result['file']}:{result['line']} | {result['operator']} | `{before}` | `{after}` |")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--rooms", default=",".join(ROOMS))
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args()
    folder = options.build.resolve()
    file = folder / "mutants.jsonl"
    results = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    if options.report:
        return report(results)
    changed = Changed(folder)
    changed.restore()
    rooms = options.rooms.split(",")
    unknown = [room for room in rooms if room not in ROOMS]
    if unknown:
        sys.exit(f"mutate.py: --rooms: there is no {unknown[0]}: there are {', '.join(ROOMS)}")
    mutants = [mutant for room in rooms for mutant in mutants_of(room)]
    if options.list:
        for mutant in mutants:
            print(f"{mutant.id} {mutant.file}:{mutant.line} {mutant.operator}: {mutant.after.strip()}")
        return None
    random.Random(options.seed).shuffle(mutants)
    tried = {result["id"] for result in results}
    chosen = [mutant for mutant in mutants if (mutant.id == options.only if options.only else mutant.id not in tried)]
    for stop in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(stop, lambda *_: sys.exit("mutate.py: stopped"))
    limits = {}
    targets = subprocess.run(["cmake", "--build", str(folder), "--target", "help"], capture_output=True,
                             text=True).stdout.splitlines()
    for room in dict.fromkeys(room for mutant in chosen[:options.count] for room in ROOMS[mutant.room]):
        if not any(line.startswith(f"{room}_test:") for line in targets):
            continue  # a component that is not built
        built = build(folder, [f"{room}_test"])
        start = time.monotonic()
        failed = "is not built" if built.returncode != 0 else run_test(folder, room, 3600)
        if failed:
            sys.exit(f"mutate.py: {room}_test fails without a mutant: {failed}")
        limits[room] = 60 + 5 * (time.monotonic() - start)
    with file.open("a") as out:
        for mutant in chosen[:options.count]:
            result = trial(folder, mutant, changed, limits)
            out.write(json.dumps(result) + "\n")
            out.flush()
            print(f"{result['result']} {mutant.id} {mutant.file}:{mutant.line} {mutant.operator}: "
                  f"{mutant.after.strip()}  [{result.get('test', '')}]", flush=True)
    return None


if __name__ == "__main__":
    sys.exit(main())
