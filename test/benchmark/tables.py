#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The figures of README.md and BENCHMARK.md are rows of results/*.csv, and these are made by the programs here.

    tables.py check             # compares the documents with the rows
    tables.py write             # writes the tables anew from the rows
    tables.py rows BUILD [CSV]  # runs the programs of a built preset `benchmark`: all, or those that make CSV

A table names what makes it by the line before it: `<!-- rows: flags, of flags_terrain.csv -->`, where `flags` is a function
below. A table of times without such a line must be one of WITHOUT_ROWS.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]

# File of rows: the program that makes it, and its options.
PROGRAMS = {
    "cold.csv": "bench_cold --distances 1,5,20 --repeat 21",
    "distances.csv": "bench_distances --scene terrain,lion --clock cpu --repeat 3",
    "flags_terrain.csv": "bench_flags --scene terrain --sizes 1000000 --distances 1,5,20 --orders scan,shuffled --clock cpu --repeat 5",
    "flags_uneven.csv": "bench_flags --scene hall,sweep,lidar,lion --sizes 1000000 --distances 1,5,20 --clock cpu --repeat 5",
    "growth.csv": "bench_growth --clock cpu --repeat 1 --sizes 2000,16000",
    "laz.csv": "bench_laz --repeat 5",
    "many_poses.csv": "bench_rigid --sizes 100000 --poses 60 --racers pcl_bsh --many-poses 200000 --motions 20000",
    "rigid_100k.csv": "bench_rigid --sizes 100000 --poses 300",
    "scene.csv": "bench_scene --clock cpu",
    "search.csv": "bench_search --scene terrain,autzen --clock cpu --repeat 5",
    "seen.csv": "bench_seen --clock cpu --repeat 5",
    "self_filter.csv": "bench_self_filter --clock cpu --frames 10",
    "sites.csv": "bench_sites {work} --scales 0.53,5.3,53 --repeat 1",
    "surface.csv": "bench_surface --clock cpu",
    "trajectory.csv": "bench_trajectory --scale 0.1",
    "trajectory_full.csv": "bench_trajectory --scale 1 --scenes tunnel,tight --racers pcl_bsh",
    "uncertain_poses.csv": "bench_uncertainty --scene terrain,lion --query flags,path,swept,poses,scene --clearances 5 --clock cpu --repeat 7",
    "uncertainty.csv": "bench_uncertainty --scene terrain,lion --query flags,lists,any,path --clock cpu",
}

# Tables of BENCHMARK.md whose rows are not stored, by their section. No table may be added here.
WITHOUT_ROWS = {
    "Flags: every point of A that has a point of B within d": 1,  # flags_uneven.csv
    "Once, in a process of its own": 1,  # cold.csv
    "Two bodies, many poses": 1,  # many_poses.csv
    "Where nearly all pairs are alike": 1,  # growth.csv
    "Neighbours of single points": 1,  # search.csv
    "Uncertain places, and the density guard": 2,  # uncertainty.csv
    "A robot cut out of its scans": 1,  # self_filter.csv
    "Along a path": 2,  # trajectory.csv at both scales; a table of instructions
    "Scenes": 1,  # scene.csv
    "What accuracy costs": 2,  # pcl_bsh_accuracy
    "Files": 2,  # laz.csv; no program yet
    "Sites": 2,  # no program yet
    "Cells: halved along the longest axis, or the paper's octants": 1,  # no program yet
    "What was tried and dropped": 1,  # of builds that are gone
}


class Rows(list):
    """Of a file, as dictionaries."""

    def where(self, **values):
        """@param values of columns; a column's unit, and what is no word in it, is left out of its name"""
        def name(column):
            return re.sub(r"\W+", "_", re.sub(r" \[.*\]", "", column)).strip("_")
        return Rows(row for row in self if all(any(name(c) == key and row[c] == value for c in row) for key, value in values.items()))

    def one(self, column, **values):
        """The number in the first row that has these values."""
        found = self.where(**values)
        if not found:
            raise ValueError(f"there is no row with {values}")
        return float(found[0][column])


def rows_of(name):
    with (HERE / "results" / name).open(newline="") as file:
        return Rows(csv.DictReader(file))


def short(number, unit=""):
    """Three digits; from a thousand on a whole number, with commas."""
    return (f"{number:.3g}" if number < 1000 else f"{number:,.0f}") + unit


def ratio(number):
    return f"{number:.2g}" if number < 100 else f"{number:.0f}"


# Tables ---------------------------------------------------------------------------------------------------------------

def flags(rows):
    yield "| order | d | pcl_bsh | tuned grid | plain grid | nanoflann | PCL KdTreeFLANN | nanoflann / ours | PCL / ours |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for order in ("scan", "shuffled"):
        for d in ("1.00", "5.00", "20.0"):
            of = {racer: rows.one("total [ms]", order=order, d=d, threads="1", racer=racer)
                  for racer in ("pcl_bsh", "grid", "plain_grid", "nanoflann", "pcl_kdtree")}
            yield (f"| {order} | {float(d):.0f} | " + " | ".join(short(value) for value in of.values()) +
                   f" | {ratio(of['nanoflann'] / of['pcl_bsh'])} | {ratio(of['pcl_kdtree'] / of['pcl_bsh'])} |")


def rigid(rows):
    yield "| | any, hit | any, near miss (1.3 to 4 spacings) | any, far | distance at the near misses | build both [ms] |"
    yield "|---|---|---|---|---|---|"
    for title, racer in (("pcl_bsh", "pcl_bsh"), ("FCL BVHModel OBBRSS, traversal by hand", "fcl"),
                         ("tuned grid, point by point", "grid"), ("nanoflann, point by point", "nanoflann"),
                         ("PCL KdTreeFLANN, point by point", "pcl_kdtree")):
        of = rows.where(racer=racer)
        cells = [short(of.one("median [us]", query="any", **{"class": kind})) for kind in ("hit", "near miss", "far")]
        distance = of.where(query="distance")
        cells += [short(distance.one("median [us]")) if distance else "", short(of.one("build both [ms]"))]
        yield f"| {title} | {' | '.join(cells)} |".replace("|  |", "| |")


def distances(rows):
    yield ("| scene | greatest distance | pcl_bsh | query alone | both directions | nanoflann | PCL k-d tree | nanoflann / ours | "
           "PCL / ours | both / one |")
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for scene, title in (("terrain", "terrain, 1,000,000 against 1,000,000"), ("lion", "lion, 341,989 against its shifted copy")):
        for limit, said in (("none", "none"), ("5.00", "5 spacings")):
            of = {racer: rows.one("least [ms]", scene=scene, limit=limit, racer=racer)
                  for racer in ("pcl_bsh", "pcl_bsh_query", "pcl_bsh_both", "nanoflann", "pcl_kdtree")}
            ours = of["pcl_bsh"]
            yield (f"| {title if limit == 'none' else 'the same'} | {said} | " + " | ".join(short(value) for value in of.values()) +
                   f" | {ratio(of['nanoflann'] / ours)} | {ratio(of['pcl_kdtree'] / ours)} | {ratio(of['pcl_bsh_both'] / ours)} |")


def paths(rows):
    yield "| scene | scan / model / poses | pcl_bsh, one thread | two threads | boxes (cells, the model's box, nanoflann over the model) |"
    yield "|---|---|---|---|---|"
    for scene, title in (("tunnel", "tunnel, scale 0.1"), ("crane", "crane, scale 0.1")):
        of = rows.where(scene=scene)
        first = of[0]
        one, two, boxes = (of.one("total [ms]", threads=threads, racer=racer) / 1000
                           for threads, racer in (("1", "pcl_bsh"), ("2", "pcl_bsh"), ("1", "boxes")))
        yield (f"| {title} | {float(first['scan']) / 1e6:.4g} M / {float(first['model']) / 1e3:.0f} k / {int(first['poses']):,} | "
               f"{one:.2g} s | {two:.2g} s | {boxes:.3g} s |")


def sites(rows):
    yield "| points | `make`, user + system | wall | peak of memory | path, user + system | wall | peak of memory |"
    yield "|---|---|---|---|---|---|---|"
    for points, title in (("10027600", "1.0e7, 3 tiles"), ("100276000", "1.0e8, 28 tiles"), ("1002760000", "1.0e9, 12 GB")):
        cells = []
        for question in ("make", "path"):
            of = rows.where(points=points, question=question, ranks="1")
            cells += [short(of.one("user + system [s]"), " s"), short(of.one("wall [s]"), " s"),
                      short(of.one("peak of a process [MB]"), " MB")]
        yield f"| {title} | " + " | ".join(cells) + " |"


def surfaces(rows):
    peers = ("Embree", "FCL OBBRSS", "VTK static locator", "CGAL AABB")
    insides = {"Embree": "Embree, parity", "VTK static locator": "VTK enclosed points", "CGAL AABB": "CGAL side of mesh"}
    yield "| question | mesh | pcl_bsh, build + query | query again | Embree | FCL | VTK | CGAL | best of them / ours |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for question, title in (("within 1/400 of its size", "flags, 1/400"), ("within 1/40.0 of its size", "flags, 1/40"),
                            ("distances", "distances"), ("inside", "inside")):
        for mesh in ("box", "part", "bumpy", "tubes"):
            of = rows.where(question=question, mesh=mesh)
            if not of:
                continue
            ours = of.one("both [s]", racer="pcl_bsh")
            cells, best = [], None
            for peer in peers:
                found = of.where(racer=insides.get(peer, peer) if question == "inside" else peer)
                if not found:
                    cells.append("")
                    continue
                time, wrong = float(found[0]["both [s]"]), int(found[0]["wrong"])
                best = time if best is None else min(best, time)
                cells.append(short(time, " s") + (f", {wrong} wrong" if wrong else ""))
            yield (f"| {title} | {mesh} | {short(ours, ' s')} | {short(of.one('again [s]', racer='pcl_bsh'), ' s')} | " +
                   " | ".join(cells) + f" | {ratio(best / ours)} |").replace("|  |", "| |").replace("|  |", "| |")


def bodies(rows):
    yield "| question | mesh | triangles | pcl_bsh, build + query | query again | bytes a triangle | FCL, build + query | FCL again |"
    yield "|---|---|---|---|---|---|---|---|"
    for row in rows:
        if row["racer"] != "pcl_bsh" or not row["question"].startswith(("two bodies", "itself", "a corner")):
            continue
        fcl = rows.where(question=row["question"], mesh=row["mesh"], racer="FCL OBBRSS")
        others = [short(float(fcl[0]["both [s]"]), " s"), short(float(fcl[0]["query [s]"]), " s")] if fcl else ["", ""]
        question = re.sub(r"moved by ([\d.]+)", lambda number: f"moved by {float(number.group(1)):g}", row["question"]).replace(" clearances", " d")
        yield (f"| {question} | {row['mesh']} | {int(row['triangles']):,} | {short(float(row['both [s]']), ' s')} | "
               f"{short(float(row['again [s]']), ' s')} | {row['bytes / triangle']} | " + " | ".join(others) + " |").replace("|  |", "| |").replace("|  |", "| |")


def seen(rows):
    yield "| scans | ranges | | making | asking | memory | truly visible | of these seen | seen in all | wrongly |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        visible, recognised = int(row["visible"]), int(row["recognised"])
        ranges = "exact" if float(row["noise [mm]"]) == 0 else f"off by up to {3 * float(row['noise [mm]']):.0f} mm"
        yield (f"| {row['room']} | {ranges} | {row['method']} | {short(float(row['make [s]']), ' s')} | {short(float(row['ask [s]']), ' s')} | "
               f"{short(float(row['memory [MB]']), ' MB')} | {visible:,} | {recognised:,} ({100 * recognised / visible:.1f} %) | "
               f"{int(row['called seen']):,} | {int(row['wrongly']):,} |")


def uncertain_poses(rows):
    yield "| scan | question | plain | one length | a length per point | the pose | the pose / one length |"
    yield "|---|---|---|---|---|---|---|"
    for scene in ("terrain", "lion"):
        for query, title in (("flags", "flags"), ("path", "path, 20 poses"), ("swept", "path, swept"), ("poses", "list of 1000 poses"), ("scene", "scene, 20 poses")):
            of = [rows.one("least [ms]", scene=scene, query=query, uncertainty=kind) for kind in ("plain", "one length", "a length per point", "the pose")]
            yield f"| {scene} | {title} | " + " | ".join(short(time, " ms") for time in of) + f" | {of[3] / of[1]:.2f} |"


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


TABLES = {"flags": flags, "rigid": rigid, "distances": distances, "paths": paths, "sites": sites, "surfaces": surfaces, "bodies": bodies, "seen": seen, "uncertain_poses": uncertain_poses}

# Documents ------------------------------------------------------------------------------------------------------------

TIMES = re.compile(r"\d (?:ms|us|s|M|MB)\b|\[ms\]|peer time|MB/s|milliseconds|microseconds")
MARK = re.compile(r"<!-- rows: (\w+), of ([\w.]+) -->")


def written(lines):
    """The lines of BENCHMARK.md, with the tables that their marks name."""
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
    lines = (SOURCE / "BENCHMARK.md").read_text().splitlines()
    for number, (is_there, made) in enumerate(zip(lines, written(lines)), 1):
        if is_there != made:
            wrong.append(f"BENCHMARK.md:{number}: {is_there}\n  instead of what the rows say: {made}")
            break
    for section, count in unmarked(lines).items():
        if count > WITHOUT_ROWS.get(section, 0):
            wrong.append(f"BENCHMARK.md: {section}: {count} tables with times name no rows: give each a line <!-- rows: ... -->")
    there = (SOURCE / "README.md").read_text().splitlines()
    wrong += [f"README.md: there is no line of what the rows say: {line}" for line in readme() if line not in there]
    if wrong:
        print("\n".join(wrong))
    return 1 if wrong else 0


def write():
    file = SOURCE / "BENCHMARK.md"
    file.write_text("\n".join(written(file.read_text().splitlines())) + "\n")
    file = SOURCE / "README.md"
    lines = file.read_text().splitlines()
    for made in readme():
        beginning = made.split(" | ")[0]
        lines = [made if line.startswith(beginning + " |") else line for line in lines]
    file.write_text("\n".join(lines) + "\n")
    return 0


def make_rows(build, only):
    for name, command in PROGRAMS.items():
        if only and name not in only:
            continue
        program, *arguments = command.format(work=build / "sites_work").split()
        print(f"{name}: {command}", flush=True)
        run = subprocess.run([str(build / "test" / "benchmark" / program), *arguments, "--csv", str(HERE / "results" / name)])
        if run.returncode != 0:
            return run.returncode
    return 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("what", choices=["check", "write", "rows"])
    parser.add_argument("build", type=pathlib.Path, nargs="?", default=SOURCE / "build" / "release")
    parser.add_argument("csv", nargs="*")
    options = parser.parse_args()
    if options.what == "rows":
        return make_rows(options.build.resolve(), options.csv)
    return check() if options.what == "check" else write()


if __name__ == "__main__":
    sys.exit(main())
