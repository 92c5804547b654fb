# SPDX-License-Identifier: BSD-3-Clause
"""The tables of BENCHMARK.md and RESULTS.md: each is a function of the rows of a file of results/ that yields its lines."""
import csv
import re

from make_rows import HERE, run, run_surfaces


class Rows(list):
    """The rows of a file, as dictionaries."""

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
    yield "| order | d | pcl_bsh | asked again | tuned grid | plain grid | nanoflann | PCL KdTreeFLANN | nanoflann / ours | PCL / ours |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for order in ("scan", "shuffled"):
        for d in ("1.00", "5.00", "20.0"):
            of = {racer: rows.one("total [ms]", order=order, d=d, threads="1", racer=racer)
                  for racer in ("pcl_bsh", "grid", "plain_grid", "nanoflann", "pcl_kdtree")}
            again = rows.one("query [ms]", order=order, d=d, threads="1", racer="pcl_bsh_warm")
            ours, *others = of.values()
            yield (f"| {order} | {float(d):.0f} | " + " | ".join(short(value) for value in (ours, again, *others)) +
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


def contacts(rows):
    yield "| what | records | racer | median [ms] | at 99 % of the steps [ms] | longest [ms] | told |"
    yield "|---|---|---|---:|---:|---:|---|"
    for row in rows:
        times = " | ".join(short(float(row[column])) for column in ("median [ms]", "p99 [ms]", "max [ms]"))
        yield f"| {row['what']} | {row['size']} | {row['racer']} | {times} | {row['remark']} |"


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


def tight(rows):
    """Other questions, against the flags."""
    yield "| question | query | of the flags' time | node pairs |"
    yield "|---|---|---|---|"
    for row in rows:
        told = re.fullmatch(r"(.*); node pairs (\d+); ratio: to the flags", row["remark"])
        if told and row["scene"] == "tight":
            yield (f"| {told.group(1)} | {short(float(row['query [ms]']), ' ms')} | {float(row['times ours']):.2f} | "
                   f"{int(told.group(2)):.3g} |")


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


def wagon(rows):
    yield "| the box | at each pose | swept by 1 cm |"
    yield "|---|---|---|"
    of = rows.where(mesh="wagon")
    for title, end in (("12 triangles", ""), ("250,000 points on them", ", as 250000 points")):
        cells = [short(of.one("both [s]", question=question + end), " s") for question in ("at each pose", "swept by 1 cm")]
        yield f"| {title} | " + " | ".join(cells) + " |"


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
        for query, title in (("flags", "flags"), ("path", "path, 20 poses"), ("path_distances", "path, distances, too"), ("swept", "path, swept"), ("poses", "list of 1000 poses"), ("scene", "scene, 20 poses")):
            of = [rows.one("least [ms]", scene=scene, query=query, uncertainty=kind) for kind in ("plain", "one length", "a length per point", "the pose")]
            yield f"| {scene} | {title} | " + " | ".join(short(time, " ms") for time in of) + f" | {of[3] / of[1]:.2f} |"

def uneven(rows):
    """Milliseconds at three clearances, and of ours when asked again."""
    yield "| scene, d = 1 / 5 / 20 | points | pcl_bsh | asked again | fitted grid | nanoflann |"
    yield "|---|---|---|---|---|---|"
    for scene, title in (("hall", "hall: half of the points on one statue"), ("sweep", "made sweep of a spinning lidar"),
                         ("lidar", "lidar sweeps a and b"), ("lion", "lion against its shifted copy")):
        of = rows.where(scene=scene, order="scan")
        cells = [" / ".join(short(of.one(column, d=d, racer=racer)) for d in ("1.00", "5.00", "20.0"))
                 for column, racer in (("total [ms]", "pcl_bsh"), ("query [ms]", "pcl_bsh_warm"), ("total [ms]", "fitted_grid"),
                                       ("total [ms]", "nanoflann"))]
        yield f"| {title} | {int(of[0]['points']):,} | " + " | ".join(cells) + " |"


def cold(rows):
    """Processor milliseconds, median and least, and pages touched for the first time."""
    racers = (("pcl_bsh", "pcl_bsh"), ("fitted_grid", "fitted grid"), ("nanoflann", "nanoflann"))
    yield "| question | d | " + " | ".join(title for _, title in racers) + " | ours / fitted grid | faults, ours / fitted grid |"
    yield "|---|---|" + "---|" * 5
    for question in ("flags", "any"):
        for d in ("1.00", "5.00", "20.0"):
            of = {racer: rows.where(order="scan", question=question, d=d, racer=racer)[0] for racer, _ in racers}
            medians, leasts = ({racer: float(row[column]) for racer, row in of.items()} for column in ("cpu [ms]", "least cpu [ms]"))
            yield (f"| {question} | {float(d):.0f} | " + " | ".join(f"{short(medians[racer])}, {short(leasts[racer])}" for racer, _ in racers) +
                   f" | {medians['pcl_bsh'] / medians['fitted_grid']:.2f}, {leasts['pcl_bsh'] / leasts['fitted_grid']:.2f} | " +
                   " / ".join(f"{float(of[racer]['faults']):,.0f}" for racer in ("pcl_bsh", "fitted_grid")) + " |")


def motions(rows):
    yield "| any collision on motions | a call for each | one call |"
    yield "|---|---|---|"
    for of in rows.where(query="any on motions, a call for each"):
        once = rows.one("median [us]", query="any on motions, one call, 1 threads", **{"class": of["class"]})
        yield f"| {of['class']} | {short(float(of['median [us]']))} | {short(once)} |"


def growth(rows):
    yield "| clouds | flags | closest pair | path of 5 poses, flags | path, distances | distances of all points |"
    yield "|---|---|---|---|---|---|"
    for clouds in dict.fromkeys(row["clouds"] for row in rows.where(query="flags")):
        yield f"| {clouds} | " + " | ".join(grown(rows.where(clouds=clouds))) + " |"


def plates(rows):
    yield "| surfaces | closest pair | distances of all triangles | 10 contacts |"
    yield "|---|---|---|---|"
    for clouds in dict.fromkeys(row["clouds"] for row in rows.where(query="10 contacts")):
        yield f"| {clouds} | " + " | ".join(grown(rows.where(clouds=clouds))) + " |"


def grown(rows):
    """The growth of each query at its last size."""
    return [f"{row['growth of steps']}, {short(float(row['time [ms]']), ' ms')}" for row in rows if row["growth of steps"] != "-"]


def search(rows):
    racers = (("pcl_kdtree", "PCL k-d tree"), ("nanoflann", "nanoflann"), ("pcl_octree", "PCL octree"), ("grid", "grid"),
              ("pcl_bsh_batch", "ours, a batch"))
    yield "| task | " + " | ".join(f"{scene}: {title}" if i == 0 else title for scene in ("terrain", "lion")
                                   for i, (_, title) in enumerate(racers)) + " |"
    yield "|---|" + "---|" * 2 * len(racers)
    for task, title in (("build", "build"), ("radius30", "radius, 30 neighbours"), ("radius300", "radius, 300 neighbours"),
                        ("radius30_1", "nearest within a radius"), ("knn1", "k = 1"), ("knn8", "k = 8"), ("knn30", "k = 30"),
                        ("probes", "is there any point in this ball?")):
        cells = []
        for scene in ("terrain", "lion"):
            for racer, _ in racers:
                found = rows.where(scene=scene, order="scan", task=task, racer=racer)
                is_told = found and (task, racer) != ("build", "pcl_bsh_batch")
                cells.append(f"{float(found[0]['ratio']):.2g}" if is_told else "")
        yield f"| {title} | {' | '.join(cells)} |".replace("|  |", "| |").replace("|  |", "| |")


def uncertainty(rows):
    kinds = ("plain", "one length", "a length per point")
    yield "| cloud | clearance [spacings] | " + " | ".join(
        f"{query}, plain | one length | a length per point" for query in ("flags", "lists", "any", "path")) + " |"
    yield "|---|---|" + "---|" * 12
    for scene in ("terrain", "lion"):
        for clearance in ("1.00", "5.00", "20.0"):
            cells = []
            for query in ("flags", "lists", "any", "path"):
                least, *others = (rows.one("least [ms]", scene=scene, query=query, uncertainty=kind, clearance=clearance) for kind in kinds)
                cells += [short(least, " ms")] + [f"{other / least:.2f}" for other in others]
            yield f"| {scene} | {float(clearance):.0f} | " + " | ".join(cells) + " |"


def self_filter(rows):
    yield "| padding | triangles | load and build, once | frame, median | slowest |"
    yield "|---|---|---|---|---|"
    for row in rows:
        yield (f"| {100 * float(row['padding [m]']):.0f} cm | {int(row['triangles']):,} | {short(float(row['load and build [s]']), ' s')} | "
               f"{short(float(row['frame [ms]']), ' ms')} | {short(float(row['slowest [ms]']), ' ms')} |")


def separation(rows):
    yield "| motion | points | near it | free | last valid, median | frame, median | 99 % | slowest |"
    yield "|---|---|---|---|---|---|---|---|"
    for row in rows:
        yield (f"| {'as planned' if float(row['speed']) == 1 else str(round(float(row['speed']))) + ' times as fast'} | {int(row['points']):,} | {short(float(row['near [median]']))} | "
               f"{short(float(row['free [%]']), ' %')} | {row['last valid [median]']} | {short(float(row['frame [ms]']), ' ms')} | "
               f"{short(float(row['99 % [ms]']), ' ms')} | {short(float(row['slowest [ms]']), ' ms')} |")


def budgets(rows):
    yield "| clouds | budget | calls | within 1.1 of it | an empty loop | median / budget | 99 % of calls / budget | no wider than other settings | interrupted |"
    yield "|---|---|---:|---:|---:|---:|---:|---:|---:|"
    for row in rows:
        yield (f"| {row['clouds'].replace('_', ' ')} | {short(float(row['budget [us]']), ' us')} | {int(row['calls']):,} | {100 * float(row['within 1.1']):.4g} % | {100 * float(row['empty loop within 1.1']):.4g} % | "
               f"{row['median / budget']} | {row['p99 / budget']} | {100 * float(row['no wider than others']):.3g} % | {int(row['interrupted']):,} |")


def laz(rows):
    yield "| points | format | LAZ | the same as LAS | LAZ / LAS |"
    yield "|---|---|---|---|---|"
    for row in rows.where(file="cloud.laz", threads="1"):
        las = rows.where(points=row["points"], format=row["format"], file="cloud.las").one("[s] of 10^7 points")
        seconds = float(row["[s] of 10^7 points"])
        yield f"| {row['points']} | {row['format']} | {short(seconds, ' s')} | {short(las, ' s')} | {ratio(seconds / las)} |"


def gauge(rows):
    yield "| axis | tracks | profiles | reading | all | million points a second |"
    yield "|---|---:|---:|---|---|---:|"
    for row in rows:
        reading, whole = (float(row[f"{what} [us a point]"]) for what in ("reading", "all"))
        yield f"| {row['axis']} | {row['tracks']} | {row['profiles']} | {short(reading, ' us')} | {short(whole, ' us')} | {short(1 / whole)} |"


def plans(rows):
    yield "| problems of | problems | start or goal not free | runs | solved | certified | plan [ms] | cloud to certified path [ms] | 95 % [ms] | longest [ms] | validators |"
    yield "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    for row in rows:
        times = " | ".join(short(float(row[column])) for column in ("plan [ms]", "cloud to certified path [ms]", "95 % [ms]", "longest [ms]"))
        yield (f"| {row['problems of'].replace('_', ' ')} | {row['problems']} | {row['start or goal not free']} | {row['runs']} | {row['solved']} | "
               f"{row['certified']} | {times} | {row['validators [%]']} % |")


def arm(rows):
    yield "| check | mean | median | 95 % | free | undecided | wrong |"
    yield "|---|---:|---:|---:|---:|---:|---:|"
    for row in rows:
        times = " | ".join(short(float(row[column]), " us") for column in ("mean [us]", "median [us]", "95 % [us]"))
        yield f"| {row['check']} | {times} | {row['free']} | {row['undecided']} | {row['wrong']} |"


def scene(rows):
    yield "| what | size | time | that is | counted |"
    yield "|---|---|---|---|---|"
    for row in rows.where(threads="1"):
        yield (f"| {row['what']} | {row['size']} | {short(float(row['median [ms]']), ' ms')} | {row['that is']} | {row['counted']} |").replace("|  |", "| |").replace("|  |", "| |")


def hard_cases(rows):
    return run.table(rows, [name for name in rows[0] if name not in ("machine", "compiler", "commit", "case", "exact")])


def hard_surfaces(rows):
    return run_surfaces.table(rows, [name for name in rows[0] if name not in ("machine", "compiler", "commit", "case", "records")])


def volumes(rows):
    """In the paper's words."""
    yield "| clouds | points | question | volumes | N_v | N_u | leaf pairs | time | build both |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        points = f"{int(row['points']):,} x {int(row['points of b']):,}"
        question = "any collision" if row["question"] == "any" else "all colliding points"
        counts = [short(float(row[column])) for column in ("N_v", "N_u", "leaf pairs")]
        yield (f"| {row['clouds']} | {points} | {question} | {row['volumes']} | " + " | ".join(counts) +
               f" | {short(float(row['time [ms]']), ' ms')} | {short(float(row['build both [ms]']), ' ms')} |")


def microseconds(text):
    return short(float(text)) if text else ""


def accuracy(rows):
    """Each of PCL's ways between the building and the man, and what of ours answers it."""
    yield ("| poses | question | PCL | error measured | time, quartiles [us] | pcl_bsh | error at most | time, quartiles [us] | sooner | "
           "PCL once [us] | pcl_bsh once [us] | sooner once |")
    yield "|---|---|---|---:|---:|---|---:|---:|---|---:|---:|---|"
    of = rows.where(clouds="building")
    for row in [*of.where(poses="near", query="distance"), *of.where(poses="near", query="flags"), *of.where(poses="far", query="distance")]:
        if row["PCL"] == "approximate k-d tree":
            continue
        far = row["query"] == "distance"
        def error(text):
            return text + " m" if far else f"{100 * float(text):.2g} %"
        yield (f"| {row['poses']} | {row['query']} | {row['PCL']} {row['setting']} | {error(row['error measured'])} | "
               f"{microseconds(row['time [us]'])} ({microseconds(row['quartile 1 [us]'])} .. {microseconds(row['quartile 3 [us]'])}) | "
               f"`{row['pcl_bsh']}` | {error(row['error at most'])} | {microseconds(row['time of pcl_bsh [us]'])} "
               f"({microseconds(row['its quartile 1 [us]'])} .. {microseconds(row['its quartile 3 [us]'])}) | {sooner(row)} | "
               f"{microseconds(row['once [us]'])} | {microseconds(row['once of pcl_bsh [us]'])} | {sooner(row, once=True)} |")


def sooner(row, once=False):
    theirs, ours = ("once [us]", "once of pcl_bsh [us]") if once else ("time [us]", "time of pcl_bsh [us]")
    return "pcl_bsh" if row[ours] and float(row[ours]) <= float(row[theirs]) else "**PCL**"


def accuracy_lost(rows):
    """How many of PCL's ways are met on all clouds, and which are not."""
    yield "| clouds | poses | question | PCL's ways | met, all built before | met, asked once | not met: error, PCL / pcl_bsh [us] |"
    yield "|---|---|---|---:|---:|---:|---|"
    for clouds, poses, query in dict.fromkeys((row["clouds"], row["poses"], row["query"]) for row in rows):
        of = rows.where(clouds=clouds, poses=poses, query=query)
        lost = []
        for once in (False, True):
            for row in of:
                if sooner(row, once) == "pcl_bsh":
                    continue
                theirs, ours = ("once [us]", "once of pcl_bsh [us]") if once else ("time [us]", "time of pcl_bsh [us]")
                error = row["error measured"] if query == "distance" else f"{100 * float(row['error measured']):.2g} %"
                lost.append(f"{row['PCL']} {row['setting']}{', once' if once else ''}: {error}, {microseconds(row[theirs])} / {microseconds(row[ours])}")
        met = [sum(sooner(row, once) == "pcl_bsh" for row in of) for once in (False, True)]
        yield f"| {clouds} | {poses} | {query} | {len(of)} | {met[0]} | {met[1]} | {'; '.join(lost)} |".replace("|  |", "| |")


def dial(rows):
    """Our settings of the smallest distance, but those that a peer's error asked for."""
    yield "| clouds | setting | time, quartiles [us] | asked once [us] | interval at most [m] | off exact at most [m] | sphere tests |"
    yield "|---|---|---:|---:|---:|---:|---:|"
    shown = set()
    for row in rows:
        setting = (row["clouds"], row["setting"])
        if row["clouds"] == "rooms" or setting in shown or re.match(r"tolerance=(?![0.]*[13](e-\d+)?$)", row["setting"]):
            continue
        shown.add(setting)
        time, low, high, once = (short(1e6 * float(row[column])) for column in ("time_median_s", "time_quartile_1_s", "time_quartile_3_s", "once_median_s"))
        yield (f"| {row['clouds']} | `{row['setting']}` | {time} ({low} .. {high}) | {once} | {float(row['certified_error']):.3g} | "
               f"{float(row['actual_error']):.3g} | {int(row['node_pairs']) // int(row['poses']):,} |")


TABLES = [flags, uneven, cold, rigid, motions, contacts, growth, plates, hard_cases, hard_surfaces, volumes, search, distances, uncertainty, uncertain_poses, seen, self_filter, separation, arm, plans,
          surfaces, bodies, wagon, paths, tight, scene, accuracy, accuracy_lost, dial, budgets, laz, gauge, sites]
TABLES = {table.__name__: table for table in TABLES}
