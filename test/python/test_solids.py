# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that count with what they enclose, against formulas of a box."""

import warnings

import numpy as np
import pytest

import pcl_bsh
from clouds import turned

CORNERS = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
FACES = np.array([[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
                  [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]])


def box(scale=1.0):
    return pcl_bsh.SphereHierarchy.of_triangles(CORNERS * scale, FACES)


def signed(points, pose):
    """Distances from the box at a pose; negative inside."""
    q = np.abs((points - pose[:3, 3]) @ pose[:3, :3]) - 1.0
    return np.where((q <= 0).all(axis=1), q.max(axis=1), np.linalg.norm(np.maximum(q, 0), axis=1))


@pytest.fixture
def points():
    return np.random.default_rng(3).uniform(-2, 2, (500, 3))


@pytest.mark.parametrize("pose", [np.eye(4), turned(1), turned(2)])
def test_points_in_a_box(points, pose):
    scan, tank = pcl_bsh.SphereHierarchy(points), box()
    d = signed(points, pose)
    flags = pcl_bsh.collision_flags(scan, tank, 0.1, pose_b=pose, solid=True)
    np.testing.assert_array_equal(flags, d <= 0.1)
    np.testing.assert_array_equal(pcl_bsh.colliding_indices(scan, tank, 0.1, pose_b=pose, solid=True),
                                  np.flatnonzero(d <= 0.1))
    np.testing.assert_allclose(pcl_bsh.point_distances(scan, tank, pose_b=pose, solid=True).distance, d, atol=1e-12)
    closest = pcl_bsh.closest_pair(scan, tank, pose_b=pose, solid=True)
    assert closest.distance == pytest.approx(d.min()) and closest.a == d.argmin()
    deep = pcl_bsh.SphereHierarchy(points[d < -0.3])
    assert not pcl_bsh.any_collision(pcl_bsh.SphereHierarchy(points[d > 0.1]), tank, 0.1, pose_b=pose, solid=True)
    assert pcl_bsh.any_collision(deep, tank, 0.1, pose_b=pose, solid=True)
    with pytest.warns(UserWarning, match="`solid`"):
        assert not pcl_bsh.any_collision(deep, tank, 0.1, pose_b=pose)
    run = pcl_bsh.collide_along(scan, tank, [np.diag([1, 1, 1, 1.0]) + np.eye(4, k=3) * 9, pose], 0.1, solid=True,
                                first_poses=True, distances=True, pose_summaries=True)
    np.testing.assert_array_equal(run.first_pose, np.where(d <= 0.1, 1, -1))
    np.testing.assert_allclose(run.distance, np.where(d <= 0.1, d, np.nan), atol=1e-6)
    assert ((run.interval[d <= 0, 0] <= d[d <= 0] + 1e-12) & (run.interval[d <= 0, 1] >= d[d <= 0] - 1e-12)).all()
    assert np.isnan(run.interval[d > 0]).all()
    assert run.poses["colliding_points"].tolist() == [0, (d <= 0.1).sum()]


def test_corners_within_edges_of_neighbours(points):
    middles = np.array([[0, 0, 1], [0, -1, 1], [1, 0, 1], [0, 1, 1], [-1, 0, 1.0]])
    rim = [4, 9, 5, 10, 7, 11, 6, 12]
    top = [[8, rim[i], rim[(i + 1) % 8]] for i in range(8)]
    corners, faces = np.vstack([CORNERS, middles]), np.vstack([FACES[:2], FACES[4:], top])
    tank, scan = pcl_bsh.SphereHierarchy.of_triangles(corners, faces), pcl_bsh.SphereHierarchy(points)
    d = signed(points, np.eye(4))
    np.testing.assert_array_equal(pcl_bsh.collision_flags(scan, tank, solid=True), d <= 0)
    np.testing.assert_allclose(pcl_bsh.point_distances(scan, tank, solid=True).distance, d, atol=1e-12)
    corners = corners.copy()  # the hierarchy reads the former ones where they are
    corners[9, 1] = np.nextafter(-1, -2)
    with pytest.raises(ValueError, match=r"3 edges are open, the first from \(-1, -1, 1\) to \(1, -1, 1\)|"
                                         r"3 edges are open, the first from \(1, -1, 1\) to \(-1, -1, 1\)"):
        pcl_bsh.collision_flags(scan, pcl_bsh.SphereHierarchy.of_triangles(corners, faces), solid=True)


def test_clashes_are_as_deep_as_their_deepest_point():
    scan = pcl_bsh.SphereHierarchy(np.array([[0.0, 0.0, 1 - 0.0226], [0.0, 0.0, 1.01], [0.5, 0.5, -1 + 0.304]]))
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 2, 3] = [9, 0, -9]
    run = pcl_bsh.collide_along(scan, box(), poses, 0.05, solid=True, distances=True, first_poses=True,
                                closest_poses=True)
    deep, shallow = pcl_bsh.find_clashes(scan, run, 0.1)
    assert (deep.points, deep.scan_point, deep.closest_pose) == (1, 2, 1)
    assert (shallow.points, shallow.scan_point) == (2, 0)
    assert deep.distance == pytest.approx(-0.304) and shallow.distance == pytest.approx(-0.0226)
    assert deep.interval[0] <= -0.304 + 1e-15 and deep.interval[1] >= -0.304 - 1e-15
    assert pcl_bsh.find_clashes(scan, pcl_bsh.collide_along(scan, box(), poses, 0.05, distances=True, first_poses=True,
                                                            closest_poses=True), 0.1)[0].interval is None


def test_swept_depths_are_those_between_poses():
    scan = pcl_bsh.SphereHierarchy(np.array([[0.0, 0.25, 0.0]]))
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[:, 0, 3] = [-1.7, 2.2]
    words = {"solid": True, "distances": True, "closest_poses": True, "swept": 0.01}
    run = pcl_bsh.collide_along(scan, box(), poses, 0.0, **words)
    assert run.distance[0] == pytest.approx(-0.75, abs=0.005) and run.closest_pose.tolist() == [0]
    assert run.interval[0, 0] <= -0.75 <= run.interval[0, 1] + 0.005
    poses[1, :3, :3] = turned(1)[:3, :3]
    about = pcl_bsh.collide_along(scan, box(), poses, 0.0, pivot=[0.0, 5.0, 0.0], **words)
    d = [signed(np.array([[0.0, 0.25, 0.0]]), pcl_bsh.pose_between(poses[0], poses[1], s, pivot=[0.0, 5.0, 0.0]))[0]
         for s in np.linspace(0, 1, 2001)]
    assert about.interval[0, 0] - 1e-9 <= min(d) and about.distance[0] == pytest.approx(min(d), abs=0.006)


def test_two_solids_of_which_one_holds_the_other():
    tank, robot = box(4.0), box()
    for a, b, words in ((tank, robot, {"input_solid": True}), (robot, tank, {"solid": True})):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert not pcl_bsh.any_collision(a, b)
        assert pcl_bsh.any_collision(a, b, **words)
        for flags in pcl_bsh.collision_flags(a, b, side="both", **words):
            assert flags.tolist() == [1] * 12
        assert pcl_bsh.closest_pair(a, b, **words).distance == -3.0
        away = np.eye(4)
        away[0, 3] = 20
        poses = [away, np.eye(4)]
        assert pcl_bsh.any_collision_at_poses(a, b, poses, **words).tolist() == [0, 1]
        still = [[0, 0], [1, 1]]
        assert pcl_bsh.any_collision_on_motions(a, b, poses, still, swept=0.01, **words).tolist() == [0, 1]
    both = pcl_bsh.symmetric_distances(tank, robot, input_solid=True)
    assert both.b.distance.tolist() == [-3.0] * 12 and (both.a.distance > 0).all()


def test_scenes(points):
    for solid in (False, True):
        scene = pcl_bsh.Scene(any=True, flags=True, first_contact=True, response="stop")
        scene.add("tank", box(4.0), solid=solid)
        scene.add("probe", box(0.25), motion=pcl_bsh.VelocityMotion([1.0, 0, 0]))
        found = scene.query()
        assert [(pair["a"], pair["b"]) for pair in found.any] == ([(0, 1)] if solid else [])
        assert sum(part["colliding"] for part in found.flags) == (24 if solid else 0)
        assert scene.step(1.0).outcomes[0]["stuck"] == solid
    with pytest.raises(ValueError, match="object 'open': 3 edges are open"):
        scene.add("open", pcl_bsh.SphereHierarchy.of_triangles(CORNERS, FACES[:-1]), solid=True)


HOLLOW = "its faces close round places of .* without `{}`"


def test_queries_tell_of_a_mesh_that_is_hollow_by_mistake():
    tank, probe = box(4.0), pcl_bsh.SphereHierarchy(np.array([[0.5, 0.25, 0], [0, 0, 0]]))
    far = np.diag([1, 1, 1, 1.0]) + np.eye(4, k=3) * 30
    queries = {
        "any": lambda a, b, pose, **w: pcl_bsh.any_collision(a, b, pose_b=pose, **w),
        "flags": lambda a, b, pose, **w: pcl_bsh.collision_flags(a, b, pose_b=pose, **w),
        "indices": lambda a, b, pose, **w: pcl_bsh.colliding_indices(a, b, pose_b=pose, **w),
        "closest": lambda a, b, pose, **w: pcl_bsh.closest_pair(a, b, pose_b=pose, **w),
        "distances": lambda a, b, pose, **w: pcl_bsh.point_distances(a, b, pose_b=pose, **w),
        "symmetric": lambda a, b, pose, **w: pcl_bsh.symmetric_distances(a, b, pose_b=pose, **w),
        "any at poses": lambda a, b, pose, **w: pcl_bsh.any_collision_at_poses(a, b, [pose], **w),
        "closest at poses": lambda a, b, pose, **w: pcl_bsh.closest_pair_at_poses(a, b, [pose], **w),
        "motions": lambda a, b, pose, **w: pcl_bsh.any_collision_on_motions(a, b, [pose], [[0, 0]], swept=0.1, **w),
        "path": lambda a, b, pose, **w: pcl_bsh.collide_along(a, b, [pose], **w),
        "contacts": lambda a, b, pose: pcl_bsh.nearest_contacts(a, b, pose_b=pose),
        "pairs": lambda a, b, pose: pcl_bsh.pairs_within(a, b, pose_b=pose),
    }
    for name, ask in queries.items():
        with pytest.warns(UserWarning, match="(b|model): " + HOLLOW.format("solid")):
            ask(probe, tank, np.eye(4))
        if name != "distances":
            with pytest.warns(UserWarning, match="(a|scan): " + HOLLOW.format("input_solid")):
                ask(tank, probe, np.eye(4))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            ask(probe, tank, far)
            if name not in ("contacts", "pairs"):
                ask(probe, tank, np.eye(4), solid=True)
            if name not in ("contacts", "pairs", "distances"):
                ask(tank, probe, np.eye(4), input_solid=True)
        assert not [w for w in told if "close round" in str(w.message)], name
    with pytest.warns(UserWarning, match="'tank': its faces close round places of 'probe'"):
        scene = pcl_bsh.Scene(any=True)
        scene.add("tank", tank, fixed=True)
        scene.add("probe", probe)
        scene.query()


def test_closest_pairs_at_poses_are_those_of_each(points):
    tank, robot = box(4.0), box(0.5)
    poses = np.array([turned(i) for i in range(4)])
    poses[:, :3, 3] = [[0, 0, 0], [1, 2, 0.5], [3.8, 0, 0], [9, 0, 0]]
    for a, b, words in ((robot, tank, {"solid": True}), (tank, robot, {"input_solid": True}),
                        (tank, robot, {"solid": True, "input_solid": True}),
                        (pcl_bsh.SphereHierarchy(points), tank, {"solid": True})):
        distances, pairs = pcl_bsh.closest_pair_at_poses(a, b, poses, **words)
        for i, pose in enumerate(poses):
            one = pcl_bsh.closest_pair(a, b, pose_b=pose, **words)
            assert distances[i] == one.distance and tuple(pairs[i]) == (one.a, one.b)
        assert distances[0] < 0


def test_a_path_counts_what_is_held_without_flags(points):
    scan, tank = pcl_bsh.SphereHierarchy(points), box(4.0)
    run = pcl_bsh.collide_along(scan, tank, [np.eye(4)], flags=False, distances=True, solid=True)
    assert run.flags is None and run.colliding == len(points)


def test_what_does_not_close_is_refused(points):
    open_box = pcl_bsh.SphereHierarchy.of_triangles(CORNERS, FACES[:-1])
    with pytest.raises(ValueError, match="b: 3 edges are open"):
        pcl_bsh.any_collision(pcl_bsh.SphereHierarchy(points), open_box, solid=True)
    with pytest.raises(ValueError, match="a has no faces"):
        pcl_bsh.any_collision(pcl_bsh.SphereHierarchy(points), open_box, input_solid=True)


def test_options_that_would_change_nothing_are_refused(points):
    scan = pcl_bsh.SphereHierarchy(points)
    with pytest.raises(TypeError, match="there is no argument 'input_solid'"):
        pcl_bsh.point_distances(box(), scan, input_solid=True)
    for ask in (pcl_bsh.nearest_contacts, pcl_bsh.pairs_within, pcl_bsh.hausdorff_distance):
        with pytest.raises(TypeError):
            ask(scan, box(), solid=True)
