# SPDX-License-Identifier: BSD-3-Clause
"""Paths, clashes, many poses and many motions against brute force."""

import numpy as np
import pytest

import pcl_bsh
from clouds import KINDS, cloud, distances, rigid, turned


def path(m=7, seed=1):
    poses = np.array([turned(seed)] * m)
    poses[:, 0, 3] = np.linspace(-0.5, 1.5, m)
    return poses


@pytest.mark.parametrize("kind", KINDS)
def test_along_a_path(kind):
    scan, model, poses = cloud(kind, 1), cloud("random", 2, 40), path()
    if kind == "far":
        poses[:, :3, 3] += [500000.0, 5400000.0, 300.0]
    S, M = pcl_bsh.SphereHierarchy(scan), pcl_bsh.SphereHierarchy(model)
    d = np.array([distances(scan, model, pose_b=pose) for pose in poses])  # (pose, scan, model)
    clearance = 0.1
    near = (d <= clearance).any(axis=2)
    hit = near.any(axis=0)
    run = pcl_bsh.collide_along(S, M, poses, clearance, distances=True, first_poses=True, closest_poses=True,
                                pose_summaries=True, threads=2)
    np.testing.assert_array_equal(run.flags, hit)
    assert run.colliding == hit.sum() and run.undecided == 0 and run.first_contact is None
    np.testing.assert_array_equal(run.first_pose, np.where(hit, near.argmax(axis=0), -1))
    least = d.min(axis=2, initial=np.inf)
    np.testing.assert_array_equal(np.isnan(run.distance), ~hit)
    np.testing.assert_allclose(run.distance[hit], least.min(axis=0)[hit], rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(least[run.closest_pose[hit], hit], least.min(axis=0)[hit], rtol=1e-9, atol=1e-9)
    at = d[run.closest_pose[hit], np.flatnonzero(hit), run.closest_point[hit]]
    np.testing.assert_allclose(at, least.min(axis=0)[hit], rtol=1e-9, atol=1e-9)
    assert (run.closest_point[~hit] == -1).all() and (run.closest_pose[~hit] == -1).all()
    assert run.poses.dtype.names == ("colliding", "colliding_points", "undecided_points", "distance")
    np.testing.assert_array_equal(run.poses["colliding_points"], near.sum(axis=1))
    np.testing.assert_array_equal(run.poses["colliding"], near.any(axis=1))
    some = pcl_bsh.collide_along(S, M, poses[:, :3], clearance, flags=False, first_poses=True)
    assert some.flags is None and some.distance is None and some.poses is None and some.certain_pose is None
    np.testing.assert_array_equal(some.first_pose, run.first_pose)


def test_swept():
    scan = np.array([[5.0, 0, 0.1], [5, 0, 3]])
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[1, 0, 3] = 10
    S, M = pcl_bsh.SphereHierarchy(scan), pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    assert pcl_bsh.collide_along(S, M, poses, 0.2).flags.tolist() == [0, 0]
    run = pcl_bsh.collide_along(S, M, poses, 0.2, swept=0.01, pivot=[0, 0, 0])
    assert run.flags.tolist() == [1, 0]
    pose, fraction = run.first_contact
    where = pcl_bsh.pose_between(poses[0], poses[1], fraction)[0, 3]
    assert pose == 0 and 0.2 <= np.hypot(5 - where, 0.1) + 1e-9 and np.hypot(5 - where, 0.1) <= 0.21 + 1e-9
    np.testing.assert_array_equal(pcl_bsh.pose_between(poses[0], poses[1], 1.0), poses[1])
    half_turn = np.diag([-1.0, -1, 1, 1])
    with pytest.raises(ValueError, match="half a turn"):
        pcl_bsh.pose_between(np.eye(4), half_turn, 0.5)


def test_uncertain_places_along_a_path():
    S = pcl_bsh.SphereHierarchy([[5.0, 0, 0.2], [5, 0, 0.05], [5, 0, 9]], uncertainty=0.04)
    M = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 0, 3] = [0, 5, 5]
    run = pcl_bsh.collide_along(S, M, poses, 0.18, first_poses=True)
    assert run.flags.tolist() == [2, 1, 0] and run.certain_pose.tolist() == [-1, 1, -1] and run.undecided == 1
    assert "1 are undecided" in repr(run)


def test_progress_and_stop():
    scan, model, poses = cloud("random", 1, 3000), cloud("random", 2, 300), path(100)
    S, M = pcl_bsh.SphereHierarchy(scan), pcl_bsh.SphereHierarchy(model)
    motions = [[i, i + 1] for i in range(99)]
    calls = {
        "along": lambda progress: pcl_bsh.collide_along(S, M, poses, 0.05, progress=progress).flags,
        "distances": lambda progress: pcl_bsh.point_distances(S, M, progress=progress).distance,
        "symmetric": lambda progress: pcl_bsh.symmetric_distances(S, M, progress=progress).b.distance,
        "any": lambda progress: pcl_bsh.any_collision_at_poses(S, M, poses, 0.05, progress=progress),
        "contacts": lambda progress: pcl_bsh.nearest_contacts(S, M, 0.3, progress=progress).distance,
        "pairs": lambda progress: pcl_bsh.pairs_within(S, M, 0.3, progress=progress),
        "closest": lambda progress: pcl_bsh.closest_pair_at_poses(S, M, poses, progress=progress)[0],
        "motions": lambda progress: pcl_bsh.any_collision_on_motions(S, M, poses, motions, 0.05, swept=0.01,
                                                                     progress=progress),
    }
    for name, call in calls.items():
        seen = []
        told = call(seen.append)
        assert seen and seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1, name
        with pytest.raises(pcl_bsh.Cancelled):
            call(lambda done: False)

        def fail(done):
            raise KeyError("mine")

        with pytest.raises(KeyError, match="mine"):
            call(fail)
        np.testing.assert_array_equal(call(None), told)  # and may be asked again


def test_clashes():
    scan = np.array([[0.0, 0, 1], [0.1, 0, 1], [5, 0, 0.5], [5.1, 0, 0.8], [9, 0, 0.3]])
    model = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[1, 0, 3] = 5
    S = pcl_bsh.SphereHierarchy(scan)
    ask = dict(distances=True, first_poses=True, closest_poses=True)
    run = pcl_bsh.collide_along(S, model, poses, 1.1, **ask)
    clashes = pcl_bsh.find_clashes(S, run, 0.5)
    assert [clash.distance for clash in clashes] == [0.5, 1.0]
    first = clashes[0]
    assert first.records.tolist() == [2, 3] and first.points == 2 and first.status == "new"
    np.testing.assert_array_equal([first.low, first.high], [scan[2:4].min(axis=0), scan[2:4].max(axis=0)])
    assert (first.scan_point, first.model_point, first.first_pose, first.closest_pose) == (2, 0, 1, 1)
    later = pcl_bsh.find_clashes(S, pcl_bsh.collide_along(S, model, poses[:1], 1.1, **ask), 0.5)
    compared = pcl_bsh.compare_with_earlier(later, clashes, 0.5)
    assert [clash.status for clash in compared] == ["persisting", "resolved"]
    assert len(later) == 1 and later[0].status == "new" and len(compared[1].records) == 0
    with pytest.raises(ValueError):
        pcl_bsh.find_clashes(S, pcl_bsh.collide_along(S, model, poses, 1.1), 0.5)
    with pytest.raises(ValueError):
        pcl_bsh.find_clashes(S, run, 0.0)


@pytest.mark.parametrize("kind", KINDS)
def test_many_poses(kind):
    a, b = cloud(kind, 1), cloud("random", 2, 40)
    poses = np.array([turned(k) for k in range(9)] + [np.eye(4), rigid(50)])
    d = np.array([distances(a, b, pose_b=pose) for pose in poses])
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    np.testing.assert_array_equal(pcl_bsh.any_collision_at_poses(A, B, poses, 0.1, threads=2),
                                  (d <= 0.1).any(axis=(1, 2)))
    least, pairs = pcl_bsh.closest_pair_at_poses(A, B, poses)
    assert pairs.shape == (len(poses), 2)
    if np.isfinite(d).any():
        np.testing.assert_allclose(least, d.min(axis=(1, 2)), rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(d[range(len(poses)), pairs[:, 0], pairs[:, 1]], least, rtol=1e-9, atol=1e-9)
    else:
        assert np.isinf(least).all() and (pairs == -1).all()
    none = np.zeros((0, 4, 4))
    assert len(pcl_bsh.any_collision_at_poses(A, B, none, 0.1)) == 0


def test_many_motions():
    a, b = cloud("random", 1, 60), cloud("random", 2, 20)
    poses = np.array([turned(k) for k in range(5)])
    poses[:, :3, 3] *= 2
    motions = [[i, j] for i in range(5) for j in range(5)]
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    clearance, tolerance = 0.02, 0.01
    verdicts = pcl_bsh.any_collision_on_motions(A, B, poses, np.array(motions), clearance, swept=tolerance, threads=2)
    for (i, j), verdict in zip(motions, verdicts):
        steps = [pcl_bsh.pose_between(poses[i], poses[j], s) for s in np.linspace(0, 1, 40)]
        least = min(distances(a, b, pose_b=step).min() for step in steps)
        assert verdict or least > clearance  # free is free at every instant
        run = pcl_bsh.collide_along(A, B, [poses[i], poses[j]], clearance, swept=tolerance)
        if least <= clearance:
            assert verdict and run.colliding
    assert 0 < verdicts.sum() < len(motions)
    assert len(pcl_bsh.any_collision_on_motions(A, B, poses, np.zeros((0, 2), int), 0.1, swept=0.1)) == 0
