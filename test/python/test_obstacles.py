# SPDX-License-Identifier: BSD-3-Clause
"""Several obstacles in one question, against brute force."""

import functools

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud, distances, turned
from stubs import mypy_errors


@pytest.fixture(name="named")
def obstacles_by_name():
    """Three clouds: names, points, poses and clearances."""
    points = {"press": cloud("random", 2, 60), "mill": cloud("lattice", 3, 60), "crane": cloud("float32", 4, 60)}
    poses = {"press": turned(1), "crane": turned(2)}
    return points, poses, {"mill": 0.4}


def by_brute_force(a, points, poses, clearances):
    d = {name: distances(a, xyz, pose_b=poses.get(name, np.eye(4))) for name, xyz in points.items()}
    return d, {name: d[name] <= clearances.get(name, 0.15) for name in points}


def test_are_told_one_by_one_and_together(named):
    points, poses, clearances = named
    a = cloud("random", 1)
    hierarchies = {name: pcl_bsh.SphereHierarchy(xyz) for name, xyz in points.items()}
    found = pcl_bsh.collide_obstacles(pcl_bsh.SphereHierarchy(a), hierarchies, 0.15, poses=poses,
                                      clearances=clearances, between=True, threads=2)
    d, near = by_brute_force(a, points, poses, clearances)
    np.testing.assert_array_equal(found.flags, np.any([n.any(axis=1) for n in near.values()], axis=0))
    assert found.flags.dtype == np.uint8 and not found.flags.flags.writeable
    assert found.colliding == found.flags.sum()
    assert list(found.each) == list(points)
    for name, one in found.each.items():
        assert one.asked and one.name == name and one.colliding == near[name].any(axis=1).sum()
        assert one.verdict == (pcl_bsh.Verdict.COLLIDING if near[name].any() else pcl_bsh.Verdict.FREE)
        assert one.closest.distance == pytest.approx(d[name].min(), rel=1e-9, abs=1e-9)
    least = min(d, key=lambda name: d[name].min())
    assert found.closest.distance == found.each[found.closest_obstacle].closest.distance
    assert found.closest_obstacle == least
    assert [(pair.first, pair.second) for pair in found.between] == [
        ("press", "mill"), ("press", "crane"), ("mill", "crane")]
    for pair in found.between:
        two = distances(points[pair.first], points[pair.second], poses.get(pair.first, np.eye(4)),
                        poses.get(pair.second, np.eye(4)))
        assert pair.closest.distance == pytest.approx(two.min(), rel=1e-9, abs=1e-9)
        assert pair.clearance == (0.4 if "mill" in (pair.first, pair.second) else 0.15)
        assert (pair.verdict == pcl_bsh.Verdict.COLLIDING) == (two.min() <= pair.clearance)


def test_ignore_by_pattern(named):
    points, poses, _ = named
    a = pcl_bsh.SphereHierarchy(cloud("random", 1))
    hierarchies = {name: pcl_bsh.SphereHierarchy(xyz) for name, xyz in points.items()}
    found = pcl_bsh.collide_obstacles(a, hierarchies, 0.15, poses=poses, between=True, ignore=["press:c*", "input:mill"])
    assert [(pair.first, pair.second) for pair in found.between] == [("press", "mill"), ("mill", "crane")]
    assert not found.each["mill"].asked and found.each["press"].asked
    nothing = pcl_bsh.collide_obstacles(a, hierarchies, 0.15, ignore=["input:*"])
    assert not nothing.flags.any() and nothing.closest_obstacle is None


def test_count_with_their_inside():
    corners = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
    faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
                      [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    crate = pcl_bsh.SphereHierarchy.of_triangles(corners, faces)
    a = pcl_bsh.SphereHierarchy(np.array([[0.5, 0.5, 0.25]]))
    found = pcl_bsh.collide_obstacles(a, {"full": crate, "empty": crate}, 0.1, solids={"full": True})
    assert (found.each["full"].colliding, found.each["empty"].colliding) == (1, 0)
    assert (found.each["full"].closest.distance, found.each["empty"].closest.distance) == (-0.25, 0.25)
    assert found.closest_obstacle == "full" and "1 point" in repr(found)


def test_tell_how_much_is_inside():
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    faces = np.array([[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2],
                      [2, 4, 6], [1, 3, 5], [3, 7, 5]], dtype=np.uint32)
    crate = pcl_bsh.SphereHierarchy.of_triangles(corners, faces)
    up = np.eye(4)
    up[:3, 3] = [0.25, 0.25, 0.5]
    scan = pcl_bsh.SphereHierarchy(np.array([[9.0, 9, 9]]))
    ask = functools.partial(pcl_bsh.collide_obstacles, scan, {"low": crate, "high": crate}, poses={"high": up},
                            solids={"low": True}, between=True)
    pair = ask(overlap=True).between[0]
    lower, upper = pair.second_within
    expected = 0.75 * 0.75 + 2 * 0.75 * 0.5
    assert lower <= expected <= upper <= lower * 1.004
    assert pair.first_within is None
    assert ask().between[0].second_within is None


@pytest.mark.parametrize("arguments, message", [
    ({"obstacles": {}}, "obstacles: there are none: give one at least"),
    ({"obstacles": {"input": None}}, "obstacles: 'input' is the input's own name: give another"),
    ({"poses": {"mil": np.eye(4)}}, "poses: 'mil' is no obstacle: give one of their names"),
    ({"poses": {"mill": 2 * np.eye(4)}}, "mill"),
    ({"clearances": {"mill": -1.0}}, "clearance"),
    ({"ignore": ["mill"]}, "ignore: 'mill' is no pair of names: give FIRST:SECOND, where .* is any letters"),
    ({"ignore": "mill:input"}, "ignore: is a text: give a list"),
    ({"ignore": ["mill:x"]}, "ignore: 'x' matches no obstacle: give input, or one of their names"),
    ({"seen": True}, "`?seen`?: is about points of obstacles"),
])
def test_refuse_what_is_none(arguments, message):
    a = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    named = {name: a for name in arguments.get("obstacles", {"mill": None})}
    with pytest.raises(ValueError, match=message):
        pcl_bsh.collide_obstacles(a, named, **{k: v for k, v in arguments.items() if k != "obstacles"})


def test_tell_their_progress_and_stop(named):
    points, _, _ = named
    a = pcl_bsh.SphereHierarchy(cloud("random", 1))
    hierarchies = {name: pcl_bsh.SphereHierarchy(xyz) for name, xyz in points.items()}
    told = []
    pcl_bsh.collide_obstacles(a, hierarchies, 0.15, progress=told.append)
    assert told == sorted(told) and told[-1] <= 1
    with pytest.raises(pcl_bsh.Cancelled):
        pcl_bsh.collide_obstacles(a, hierarchies, 0.15, progress=lambda done: False)


def test_refuse_other_types():
    a = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    with pytest.raises(TypeError, match=r"obstacles\['mill'\]: is no SphereHierarchy"):
        pcl_bsh.collide_obstacles(a, {"mill": np.zeros((1, 3))})
    with pytest.raises(TypeError, match=r"clearances\['mill'\]: is no such value"):
        pcl_bsh.collide_obstacles(a, {"mill": a}, clearances={"mill": "wide"})


def test_have_types(tmp_path):
    assert mypy_errors(tmp_path, (
        "import numpy as np\n"
        "import pcl_bsh\n"
        "a = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))\n"
        "found = pcl_bsh.collide_obstacles(a, {'mill': a}, 0.1, poses={'mill': np.eye(4)}, ignore=['mill:input'])\n"
        "hits: int = found.each['mill'].colliding\n"
        "first: str = found.between[0].first\n"
        "pcl_bsh.collide_obstacles(a, [a])  # error\n"
        "pcl_bsh.collide_obstacles(a, {'mill': a}, clearances={'mill': 'x'})  # error\n")) == [7, 8]
