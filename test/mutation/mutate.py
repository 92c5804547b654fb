#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the tests by what they notice of small changes of the sources.

    mutate.py make WORK [--rooms flags,pairs] [--files REGEX] [--count 40] [--seed 1] [--favour OPERATOR] [--unseen FILE]
                        [--again FILE] [--release build/release] [--jobs 2]
    mutate.py run WORK [--rooms flags,pairs] [--only ID] [--seconds 10]
    mutate.py report WORK [--csv FILE]

WORK is a folder for a copy of the sources, its build and the results. `make` chooses mutants (COUNT of each room,
spread over its --files, none of them in the stored report --unseen, in half of the files those of the operator --favour
first; beside them those of the report --again that are still there), writes all of them into the copy behind a switch,
and builds copy and tests once. `run` runs the tests of each room once to see which mutants each reaches, then, for each
mutant, the tests that reach it until one fails: a second of quick ones of its own room, then those of all its rooms,
quick ones first, for so many --seconds. Survivors are tried again with more. Stopped, it goes on where it was. Tests of
the core are taken from the release build as they are. Reasons why survivors cannot be seen are rows of survivors.csv
beside this file.
"""
import argparse
import collections
import csv
import datetime
import functools
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
    "pcl_bsh/simd": ["pairs", "headers", "flags", "distances", "neighbors", "hierarchy", "trajectory", "geometry", "query", "symmetries"],
    "pcl_bsh/geometry": ["geometry", "headers", "pairs", "hierarchy", "flags", "distances", "query", "symmetries"],
    "pcl_bsh/hierarchy": ["hierarchy", "headers", "pairs", "flags", "distances", "neighbors", "query", "symmetries"],
    "pcl_bsh/query": ["flags", "headers", "pairs", "distances", "question", "trajectory", "query", "symmetries"],
    "pcl_bsh/traversal": ["pairs", "headers", "flags", "distances", "clusters", "trajectory", "query", "symmetries"],
    "pcl_bsh/pairs": ["pairs", "query", "many_poses", "scene", "symmetries"],
    "pcl_bsh/flags": ["flags", "query", "question", "symmetries"],
    "pcl_bsh/distances": ["distances", "query", "clashes", "question", "symmetries"],
    "pcl_bsh/neighbors": ["neighbors", "query", "question", "symmetries"],
    "pcl_bsh/clusters": ["clusters", "query", "clashes", "symmetries"],
    "pcl_bsh/seen": ["seen", "headers", "question"],
    "pcl_bsh/solid": ["solid", "headers", "question", "query"],
    "pcl_bsh/trajectory": ["trajectory", "query", "question", "symmetries"],
    "pcl_bsh/many_poses": ["many_poses", "query", "symmetries"],
    "pcl_bsh/scene": ["scene", "query"],
    "pcl_bsh/clashes": ["clashes", "headers"],
    "pcl_bsh/question": ["question", "headers", "query", "symmetries"],
    "pcl_bsh/io/files": ["files", "clouds", "site"],
    "pcl_bsh/io/text": ["text", "poses", "json", "clouds"],
    "pcl_bsh/io/poses": ["poses", "pipeline"],
    "pcl_bsh/io/json": ["json", "scenes", "reports", "pipeline"],
    "pcl_bsh/io/clouds": ["clouds", "site", "pipeline"],
    "pcl_bsh/io/scenes": ["scenes"],
    "pcl_bsh/io/reports": ["reports", "pipeline"],
    "pcl_bsh/site": ["site"],
    "pcl_bsh/search": ["search", "templates"],
    "pcl_bsh/vtk": ["vtk"],
    "pcl_bsh/vtk_filters": ["vtk"],
    "filters": ["filters", "templates", "pipeline", "memory_pcl"],
}
ROOMS["filters/pipeline"] = ["pipeline"]

# Tests that take more than some seconds: the last that are run.
SLOW = ["*HundredThousandPoints", "*OneHash*", "*Sequences.*", "*SceneCombinations*", "*NothingCollidesBeforeItsFirst*",
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

def choose(names, count, rng, favour, again, seen):
    """Mutants of a room: those to be tried again, and so many that were not seen, a file after the other, of each one of
    an operator not yet taken there as long as there are."""
    left, chosen, sites = {}, [], set()
    for name in names:
        found = [mutant for mutant in mutants.mutants_of(name, (SOURCE / name).read_text())
                 if mutant.id in again or mutant.id not in seen]
        for mutant in found:
            if mutant.id in again:
                chosen.append(mutant)
                sites.add((name, mutant.site))
        rng.shuffle(found)
        favoured = favour and rng.random() < 0.5
        rank, ordered = collections.Counter(), []
        for mutant in found:
            rank[mutant.operator] += 1
            ordered.append((0 if favoured and mutant.operator == favour else rank[mutant.operator], mutant))
        left[name] = [mutant for _, mutant in sorted(ordered, key=lambda pair: pair[0])]
    # A file with many mutants has more turns than one with few.
    turns = [name for name in names for _ in range((len(left[name]) + 19) // 20)]
    rng.shuffle(turns)
    count += len(chosen)
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


def not_compiled(work):
    kept = work / "not_compiled.json"
    return set(json.loads(kept.read_text())) if kept.exists() else set()


def compile_all(work, chosen, targets, jobs):
    """Builds, and leaves out what does not compile, now or before. Returns the numbers left out."""
    known = not_compiled(work)
    left_out = {number for number, mutant in chosen.items() if mutant.id in known}
    while True:
        write_copy(work, {n: m for n, m in chosen.items() if n not in left_out})
        built = subprocess.run(["nice", "-n", "10", "cmake", "--build", str(work / "build"), "--target", *targets, "--", f"-j{jobs}"],
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
        (work / "not_compiled.json").write_text(json.dumps(sorted(known)))
        print(f"{len(new)} mutants do not compile", flush=True)


def make(options):
    work = options.work.resolve()
    names = sources()
    again, seen = ({row["id"] for row in csv.DictReader(file.read_text().splitlines())} if file else set()
                   for file in (options.again, options.unseen))
    chosen, number = {}, 0
    for room in options.rooms:
        rng = random.Random(f"{options.seed} {room}")
        ours = [name for name in names if name.endswith((".cpp", ".h", ".hpp")) and room_of(name) == room
                and options.files.search(name)]
        for mutant in choose(ours, options.count, rng, options.favour, again, seen):
            number += 1
            chosen[number] = mutant
    known = not_compiled(work)
    write_copy(work, {n: mutant for n, mutant in chosen.items() if mutant.id not in known})
    subprocess.run(["cmake", "--preset", "mutation", "-D", f"PCL_BSH_TEST_OBJECTS={options.release.resolve()}", "-D",
                    f"PCL_BSH_SHARED_DIR={SOURCE.parent / 'shared'}"], cwd=work / "source", check=True, stdout=subprocess.DEVNULL)
    tests = list(dict.fromkeys(f"{test}_test" for room in options.rooms for test in ROOMS[room]))
    left_out = compile_all(work, chosen, tests, options.jobs)
    rows = [dict(mutant._asdict(), number=number, room=room_of(mutant.file), compiled=number not in left_out, site=None)
            for number, mutant in chosen.items()]
    (work / "mutants.json").write_text(json.dumps(rows, indent=1))
    for old in ("reached", "results.jsonl"):
        shutil.rmtree(work / old, ignore_errors=True)
        (work / old).unlink(missing_ok=True)
    print(f"{len(rows) - len(left_out)} mutants are compiled, {len(left_out)} cannot be")


# Running --------------------------------------------------------------------------------------------------------------

MOST_SECONDS_TO_REACH = int(os.environ.get("PCL_BSH_MOST_SECONDS_TO_REACH", 3600)) # of all quick, or slow, tests of a room
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
    """The lines that each quick or slow test of a room reaches, by a run without mutants."""
    kept = work / "reached" / (test + (".slow" if slow else ""))
    if not kept.exists():
        kept.parent.mkdir(exist_ok=True)
        unfinished = kept.with_suffix(f"{kept.suffix}.{os.getpid()}")
        unfinished.unlink(missing_ok=True)
        ran = run_binary(work, test, {"PCL_BSH_MUTANT": "-1", "PCL_BSH_REACHED": str(unfinished)},
                         ["--gtest_filter=" + ("" if slow else "-") + ":".join(SLOW)], MOST_SECONDS_TO_REACH)
        if ran is None or ran.returncode < 0 and ran.returncode not in (-24, -9): # the tests after that are left out
            sys.exit(f"mutate.py: {test}_test does not run without a mutant")
        unfinished.touch() # no test wrote it
        unfinished.rename(kept)
    found = []
    for line in kept.read_text().splitlines():
        name, milliseconds, result, *reached = line.split()
        if result == "passed":
            found.append(Test(name, int(milliseconds), set(map(int, reached))))
        else:
            print(f"{name} fails without a mutant, and is left out", file=sys.stderr)
    return found


def batches(own, others, slow):
    """Divides tests by room: the room, its tests and how long they take. A second of its own room's, then steps of
    all rooms' that take longer and longer, then the slow ones."""
    order = lambda pair: pair[0].milliseconds

    def processes(step): # each runs some seconds of tests at most
        for room in dict.fromkeys(room for _, room in step):
            few, time = [], 0
            for test in (test for test, its in step if its == room):
                if few and time + test.milliseconds > 5000:
                    yield room, few, time
                    few, time = [], 0
                few.append(test)
                time += test.milliseconds
            if few:
                yield room, few, time

    begun, total, own = [], 0, sorted(own, key=order)
    while own and (not begun or total + own[0][0].milliseconds <= 1000):
        total += own[0][0].milliseconds
        begun.append(own.pop(0))
    yield from processes(begun)
    rest = sorted(own + others(), key=order)
    for most in (10, 100, 1000, 10000, 3600000):
        yield from processes([pair for pair in rest if pair[0].milliseconds <= most])
        rest = [pair for pair in rest if pair[0].milliseconds > most]
    yield from processes(sorted(slow(), key=order))


def trial(work, mutant, seconds):
    """@param seconds of tests, as long as these take without a mutant"""
    number, rooms = mutant["number"], ROOMS[mutant["room"]]
    own = [(test, rooms[0]) for test in tests_of(work, rooms[0], False) if number in test.reached]
    def reaching(rooms, slow):
        return [(test, room) for room in rooms for test in tests_of(work, room, slow) if number in test.reached]
    spent, tried = 0, 0
    for room, tests, milliseconds in batches(own, lambda: reaching(rooms[1:], False), lambda: reaching(rooms, True)):
        if tried and spent + milliseconds > 1000 * seconds:
            break
        spent += milliseconds
        tried += len(tests)
        flags = work / f"flags.{os.getpid()}.txt"
        flags.write_text(f"--gtest_filter={':'.join(test.name for test in tests)}\n--gtest_fail_fast\n")
        ran = run_binary(work, room, {"PCL_BSH_MUTANT": str(number)}, [f"--gtest_flagfile={flags}"], 3 + 5 * milliseconds // 1000)
        if ran is None or ran.returncode in (-24, -9):
            return "timed out", f"{room}: {tests[0].name} or another"
        if ran.returncode != 0:
            failed = re.search(r"^\[  FAILED  \] ([^\s,]+)", ran.stdout, re.MULTILINE)
            return "killed", failed.group(1) if failed else f"{room}_test ended with {ran.returncode}"
        if spent >= 1000 * seconds - 200: # so that the next rooms need not be run first
            break
    return ("survived", f"{tried} tests of {', '.join(rooms)}") if tried else ("not reached", "")


def run(options):
    work = options.work.resolve()
    chosen = [m for m in json.loads((work / "mutants.json").read_text()) if m["compiled"] and m["room"] in options.rooms]
    file = work / "results.jsonl"
    tried = set()
    for result in map(json.loads, file.read_text().splitlines() if file.exists() else []):
        noticed = result["result"] in ("killed", "timed out")
        if noticed or result["seconds"] >= options.seconds:
            tried.add(result["id"])
    chosen = [m for m in chosen if (m["id"] == options.only if options.only else m["id"] not in tried)]
    turn = collections.Counter()
    def place(mutant): # one of each room after another
        turn[mutant["room"]] += 1
        return turn[mutant["room"]]
    with file.open("a") as out:
        for mutant in sorted(chosen, key=place):
            result, test = trial(work, mutant, options.seconds)
            mutant = dict(mutant, seconds=options.seconds, result=result, test=test, date=datetime.date.today().isoformat())
            out.write(json.dumps(mutant) + "\n")
            out.flush()
            print(f"{result} {mutant['id']} {mutant['file']}:{mutant['line']} {mutant['operator']}: {mutant['before']}  =>  "
                  f"{mutant['after']}  [{test}]", flush=True)


# Reporting ------------------------------------------------------------------------------------------------------------

COLUMNS = ["id", "file", "line", "operator", "result", "seconds", "test", "date", "before", "after"]


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
    parser.add_argument("--files", type=re.compile, default="")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--favour")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--release", type=pathlib.Path, default=SOURCE / "build" / "release")
    parser.add_argument("--only")
    parser.add_argument("--seconds", type=float, default=3600)
    parser.add_argument("--again", type=pathlib.Path)
    parser.add_argument("--unseen", type=pathlib.Path)
    parser.add_argument("--csv", type=pathlib.Path)
    options = parser.parse_args()
    options.rooms = [room if room in ROOMS else f"pcl_bsh/{room}" for room in options.rooms.split(",")]
    for room in options.rooms:
        if room not in ROOMS:
            sys.exit(f"mutate.py: --rooms: there is no {room}: there are {', '.join(ROOMS)}")
    {"make": make, "run": run, "report": report}[options.what](options)


if __name__ == "__main__":
    main()
