# SPDX-License-Identifier: BSD-3-Clause
"""Points that move: hierarchies and scenes follow them."""

import sys
import threading
import time

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud, rigid


def answers(a, b):
    """All that a hierarchy says of another, in numbers that do not depend on how it was built."""
    distance, nearest = pcl_bsh.point_distances(a, b)
    pair = pcl_bsh.closest_pair(a, b)
    return (pcl_bsh.collision_flags(a, b, 0.1).tolist(), distance.tolist(), nearest.tolist(), pair.distance, pair.a, pair.b)


@pytest.mark.parametrize("kind", ["random", "float32", "lattice", "one_place", "far", "one"])
def test_a_refit_hierarchy_answers_as_a_new_one(kind):
    other = pcl_bsh.SphereHierarchy(cloud(kind, 9, 400), copy=True)
    before = cloud(kind, 1, 400)
    hierarchy = pcl_bsh.SphereHierarchy(before)
    hierarchy.build_all()
    rng = np.random.default_rng(4)
    for step in (0.001, 0.05, 3.0):
        now = (hierarchy.array + step * rng.random(before.shape)).astype(before.dtype)
        report = hierarchy.refit(now)
        assert set(report) == {"sorted_anew", "voxels_refitted", "voxels_dropped", "volumes_refitted", "looseness"}
        assert hierarchy.array is now and hierarchy.validate() == []
        np.testing.assert_equal(answers(hierarchy, other), answers(pcl_bsh.SphereHierarchy(now, copy=True), other))


def test_points_may_come_and_go_as_nan():
    xyz = cloud("random", 1, 50)
    hierarchy = pcl_bsh.SphereHierarchy(xyz)
    holes = xyz.copy()
    holes[::2] = np.nan
    hierarchy.refit(holes)
    assert len(hierarchy) == 25
    hierarchy.refit(xyz)
    assert len(hierarchy) == 50


def test_arrays_take_turns():
    one, two = cloud("random", 1, 60), cloud("random", 2, 60)
    hierarchy = pcl_bsh.SphereHierarchy(one)
    for now, before in ((two, one), (one, two)):
        hierarchy.refit(now)
        assert not now.flags.writeable and before.flags.writeable
        before += 0.01
    hierarchy.refit(two, copy=True)
    assert one.flags.writeable and two.flags.writeable


def test_subset_radii_and_uncertainties_stay():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    radii = np.array([0.1, 0.2, 0.3], np.float32)
    kept = dict(radii=radii, indices=[0, 2], uncertainty=0.01, uncertainties=radii / 10)
    hierarchy, other = pcl_bsh.SphereHierarchy(xyz, **kept), pcl_bsh.SphereHierarchy(np.array([[1.6, 0, 0.2]]))
    now = xyz + [0, 0, 0.25]
    hierarchy.refit(now)
    np.testing.assert_equal(answers(hierarchy, other), answers(pcl_bsh.SphereHierarchy(now, copy=True, **kept), other))
    hierarchy.refit(xyz, radii=2 * radii)
    kept["radii"] = 2 * radii
    np.testing.assert_equal(answers(hierarchy, other), answers(pcl_bsh.SphereHierarchy(xyz, copy=True, **kept), other))


def test_what_a_pose_adds_is_of_where_points_are_now():
    near, far = np.array([[0.5, 0.0, 0]]), np.array([[4.0, 0.0, 0]])
    kept = dict(uncertainty=0.01, uncertainties=np.array([0.02], np.float32), pose_uncertainty=(0.01, 0.1))
    hierarchy, other = pcl_bsh.SphereHierarchy(near, **kept), pcl_bsh.SphereHierarchy(np.array([[4.0, 0.4, 0]]))
    for now, verdict in ((far, 2), (near, 0), (far, 2)):
        hierarchy.refit(now)
        np.testing.assert_array_equal(pcl_bsh.collision_flags(hierarchy, other, 0.0), [verdict])
        again = pcl_bsh.SphereHierarchy(now, copy=True, **kept)
        np.testing.assert_equal(answers(hierarchy, other), answers(again, other))
    assert not far.flags.writeable and near.flags.writeable
    corners = np.array([[0.5, 0, 0], [0.5, 0, 1], [0.5, 0.1, 0]])
    mesh = pcl_bsh.SphereHierarchy.of_triangles(corners, [[0, 1, 2]], pose_uncertainty=(0, 0.1))
    for shift, verdict in ((3.5, 2), (0, 0)):
        mesh.refit(corners + [shift, 0, 0])
        np.testing.assert_array_equal(pcl_bsh.collision_flags(other, mesh, 0.1), [verdict])


def test_what_does_not_fit_changes_nothing():
    xyz = cloud("random", 1, 60)
    hierarchy, other = pcl_bsh.SphereHierarchy(xyz), pcl_bsh.SphereHierarchy(cloud("random", 2, 60))
    expected = answers(hierarchy, other)
    wrong = {
        "records instead of": dict(xyz=xyz[1:].copy()),
        "another type": dict(xyz=xyz.astype(np.float32)),
        "growth": dict(xyz=xyz.copy(), most_growth=0.5),
        "shape": dict(xyz=np.zeros((60, 2))),
        "have radii": dict(xyz=xyz.copy(), radii=np.zeros(60, np.float32)),
    }
    for words, arguments in wrong.items():
        with pytest.raises(ValueError, match=words if words != "have radii" else "radii"):
            hierarchy.refit(**arguments)
        assert arguments["xyz"].flags.writeable
        np.testing.assert_equal(answers(hierarchy, other), expected)
    assert not xyz.flags.writeable


def test_not_in_the_callback_of_a_query():
    a = pcl_bsh.SphereHierarchy(cloud("random", 1, 3000))
    b = pcl_bsh.SphereHierarchy(cloud("random", 2, 3000))
    now = cloud("random", 3, 3000)
    asked = []

    def progress(fraction):
        if not asked:
            asked.append(pcl_bsh.closest_pair(a, b).distance)  # a query within a query
            with pytest.raises(RuntimeError, match="while a query runs"):
                a.refit(now)

    pcl_bsh.point_distances(a, b, progress=progress)
    assert asked
    a.refit(now)


def test_queries_and_refits_of_many_threads_take_turns():
    places = [cloud("random", seed, 10000) for seed in (1, 2)]
    other = pcl_bsh.SphereHierarchy(cloud("random", 3, 10000))
    expected = [pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(xyz, copy=True), other, 0.02).tolist() for xyz in places]
    hierarchy = pcl_bsh.SphereHierarchy(places[0])
    wrong = []

    def ask():
        for _ in range(20):
            if pcl_bsh.collision_flags(hierarchy, other, 0.02).tolist() not in expected:
                wrong.append(True)

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for thread in threads:
        thread.start()
    refits = 0
    while any(thread.is_alive() for thread in threads):
        refits += 1
        hierarchy.refit(places[refits % 2])
    for thread in threads:
        thread.join()
    assert refits > 5 and not wrong


def ticks_while(change):
    """How often this thread comes to run while another one changes points."""
    done = threading.Event()

    def work():
        change()
        done.set()

    thread = threading.Thread(target=work)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)  # a thread gives the interpreter's lock away only by itself
    try:
        thread.start()
        ticks = 0
        while not done.is_set():
            time.sleep(0.0005)
            ticks += 1
        thread.join()
        return ticks
    finally:
        sys.setswitchinterval(interval)


def test_the_interpreter_goes_on_while_points_change():
    places = [cloud("random", seed, 100000) for seed in (1, 2)]
    hierarchy = pcl_bsh.SphereHierarchy(places[0])
    scene = pcl_bsh.Scene(deform=1.5)
    scene.add("cloth", pcl_bsh.SphereHierarchy(places[0]))
    for change in (lambda k: hierarchy.refit(places[k % 2]), lambda k: scene.deform("cloth", places[k % 2])):
        ticks = 0
        for k in range(1, 20):  # it sleeps twice at most where the lock is held: before, and when the turn is taken
            hierarchy.build_all()
            ticks = max(ticks, ticks_while(lambda: change(k)))
            if ticks > 4:
                break
        assert ticks > 4, "the change held the interpreter's lock"


def test_what_is_told_while_points_change_is_whole():
    places = [cloud("random", seed, 5000) for seed in (1, 2)]
    hierarchy = pcl_bsh.SphereHierarchy(places[0])
    ends = threading.Event()
    wrong = []

    def look():
        while not ends.is_set():
            told = (len(hierarchy), hierarchy.records, hierarchy.in_place, hierarchy.coordinate_spacing, repr(hierarchy))
            if told != (5000, 5000, True, 0.0, "SphereHierarchy(5000 points, float64)"):
                wrong.append(told)
            array = hierarchy.array  # once: the next refit may come before it is compared with the second
            if not any(array is xyz for xyz in places):
                wrong.append(array)

    threads = [threading.Thread(target=look) for _ in range(2)]
    for thread in threads:
        thread.start()
    for k in range(1, 60):
        hierarchy.refit(places[k % 2])
    ends.set()
    for thread in threads:
        thread.join()
    assert not wrong


def test_what_is_given_may_ask_the_hierarchy_that_it_changes():
    hierarchy = pcl_bsh.SphereHierarchy(cloud("random", 1, 50))
    moved = cloud("random", 2, 50)
    asked = []

    class Points:
        def __array__(self, *arguments, **options):
            asked.append((len(hierarchy), pcl_bsh.closest_pair(hierarchy, hierarchy).distance))
            with pytest.raises(RuntimeError, match="while a query runs"):
                hierarchy.refit(moved)
            return moved

    hierarchy.refit(Points())
    assert asked and set(asked) == {(50, 0.0)}
    assert pcl_bsh.closest_pair(hierarchy, pcl_bsh.SphereHierarchy(moved[:1])).distance == 0.0


def test_a_scene_deforms():
    scene = pcl_bsh.Scene(clearance=0.1, any=True, flags=True, deform=1.5)
    here, there = np.array([[0.0, 0, 0], [3, 0, 0]]), np.array([[0.0, 0, 0], [0.95, 0, 0]])
    scene.add("wall", pcl_bsh.SphereHierarchy(np.array([[1.0, 0, 0]])), fixed=True)
    scene.add("cloth", [("left", pcl_bsh.SphereHierarchy(np.array([[0.0, 5, 0]]))), ("right", pcl_bsh.SphereHierarchy(here))])
    assert scene.query().any == []
    report = scene.deform("cloth", there, part=1)
    assert "looseness" in report and here.flags.writeable and not there.flags.writeable
    found = scene.query()
    assert [(pair["part_a"], pair["part_b"]) for pair in found.any] == [(0, 1)]
    assert {part["part"]: part["flags"].tolist() for part in found.flags if part["object"] == 1} == {1: [0, 1]}
    with pytest.raises(ValueError, match="no part 2"):
        scene.deform("cloth", there, part=2)
    with pytest.raises(ValueError, match="records instead of"):
        scene.deform("cloth", np.zeros((3, 3)), part=1)
    still = pcl_bsh.Scene(any=True)
    still.add("stone", pcl_bsh.SphereHierarchy(np.zeros((1, 3))))
    with pytest.raises(ValueError, match="deform is not listed"):
        still.deform(0, np.ones((1, 3)))


@pytest.mark.parametrize("kind", ["random", "float32", "lattice", "holes", "one", "empty"])
def test_hausdorff_distance(kind):
    a, b = (pcl_bsh.SphereHierarchy(cloud(kind, seed, 200)) for seed in (1, 2))
    both = pcl_bsh.symmetric_distances(a, b, pose_b=rigid(1))
    for threads in (1, 0):
        found = pcl_bsh.hausdorff_distance(a, b, pose_b=rigid(1), threads=threads)
        distance, pair = found
        np.testing.assert_equal([distance, pair], [both.hausdorff, both.hausdorff_pair])
        assert (found.distance, found.pair) == (distance, pair) or np.isnan(distance)
    with pytest.raises(pcl_bsh.Cancelled):
        pcl_bsh.hausdorff_distance(pcl_bsh.SphereHierarchy(cloud("random", 1, 3000)),
                                   pcl_bsh.SphereHierarchy(cloud("random", 2, 3000)), progress=lambda share: False)
