# SPDX-License-Identifier: BSD-3-Clause
"""Makes the files of results/: programs of a built preset `benchmark`, run one after another."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
SCANS = SOURCE / "build" / "demo"  # bash examples/demo/fetch_scans.sh build/demo
DATA = pathlib.Path(os.environ.get("PCL_BSH_SHARED_DIR", SOURCE / "shared")) / "data"  # real scans, see draw.sh
sys.path.insert(0, str(HERE.parent / "hard_cases"))
import run  # noqa: E402
import run_surfaces  # noqa: E402

MAN = f"{SCANS}/building.ply {SCANS}/man.off"
ROOMS = f"{DATA}/indoor_room_scan1.pcd {DATA}/indoor_room_scan2.pcd"
LION = f"{DATA}/statue_lion_takanawa.pcd {DATA}/statue_lion_takanawa.pcd"

NEAR_MAN, FAR_MAN = "-7,0,-2.6,0,0,0", "-30,10,3,0,0,0.3"
NEAR_ROOM, FAR_ROOM = "1.79387,0.720047,0,0,0,0.6931", "30,10,3,0,0,0.3"
NEAR_LION = "0.05,0,0,0,0,0"

# File of rows: the benchmark programs that make it, and their options.
PROGRAMS = {
    "arm.csv": ["bench_arm --clock cpu"],
    "arm_million.csv": ["bench_arm --clock cpu --every 1 --motions 2858 --repeat 1"],
    "budgets.csv": [f"bench_budget {clouds} --name {name.replace(' ', '_')} --pose={pose} --repeat 400"
                    for name, clouds, pose in (("building near", MAN, NEAR_MAN), ("building far", MAN, FAR_MAN),
                                               ("rooms near", ROOMS, NEAR_ROOM), ("rooms far", ROOMS, FAR_ROOM),
                                               ("lion", LION, NEAR_LION))],
    "cold.csv": ["bench_cold --size 300000 --distances 1,5,20 --racers pcl_bsh,fitted_grid,nanoflann --repeat 5"],
    "contacts.csv": ["bench_contacts --clock cpu"],
    "distances.csv": ["bench_distances --scene terrain,lion --clock cpu --repeat 3"],
    "flags_terrain.csv": ["bench_flags --scene terrain --sizes 1000000 --distances 1,5,20 --orders scan,shuffled --clock cpu --repeat 5"],
    "flags_uneven.csv": ["bench_flags --scene hall,sweep,lidar,lion --sizes 300000 --distances 1,5,20 --orders scan --threads 1 "
                         "--racers pcl_bsh,pcl_bsh_warm,fitted_grid,nanoflann --clock cpu --repeat 3"],
    "gauge.csv": ["bench_gauge --clock cpu --repeat 5"],
    "growth.csv": ["bench_growth --clock cpu --repeat 1 --sizes 1000,8000"],
    "laz.csv": ["bench_laz --clock cpu --threads 1 --repeat 3"],
    "motions.csv": ["bench_rigid --sizes 100000 --poses 12 --racers pcl_bsh --motions 200 --clock cpu"],
    "plan.csv": ["bench_plan --clock cpu"],
    "rigid_100k.csv": ["bench_rigid --sizes 100000 --poses 300"],
    "scene.csv": ["bench_scene --clock cpu --cloud 1000000 --objects 300 --steps 30"],
    "search.csv": ["bench_search --scene terrain,lion --size 300000 --queries 10000 --orders scan --clock cpu --repeat 3"],
    "seen.csv": ["bench_seen --clock cpu --repeat 5"],
    "self_filter.csv": ["bench_self_filter --clock cpu --frames 10"],
    "separation.csv": ["bench_separation --clock cpu --repeat 5"],
    "sites.csv": ["bench_sites {work} --scales 0.53,5.3,53 --repeat 1"],
    "surface.csv": ["bench_surface --clock cpu"],
    "trajectory.csv": ["bench_trajectory --scale 0.1"],
    "tight.csv": ["bench_trajectory --scale 0.02 --scenes tight --racers pcl_bsh --threads 1 --densities 0 --warm-poses 5 --clock cpu"],
    "uncertain_poses.csv": ["bench_uncertainty --scene terrain,lion --query flags,path,path_distances,swept,poses,scene --clearances 5 --clock cpu --repeat 7"],
    "uncertainty.csv": ["bench_uncertainty --scene terrain,lion --query flags,lists,any,path --clock cpu --repeat 2"],
    "volumes.csv": [f"bench_volumes {clouds} --name {name} --clearance {clearance} --pose={pose} --clock cpu"
                    for name, clouds, clearance, pose in (("building", MAN, 0.5, NEAR_MAN), ("rooms", ROOMS, 0.05, NEAR_ROOM),
                                                          ("lion", LION, 0.02, NEAR_LION))],
}

# Subjects of the study of accuracy: clouds, options, number of poses, and the poses about which near and far ones lie;
# none: along the path.
STUDIES = {
    "building": (f"{MAN} --vertices-only --clearance 0.5 --repeat 5", 10, NEAR_MAN, FAR_MAN),
    "rooms": (f"{ROOMS} --clearance 0.05 --repeat 1", 3, NEAR_ROOM, FAR_ROOM),
    "tunnel": ("{work}/tunnel/scan.ply {work}/tunnel/wagon.ply --clearance 0.05 --repeat 1", 5, "", "0,60,10,0,0,0.3"),
}


def stamp(build):
    """Machine, compiler and commit, as the benchmark programs write them."""
    model = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
    cache = (build / "CMakeCache.txt").read_text()
    told = next(build.glob("CMakeFiles/*/CMakeCXXCompiler.cmake")).read_text()
    compiler = [re.search(rf'set\(CMAKE_CXX_COMPILER_{what} "(.*?)"\)', told).group(1) for what in ("ID", "VERSION")]
    compiler.append(re.search(r"CMAKE_BUILD_TYPE:\w+=(.*)", cache).group(1))
    commit = subprocess.run(["git", "-C", str(SOURCE), "describe", "--always", "--dirty", "--abbrev=12"], capture_output=True, text=True)
    return {"machine": f"{model.group(1) if model else 'unknown processor'}, {os.cpu_count()} cores", "compiler": " ".join(compiler),
            "commit": commit.stdout.strip() or "unknown"}


def alone(build):
    """The environment of programs that are measured: OpenMP of one thread is a call (peer/one_thread_openmp.cpp)."""
    return {**os.environ, "LD_PRELOAD": str(build / "test" / "benchmark" / "libone_thread_openmp.so")}


def store(build, name, rows):
    """Writes rows, of which all have the columns of the first; not yet to results/, lest commits be called dirty."""
    (build / "rows").mkdir(exist_ok=True)
    with (build / "rows" / name).open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def of_programs(build, name):
    rows = []
    for command in PROGRAMS[name]:
        program, *arguments = command.format(work=build / "sites_work").split()
        print(f"{name}: {command}", flush=True)
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            subprocess.run([str(build / "test" / "benchmark" / program), *arguments, "--csv", file.name], check=True,
                           env=alone(build))
            rows += csv.DictReader(open(file.name, newline=""))
    return rows


def rivals_of(study):
    """Each of PCL's ways, and what of ours answers it: of the settings certified to at most its error, the fastest."""
    rows = []
    for peer in filter(lambda m: m["peer"], study):
        row = {"query": peer["query"], "PCL": peer["knob"], "setting": peer["setting"], "error measured": f"{peer['actual_error']:.3g}",
               **times_of(peer, ("time [us]", "quartile 1 [us]", "quartile 3 [us]")), "once [us]": microseconds(peer["once"]["median"])}
        ours = [m for m in study if m["query"] == peer["query"] and m["certified"] and m["certified_error"] <= peer["actual_error"]
                and not (m["query"] == "flags" and m["knob"] == "tolerance")]  # which is another question
        best = min(ours, key=lambda m: m["seconds"]["median"], default=None)
        once = min(ours, key=lambda m: m["once"]["median"], default=None)
        row |= {"pcl_bsh": best["setting"] if best else "none", "error at most": f"{best['certified_error']:.3g}" if best else "",
                **times_of(best, ("time of pcl_bsh [us]", "its quartile 1 [us]", "its quartile 3 [us]")),
                "pcl_bsh once": once["setting"] if once else "none",
                "once of pcl_bsh [us]": microseconds(once["once"]["median"]) if once else ""}
        rows.append(row)
    return rows


def microseconds(seconds):
    return f"{1e6 * seconds:.4g}"


def times_of(measured, names):
    return {name: microseconds(measured["seconds"][key]) if measured else "" for name, key in zip(names, ("median", "low", "high"))}


def studies(build):
    """PCL's ways and ours on all clouds; and our settings of the smallest distance at near poses."""
    rivals, dial = [], []
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([build / "bin" / "pcl_bsh_tunnel", f"{work}/tunnel", "--scale", "0.005"], check=True, stdout=subprocess.DEVNULL)
        for clouds, (options, count, near, far) in STUDIES.items():
            for poses, pose in (("near", near), ("far", far)):
                where = [f"--pose={pose}", "--poses", str(count)] if pose else ["--trajectory", f"{work}/tunnel/poses.txt"]
                command = [build / "test" / "benchmark" / "bench_accuracy", *options.format(work=work).split(), *where,
                           "--unit", "m", "--out", f"{work}/study"]
                print(" ".join(map(str, command)), flush=True)
                subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=alone(build))
                front = {**stamp(build), "clock": "cpu", "clouds": clouds, "poses": poses}
                study = json.loads(pathlib.Path(f"{work}/study/accuracy.json").read_text())
                rivals += [{**front, **row} for row in rivals_of(study["measurements"])]
                with open(f"{work}/study/accuracy.csv", newline="") as file:
                    dial += [{**front, **row} for row in csv.DictReader(file)
                             if poses == "near" and row["query"] == "distance" and row["certified"] == "1"]
    store(build, "accuracy.csv", rivals)
    store(build, "accuracy_dial.csv", dial)


def hard_cases(build):
    peers = build / "test" / "benchmark" / "hard_cases_peers"
    programs = [(title, f"{peers} {name}") for title, name in (
        ("pcl_bsh", "pcl_bsh"), ("PCL KdTreeFLANN", "kd_tree"), ("PCL octree", "octree"), ("PCL BruteForce", "brute_force"),
        ("nanoflann float", "nanoflann_float"), ("nanoflann double", "nanoflann_double"))]
    store(build, "hard_cases.csv", [{**stamp(build), **row} for row in run.answers(programs)])


def hard_surfaces(build):
    peers = build / "test" / "benchmark" / "hard_surfaces_peers"
    programs = [(title, f"{peers} {name}") for title, name in (("pcl_bsh", "pcl_bsh"), ("FCL", "fcl"), ("CGAL", "cgal"), ("VTK", "vtk"))]
    store(build, "hard_surfaces.csv", [{**stamp(build), **row} for row in run_surfaces.answers(programs)])


OTHERS = {"accuracy.csv": studies, "hard_cases.csv": hard_cases, "hard_surfaces.csv": hard_surfaces}


def make(build, only):
    """@param only names of files; none: all"""
    unknown = set(only) - {*PROGRAMS, *OTHERS}
    if unknown:
        sys.exit(f"{', '.join(sorted(unknown))}: nothing makes it: give some of {', '.join([*PROGRAMS, *OTHERS])}")
    shutil.rmtree(build / "rows", ignore_errors=True)
    for name in only or [*PROGRAMS, *OTHERS]:
        if name in OTHERS:
            OTHERS[name](build)
        else:
            store(build, name, of_programs(build, name))
    for made in (build / "rows").iterdir():
        shutil.copy(made, HERE / "results")
    return 0
