#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the tests by what they notice of small changes of the sources.

    mutate.py make WORK [--rooms flags,pairs] [--count 40] [--seed 1] [--release build/release]
    mutate.py run WORK [--rooms flags,pairs] [--only ID] [--scope own]
    mutate.py report WORK [--csv FILE]

WORK is a folder for a copy of the sources, its build and the results. `make` chooses mutants (COUNT of each room, spread
over its files), writes all of them into the copy behind a switch, and builds copy and tests once. `run` runs the tests of
each room once to see which mutants each reaches, then, for each mutant, the tests that reach it, quick ones first, those of
its own room before others, until one fails. --scope own: a second of tests of its own room; quick: the quick tests
of all its rooms; survivors are tried again by a wider scope. Stopped, it goes on where it was. Tests of the core are taken from the release
build as they are. Reasons why survivors cannot be seen are rows of survivors.csv beside this file.
"""
import argparse
import collections
import csv
import datetime
import functools
import itertools
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys

import mutants

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]

# Folder of sources: the rooms whose tests are run, the first one first.
ROOMS = {
    "pcl_bsh/simd": ["pairs", "flags", "distances", "neighbors", "hierarchy", "trajectory", "geometry", "query", "symmetries"],
    "pcl_bsh/geometry": ["geometry", "pairs", "hierarchy", "flags", "distances", "query", "symmetries"],
    "pcl_bsh/hierarchy": ["hierarchy", "pairs", "flags", "distances", "neighbors", "query", "symmetries"],
    "pcl_bsh/query": ["flags", "pairs", "distances", "question", "trajectory", "query", "symmetries"],
    "pcl_bsh/traversal": ["pairs", "flags", "distances", "clusters", "trajectory", "query", "symmetries"],
    "pcl_bsh/pairs": ["pairs", "query", "roadmap", "scene", "symmetries"],
    "pcl_bsh/flags": ["flags", "query", "question", "symmetries"],
    "pcl_bsh/distances": ["distances", "query", "clashes", "question", "symmetries"],
    "pcl_bsh/neighbors": ["neighbors", "query", "question", "symmetries"],
    "pcl_bsh/clusters": ["clusters", "query", "clashes", "symmetries"],
    "pcl_bsh/seen": ["seen", "question"],
    "pcl_bsh/solid": ["solid", "question", "query"],
    "pcl_bsh/trajectory": ["trajectory", "query", "question", "symmetries"],
    "pcl_bsh/roadmap": ["roadmap", "query", "symmetries"],
    "pcl_bsh/scene": ["scene", "query"],
    "pcl_bsh/clashes": ["clashes"],
    "pcl_bsh/question": ["question", "symmetries"],
    "pcl_bsh/io/files": ["files", "clouds", "site"],
    "pcl_bsh/io/text": ["text", "poses", "json", "clouds"],
    "pcl_bsh/io/poses": ["poses", "pipeline"],
    "pcl_bsh/io/json": ["json", "scenes", "reports", "pipeline"],
    "pcl_bsh/io/clouds": ["clouds", "site", "pipeline"],
    "pcl_bsh/io/scenes": ["scenes"],
    "pcl_bsh/io/reports": ["reports", "pipeline"],
    "pcl_bsh/site": ["site"],
    "pcl_bsh/search": ["search"],
    "filters": ["filters", "pipeline"],
}
PARTS = ["filters/pipeline"]  # folders that are no part of the room above them
ROOMS["filters/pipeline"] = ["pipeline"]

# Tests that take more than some seconds: the last that are run.
SLOW = ["*HundredThousandPoints", "*OneHash*", "*Sequences.SameAsBrute*", "*SceneCombinations*", "*NothingCollidesBeforeItsFirst*",
        "*EachIsThatOfTheMotion*", "*GrazingPaths*", "*WorkClimb*", "*H25Any*", "*AnswerAlikePastClusters*", "*FacingSheets*",
        "*HoldsAtEachInstantAsBrute*", "*ScalesWithinScales*", "*TakeNoMoreWork*", "*TenThousandInAnyOrder*",
        "*DistancesAtLargeClearancesCost*", "*Attack*", "*OfAVastSearch*", "*OfASharedStack*", "Symmetries.*"]


def room_of(name):
    return max((room for room in ROOMS if name.startswith(room + "/")), key=len, default=None)


def sources():
    listed = subprocess.run(["git", "-C", str(SOURCE), "ls-files"], capture_output=True, text=True, check=True).stdout
    return [name for name in listed.splitlines() if (SOURCE / name).is_file()]


def write_changed(file, data):
    """Leaves what is the same as it is, so that it is not compiled again."""
    if not file.exists() or file.read_bytes() != data:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


# Making ---------------------------------------------------------------------------------------------------------------

def choose(room, names, count, rng):
    """Mutants of a room: a file after the other, of each one of an operator not yet taken there as long as there are."""
    left = {}
    for name in names:
        found = mutants.mutants_of(name, (SOURCE / name).read_text())
        rng.shuffle(found)
        taken = collections.Counter()
        for mutant in found:
            taken[mutant.operator] += 1
        rank = collections.Counter()
        ordered = []
        for mutant in found:
            rank[mutant.operator] += 1
            ordered.append((rank[mutant.operator], mutant))
        left[name] = [mutant for _, mutant in sorted(ordered, key=lambda pair: pair[0])]
    # A file with many mutants has more turns than one with few.
    turns = [name for name in names for _ in range((len(left[name]) + 19) // 20)]
    rng.shuffle(turns)
    chosen, sites = [], set()
    while len(chosen) < count and any(left.values()):
        for name in turns:
            while left[name]:
                mutant = left[name].pop(0)
                if (name, mutant.site) in sites:
                    continue  # one of each place
                sites.add((name, mutant.site))
                chosen.append(mutant)
                break
            if len(chosen) == count:
                break
    return chosen


def write_copy(work, chosen):
    by_file = collections.defaultdict(list)
    for number, mutant in chosen.items():
        by_file[mutant.file].append((number, mutant))
    header = str(HERE / "mutant.h")
    for name in sources():
        data = (SOURCE / name).read_bytes()
        if name in by_file:
            data = mutants.with_mutants(data.decode(), by_file[name], header).encode()
        write_changed(work / "source" / name, data)


def compile_all(work, chosen, targets):
    """Builds, and leaves out what does not compile, now or before. Returns the numbers left out."""
    kept = work / "not_compiled.json"
    known = set(json.loads(kept.read_text())) if kept.exists() else set()
    left_out = {number for number, mutant in chosen.items() if mutant.id in known}
    while True:
        write_copy(work, {n: m for n, m in chosen.items() if n not in left_out})
        built = subprocess.run(["nice", "-n", "10", "cmake", "--build", str(work / "build"), "--target", *targets, "--", "-j2"],
                               capture_output=True, text=True, errors="replace")
        if built.returncode == 0:
            return left_out
        (work / "errors.txt").write_text(built.stdout + built.stderr)
        places = set()
        for match in re.finditer(r"/source/([\w./-]+):(\d+):\d+: (?:fatal )?(error|note|  ?required)?", built.stdout):
            places.add((match.group(3) == "error", match.group(1), int(match.group(2))))
        def at(errors_only):
            found = set()
            for number, mutant in chosen.items():
                text = (SOURCE / mutant.file).read_text()
                first, last = (text.count("\n", 0, at) + 1 for at in (mutant.site.begin, mutant.site.end))
                if any(file == mutant.file and first <= line <= last and (is_error or not errors_only)
                       for is_error, file, line in places):
                    found.add(number)
            return found - left_out
        new = at(True) or at(False)
        if not new: # what begins there may end badly
            for is_error, file, line in places:
                before = [number for number, mutant in chosen.items() if mutant.file == file and mutant.line <= line]
                new |= set(before[-1:]) - left_out if is_error else set()
        if not new:
            sys.exit(f"mutate.py: the copy does not compile: see {work / 'errors.txt'}")
        left_out |= new
        known |= {chosen[number].id for number in new}
        kept.write_text(json.dumps(sorted(known)))
        print(f"{len(new)} mutants do not compile", flush=True)


def make(options):
    work = options.work.resolve()
    rooms = options.rooms
    names = sources()
    chosen, number = {}, 0
    for room in rooms:
        rng = random.Random(f"{options.seed} {room}")
        ours = [name for name in names if name.endswith((".cpp", ".h", ".hpp")) and room_of(name) == room]
        for mutant in choose(room, ours, options.count, rng):
            number += 1
            chosen[number] = mutant
    write_copy(work, chosen)
    subprocess.run(["cmake", "--preset", "mutation", "-D", f"PCL_BSH_TEST_OBJECTS={options.release.resolve()}", "-D",
                    f"PCL_BSH_SHARED_DIR={SOURCE.parent / 'shared'}"], cwd=work / "source", check=True, stdout=subprocess.DEVNULL)
    tests = list(dict.fromkeys(f"{test}_test" for room in rooms for test in ROOMS[room]))
    left_out = compile_all(work, chosen, tests)
    rows = [dict(mutant._asdict(), number=number, room=room_of(mutant.file), compiled=number not in left_out, site=None)
            for number, mutant in chosen.items()]
    (work / "mutants.json").write_text(json.dumps(rows, indent=1))
    for old in ("reached", "results.jsonl"):
        shutil.rmtree(work / old, ignore_errors=True)
        (work / old).unlink(missing_ok=True)
    print(f"{len(rows) - len(left_out)} mutants are compiled, {len(left_out)} cannot be")


# Running --------------------------------------------------------------------------------------------------------------

Test = collections.namedtuple("Test", "name milliseconds reached")


def run_binary(work, test, environment, arguments, cpu_seconds):
    def limit():
        os.nice(19)
        resource.setrlimit(resource.RLIMIT_CPU, (cpu_seconds, cpu_seconds + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        return subprocess.run([str(work / "build" / "test" / f"{test}_test"), "--gtest_brief=1", *arguments],
                              capture_output=True, text=True, errors="replace", cwd=work, preexec_fn=limit,
                              env=dict(os.environ, **environment), timeout=60 + 30 * cpu_seconds)
    except subprocess.TimeoutExpired:
        return None


@functools.lru_cache(maxsize=None)
def tests_of(work, test, slow):
    """What each quick or slow test of a room reaches, by a run without mutants."""
    kept = work / "reached" / (test + (".slow" if slow else ""))
    if not kept.exists():
        kept.parent.mkdir(exist_ok=True)
        unfinished = kept.with_suffix(kept.suffix + ".part")
        unfinished.unlink(missing_ok=True)
        ran = run_binary(work, test, {"PCL_BSH_MUTANT": "-1", "PCL_BSH_REACHED": str(unfinished)},
                         ["--gtest_filter=" + ("" if slow else "-") + ":".join(SLOW)], 3600)
        if ran is None or ran.returncode < 0:
            sys.exit(f"mutate.py: {test}_test does not run without a mutant")
        unfinished.touch() # where there is none
        unfinished.rename(kept)
    found = []
    for line in kept.read_text().splitlines():
        name, milliseconds, result, *reached = line.split()
        if result == "passed":
            found.append(Test(name, int(milliseconds), set(map(int, reached))))
        else:
            print(f"{name} fails without a mutant, and is left out", file=sys.stderr)
    return found


def batches(tests):
    """Quick ones first: up to a second of them, up to ten, all others."""
    batch, total, most = [], 0, 1000
    for test in sorted(tests, key=lambda test: test.milliseconds):
        if batch and total + test.milliseconds > most:
            yield batch
            batch, total, most = [], 0, 10 * most
        batch.append(test)
        total += test.milliseconds
    if batch:
        yield batch


SCOPES = ["own", "quick", "all"]


def trial(work, mutant, scope):
    """@param scope own: a second of tests of the first room alone; quick: of all its rooms; all: slow ones, too"""
    number, reached = mutant["number"], False
    rooms = ROOMS[mutant["room"]][:1 if scope == "own" else None]
    for room, slow in [(room, slow) for slow in ([False, True] if scope == "all" else [False]) for room in rooms]:
        reaching = batches([test for test in tests_of(work, room, slow) if number in test.reached])
        for batch in itertools.islice(reaching, 1 if scope == "own" else None):
            reached = True
            flags = work / "flags.txt"
            flags.write_text(f"--gtest_filter={':'.join(test.name for test in batch)}\n--gtest_fail_fast\n")
            limit = 3 + 5 * sum(test.milliseconds for test in batch) // 1000
            ran = run_binary(work, room, {"PCL_BSH_MUTANT": str(number)}, [f"--gtest_flagfile={flags}"], limit)
            if ran is None or ran.returncode in (-24, -9):
                return "timed out", f"{room}: {batch[0].name} or another"
            if ran.returncode != 0:
                failed = re.search(r"^\[  FAILED  \] ([^\s,]+)", ran.stdout, re.MULTILINE)
                return "killed", failed.group(1) if failed else f"{room}_test ended with {ran.returncode}"
    return ("survived", ", ".join(ROOMS[mutant["room"]])) if reached else ("not reached", "")


def run(options):
    work = options.work.resolve()
    chosen = [m for m in json.loads((work / "mutants.json").read_text()) if m["compiled"] and m["room"] in options.rooms]
    file = work / "results.jsonl"
    tried = set()
    for result in map(json.loads, file.read_text().splitlines() if file.exists() else []):
        noticed = result["result"] in ("killed", "timed out")
        if noticed or SCOPES.index(result["scope"]) >= SCOPES.index(options.scope):
            tried.add(result["id"])
    chosen = [m for m in chosen if (m["id"] == options.only if options.only else m["id"] not in tried)]
    turn = collections.Counter()
    def place(mutant): # one of each room after another
        turn[mutant["room"]] += 1
        return turn[mutant["room"]]
    with file.open("a") as out:
        for mutant in sorted(chosen, key=place):
            result, test = trial(work, mutant, options.scope)
            mutant = dict(mutant, scope=options.scope, result=result, test=test, date=datetime.date.today().isoformat())
            out.write(json.dumps(mutant) + "\n")
            out.flush()
            print(f"{result} {mutant['id']} {mutant['file']}:{mutant['line']} {mutant['operator']}: {mutant['before']}  =>  "
                  f"{mutant['after']}  [{test}]", flush=True)


# Reporting ------------------------------------------------------------------------------------------------------------

COLUMNS = ["id", "file", "line", "operator", "result", "scope", "test", "date", "before", "after"]


def report(options):
    results = {}
    for line in (options.work / "results.jsonl").read_text().splitlines():
        result = json.loads(line)
        results[result["id"]] = result  # the last one of each
    reasons = {}
    with (HERE / "survivors.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            reasons[row["id"]] = row
    print("| room | mutants | noticed | cannot be seen | survived | not reached |\n|---|---|---|---|---|---|")
    total = collections.Counter()
    for room in ROOMS:
        counts = collections.Counter()
        for result in results.values():
            if result["room"] == room:
                noticed = result["result"] in ("killed", "timed out")
                counts["noticed" if noticed else "explained" if result["id"] in reasons else result["result"]] += 1
        if counts:
            print(f"| `{room}` | {sum(counts.values())} | {counts['noticed']} | {counts['explained']} | {counts['survived']} | "
                  f"{counts['not reached']} |")
        total += counts
    tried = sum(total.values())
    print(f"\n{tried} mutants: {total['noticed']} noticed ({100 * total['noticed'] / max(1, tried):.1f} %), "
          f"{total['explained']} cannot be seen, {total['survived']} survived, {total['not reached']} not reached")
    for result in sorted(results.values(), key=lambda result: (result["file"], result["line"])):
        if result["result"] in ("survived", "not reached") and result["id"] not in reasons:
            print(f"{result['result']} {result['id']} {result['file']}:{result['line']} {result['operator']}: {result['before']}  =>  "
                  f"{result['after']}")
    if options.csv:
        with options.csv.open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows(sorted(results.values(), key=lambda result: (result["file"], result["line"], result["id"])))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("what", choices=["make", "run", "report"])
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--rooms", default=",".join(ROOMS))
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--release", type=pathlib.Path, default=SOURCE / "build" / "release")
    parser.add_argument("--only")
    parser.add_argument("--scope", choices=SCOPES, default="all")
    parser.add_argument("--csv", type=pathlib.Path)
    options = parser.parse_args()
    options.rooms = options.rooms.split(",")
    options.rooms = [room if room in ROOMS else f"pcl_bsh/{room}" for room in options.rooms]
    for room in options.rooms:
        if room not in ROOMS:
            sys.exit(f"mutate.py: --rooms: there is no {room}: there are {', '.join(ROOMS)}")
    {"make": make, "run": run, "report": report}[options.what](options)


if __name__ == "__main__":
    main()
