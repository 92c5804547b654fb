# SPDX-License-Identifier: BSD-3-Clause
"""Every query of two clouds against brute force."""

import itertools
import warnings

import numpy as np
import pytest

import pcl_bsh
from clouds import KINDS, cloud, distances, rigid, turned

PAIRS = list(itertools.product(KINDS, ("random", "lattice", "holes", "empty"), (0, 1)))
CLEARANCES = {"far": 0.25, "lattice": 1.0, "line": 1.0, "one_place": 0.0}


def clouds_of(kind_a, kind_b, pose):
    a, b = cloud(kind_a, 1), cloud(kind_b, 2, 60)
    exact = kind_a in ("lattice", "line", "one_place") and kind_b == "lattice"
    pose_b = rigid(pose) if exact else (np.eye(4) if pose == 0 else turned(pose))
    if kind_a == "far" and len(b):
        pose_b[:3, 3] += [500000.0, 5400000.0, 300.0]
    return a, b, pose_b, CLEARANCES.get(kind_a, 0.15), exact


@pytest.mark.parametrize("kind_a, kind_b, pose", PAIRS)
def test_two_clouds(kind_a, kind_b, pose):
    a, b, pose_b, clearance, exact = clouds_of(kind_a, kind_b, pose)
    d = distances(a, b, pose_b=pose_b)
    near = d <= clearance
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    both = pcl_bsh.collision_flags(A, B, clearance, pose_b=pose_b, side="both")
    np.testing.assert_array_equal(both[0], near.any(axis=1))
    np.testing.assert_array_equal(both[1], near.any(axis=0))
    np.testing.assert_array_equal(pcl_bsh.collision_flags(A, B, clearance, pose_b=pose_b), both[0])
    np.testing.assert_array_equal(pcl_bsh.collision_flags(A, B, clearance, pose_b=pose_b, side="b", threads=2), both[1])
    assert both[0].dtype == np.uint8 and both[0].flags.writeable
    rows = pcl_bsh.colliding_indices(A, B, clearance, pose_b=pose_b, side="both")
    np.testing.assert_array_equal(rows[0], np.flatnonzero(both[0]))
    np.testing.assert_array_equal(rows[1], np.flatnonzero(both[1]))

    found = pcl_bsh.any_collision(A, B, clearance, pose_b=pose_b)
    assert bool(found) == near.any() == (found.verdict == pcl_bsh.Verdict.COLLIDING)
    if near.any():
        assert near[found.pair]
    else:
        assert found.pair is None and found.verdict is pcl_bsh.Verdict.FREE

    closest = pcl_bsh.closest_pair(A, B, pose_b=pose_b)
    if np.isfinite(d).any():
        assert closest.distance == pytest.approx(d.min(), rel=1e-9, abs=1e-9)
        assert d[closest.a, closest.b] == pytest.approx(d.min(), rel=1e-9, abs=1e-9)
        assert closest.interval[0] <= closest.distance <= closest.interval[1]
        if exact:
            assert (closest.a, closest.b) == np.unravel_index(np.argmin(d), d.shape)
    else:
        assert (closest.distance, closest.a, closest.b) == (np.inf, None, None)

    pairs = pcl_bsh.pairs_within(A, B, clearance, pose_b=pose_b)
    assert sorted(map(tuple, pairs.tolist())) == sorted(map(tuple, np.argwhere(near).tolist()))
    contacts = pcl_bsh.nearest_contacts(A, B, clearance, pose_b=pose_b)
    assert contacts.complete and len(contacts) == near.sum()
    np.testing.assert_allclose(contacts.distance, np.sort(d[near]), atol=1e-9)
    assert set(zip(contacts.a.tolist(), contacts.b.tolist())) == set(map(tuple, np.argwhere(near).tolist()))
    apart = contacts.distance > 0
    np.testing.assert_allclose(np.linalg.norm(contacts.normal, axis=1), apart, atol=1e-12)


@pytest.mark.parametrize("kind_a, kind_b, pose", PAIRS)
def test_distances_of_points(kind_a, kind_b, pose):
    a, b, pose_b, _, exact = clouds_of(kind_a, kind_b, pose)
    d = distances(a, b, pose_b=pose_b)
    least = d.min(axis=1, initial=np.inf)
    for limit in (None, 0.5):
        A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
        found = pcl_bsh.point_distances(A, B, limit, pose_b=pose_b)
        distance, nearest = found
        has = np.isfinite(least) & (least <= (np.inf if limit is None else limit))
        np.testing.assert_array_equal(np.isfinite(distance), has)
        np.testing.assert_array_equal(nearest == -1, ~has)
        np.testing.assert_allclose(distance[has], least[has], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(d[has, nearest[has]], least[has], rtol=1e-9, atol=1e-9)
        if exact:
            np.testing.assert_array_equal(nearest[has], d.argmin(axis=1)[has])
        assert found.measured == has.sum() and found.undecided == 0 and found.interval is None
        if has.any():
            assert found.greatest == distance[has].max() == distance[found.greatest_pair[0]]
        else:
            assert np.isnan(found.greatest) and found.greatest_pair is None
    both = pcl_bsh.symmetric_distances(A, B, pose_b=pose_b, threads=2)
    finite_a, finite_b = np.isfinite(a).all(axis=1), np.isfinite(b).all(axis=1)
    if finite_a.any() and finite_b.any():
        d = d[finite_a][:, finite_b]
        hausdorff = max(d.min(axis=1).max(), d.min(axis=0).max())
        assert both.hausdorff == pytest.approx(hausdorff, rel=1e-9)
        assert both.hausdorff == max(both.a.greatest, both.b.greatest)
        np.testing.assert_allclose(both.b.distance[finite_b], d.min(axis=0), rtol=1e-9, atol=1e-9)
    elif finite_a.any() or finite_b.any():
        assert np.isnan(both.hausdorff) and both.hausdorff_pair is None


def test_contacts_of_which_only_the_nearest_are_wanted():
    a, b = cloud("lattice", 1), cloud("lattice", 2)
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    every, few = pcl_bsh.nearest_contacts(A, B, 2.0), pcl_bsh.nearest_contacts(A, B, 2.0, most=17)
    assert not few.complete and len(few) == 17
    np.testing.assert_array_equal(few.distance, every.distance[:17])
    np.testing.assert_array_equal(few.a, every.a[:17])
    np.testing.assert_allclose(every.normal[-1] * every.distance[-1], a[every.a[-1]] - b[every.b[-1]], atol=1e-12)
    with pytest.raises(ValueError, match="more than 17 pairs"):
        pcl_bsh.pairs_within(A, B, 2.0, most=17)


def test_radii():
    rng = np.random.default_rng(4)
    a, b = cloud("random", 1), cloud("random", 2)
    ra, rb = (rng.random(150).astype(np.float32) * np.float32(0.1) for _ in range(2))
    A, B = pcl_bsh.SphereHierarchy(a, radii=ra), pcl_bsh.SphereHierarchy(b, radii=rb)
    d = distances(a, b) - ra.astype(float)[:, None] - rb.astype(float)[None, :]
    np.testing.assert_array_equal(pcl_bsh.collision_flags(A, B, 0.02), (d <= 0.02).any(axis=1))
    assert pcl_bsh.closest_pair(A, B).distance == pytest.approx(d.min(), abs=1e-12) and d.min() < 0
    np.testing.assert_allclose(pcl_bsh.point_distances(A, B).distance, d.min(axis=1), atol=1e-12)


def test_uncertain_places():
    rng = np.random.default_rng(5)
    a, b = cloud("random", 1), cloud("random", 2)
    own = rng.random(150).astype(np.float32) * np.float32(0.03)
    A = pcl_bsh.SphereHierarchy(a, uncertainty=0.01, uncertainties=own)
    B = pcl_bsh.SphereHierarchy(b)
    reach = 0.01 + own.astype(float)[:, None]
    d = distances(a, b)
    certain, possible = (d + reach <= 0.06).any(axis=1), (d - reach <= 0.06).any(axis=1)
    expected = np.where(certain, pcl_bsh.Verdict.COLLIDING, np.where(possible, pcl_bsh.Verdict.UNDECIDED, 0))
    np.testing.assert_array_equal(pcl_bsh.collision_flags(A, B, 0.06), expected)
    assert set(expected) == {0, 1, 2}
    with pytest.raises(ValueError, match="undecided: ask collision_flags"):
        pcl_bsh.colliding_indices(A, B, 0.06)
    lone = pcl_bsh.SphereHierarchy([[0.0, 0, 0]], uncertainty=0.5)
    maybe = pcl_bsh.any_collision(lone, pcl_bsh.SphereHierarchy([[0.0, 0, 1]]), 0.9)
    assert maybe.verdict is pcl_bsh.Verdict.UNDECIDED and "UNDECIDED" in repr(maybe)
    with pytest.raises(ValueError, match="undecided is neither"):
        bool(maybe)


def test_uncertain_poses():
    """Turned by up to 0.2 about the origin, a point at 1 moves by no more than 0.2, one at 3 by no more than 0.6."""
    wall = pcl_bsh.SphereHierarchy([[1.0, 0, 0], [3, 0, 0]])
    points = np.array([[1.0, 0.35, 0], [3, 0.35, 0]])
    turned = pcl_bsh.SphereHierarchy(points, pose_uncertainty=(0.01, 0.2, 0, 0, 0))
    np.testing.assert_array_equal(pcl_bsh.collision_flags(wall, turned, 0.1), [0, 2])
    along = pcl_bsh.collide_along(wall, turned, [np.eye(4), np.eye(4)], clearance=0.1)
    np.testing.assert_array_equal(along.flags, [0, 2])
    far = np.eye(4)
    far[2, 3] = 5
    np.testing.assert_array_equal(pcl_bsh.any_collision_at_poses(wall, turned, [np.eye(4), far], 0.1), [2, 0])
    assert [part["flags"].tolist() for part in flags_in_a_scene(wall, turned) if part["object"] == 0] == [[0, 2]]
    by_text = pcl_bsh.SphereHierarchy(points, pose_uncertainty="0.01,0.2")
    np.testing.assert_array_equal(pcl_bsh.collision_flags(wall, by_text, 0.1), [0, 2])
    sheet = np.array([[3.0, 0.35, 0], [3, 0.35, 1], [3, 1, 0]])
    for pose_uncertainty, verdict in ((None, 0), (0.3, 2), ((0, 0.2), 2)):
        mesh = pcl_bsh.SphereHierarchy.of_triangles(sheet, [[0, 1, 2]], pose_uncertainty=pose_uncertainty)
        np.testing.assert_array_equal(pcl_bsh.collision_flags(wall, mesh, 0.1), [0, verdict])
    assert "uncertain" in repr(turned)
    for wrong in ("x", "1,2,3", (1, 2, 3), -1, (0, np.nan)):
        with pytest.raises(ValueError, match="pose uncertainty: .* is none: give T"):
            pcl_bsh.SphereHierarchy(points, pose_uncertainty=wrong)


def flags_in_a_scene(wall, turned):
    scene = pcl_bsh.Scene(clearance=0.1, flags=True)
    scene.add("wall", wall, fixed=True)
    scene.add("machine", turned)
    return scene.query().flags


def test_density_guard():
    x, y = np.meshgrid(np.arange(0, 2, 0.1), np.arange(0, 2, 0.1))
    wall = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    probe = np.array([[1.05, 1.05, 0.06], [1.0, 1.0, 0.02], [1.0, 1.0, 1.0]])
    W = pcl_bsh.SphereHierarchy(wall)
    spacings = pcl_bsh.patch_spacings(W, 0.3)
    assert spacings.dtype == np.float32 and spacings.shape == (400,)
    assert np.median(spacings) == pytest.approx(0.1 * np.sqrt(2), rel=1e-5)
    np.testing.assert_array_equal(pcl_bsh.patch_spacings(W), pcl_bsh.patch_spacings(W, 8 * pcl_bsh.spacing_of(W)["median"]))
    P = pcl_bsh.SphereHierarchy(probe)
    free, collides, sparse = pcl_bsh.Verdict.FREE, pcl_bsh.Verdict.COLLIDING, pcl_bsh.Verdict.SPARSE
    assert pcl_bsh.collision_flags(P, W, 0.05).tolist() == [free, collides, free]
    assert pcl_bsh.collision_flags(P, W, 0.05, spacings_of_b=spacings).tolist() == [sparse, collides, free]
    with pytest.raises(ValueError, match="spacings_of_b"):
        pcl_bsh.collision_flags(P, W, 0.05, spacings_of_b=spacings[:3])


def test_options_of_questions_are_arguments():
    corners = np.array(list(itertools.product([0.0, 1], repeat=3)))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]  # facing outward
    box = pcl_bsh.SphereHierarchy.of_triangles(corners, [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))])
    inside = pcl_bsh.SphereHierarchy(np.array([[0.5, 0.5, 0.25], [3, 3, 3]]))
    assert pcl_bsh.collision_flags(inside, box, 0.1).tolist() == [0, 0]
    assert pcl_bsh.collision_flags(inside, box, 0.1, solid=True).tolist() == [1, 0]
    assert pcl_bsh.point_distances(inside, box, 1.0, solid=True).distance[0] == -0.25
    grid = pcl_bsh.SphereHierarchy(np.array([[x, y, 0.0] for x in range(9) for y in range(9)]))
    above = pcl_bsh.SphereHierarchy(np.array([[4.5, 4.5, 0.1]]))
    assert pcl_bsh.collision_flags(above, grid, 0.2, density=True, widest_gap=2.0).tolist() == [pcl_bsh.Verdict.SPARSE]
    assert pcl_bsh.collision_flags(above, grid, 0.2, density=False, widest_gap=None).tolist() == [0]
    seen = pcl_bsh.collision_flags(grid, above, 0.05, side="b", seen=True, origin="4.5,4.5,-5")
    assert seen.tolist() == [pcl_bsh.Verdict.UNSEEN]  # beyond what stopped the beams
    for ask in (pcl_bsh.collision_flags, pcl_bsh.colliding_indices, pcl_bsh.any_collision):  # none may hide it
        with pytest.raises(ValueError, match="seen"):
            ask(grid, above, 0.05, seen=True, origin="4.5,4.5,-5")
    assert pcl_bsh.colliding_indices(inside, box, 0.1).tolist() == []
    assert pcl_bsh.colliding_indices(inside, box, 0.1, solid=True).tolist() == [0]
    assert not pcl_bsh.any_collision(inside, box, 0.1) and pcl_bsh.any_collision(inside, box, 0.1, solid=True)
    for ask in (pcl_bsh.colliding_indices, pcl_bsh.any_collision):
        with pytest.raises(ValueError, match="density"):
            ask(above, grid, 0.2, density=True)
    with pytest.raises(ValueError, match="density"):
        pcl_bsh.collision_flags(above, grid, 0.2, side="b", density=True)
    with pytest.raises(ValueError, match="density"):
        pcl_bsh.collision_flags(above, grid, 0.2, widest_gap=2.0)
    for name in ("swept_by", "vertices_only", "uncertainty", "max_distance"):
        with pytest.raises(TypeError, match=name):
            pcl_bsh.collision_flags(above, grid, **{name: 1.0})
    with pytest.raises(TypeError, match="density"):
        pcl_bsh.point_distances(above, grid, density=True)
    assert "solid : bool, optional\n    The obstacle is a solid, whose faces must close" in pcl_bsh.collision_flags.__doc__


@pytest.mark.parametrize("text", ["exact", "tolerance=0.05", "level=0", "level=3", "pairs=20", "time=0.001"])
def test_accuracy_keeps_its_promises(text):
    a, b = cloud("random", 1, 400), cloud("random", 2, 300)
    pose_b = turned(3)
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    d = distances(a, b, pose_b=pose_b)
    accuracy = pcl_bsh.Accuracy(text)
    assert str(accuracy) == text and accuracy == pcl_bsh.Accuracy(str(accuracy))
    slack = 0.05 if text.startswith("tolerance") else 0.0
    flags = pcl_bsh.collision_flags(A, B, 0.05, pose_b=pose_b, accuracy=accuracy)
    surely, maybe = (d <= 0.05).any(axis=1), (d <= 0.05 + slack).any(axis=1)
    assert not flags[~maybe & (flags != 2)].any() and (flags[surely] != 0).all()
    assert accuracy.stops_early or not (flags == 2).any()
    pair = pcl_bsh.closest_pair(A, B, pose_b=pose_b, accuracy=text)
    assert pair.interval[0] <= d.min() * (1 + 1e-12) and pair.interval[1] >= d.min() * (1 - 1e-12)
    found = pcl_bsh.any_collision(A, B, 0.05, pose_b=pose_b, accuracy=text)
    assert found.verdict in (pcl_bsh.Verdict.UNDECIDED, pcl_bsh.Verdict.COLLIDING) and surely.any()
    measured = pcl_bsh.point_distances(A, B, pose_b=pose_b, accuracy=text)
    if measured.interval is not None:
        assert measured.interval.shape == (400, 2)
        least = d.min(axis=1)
        assert (measured.interval[:, 0] <= least + 1e-9).all() and (measured.interval[:, 1] >= least - 1e-9).all()
    assert (measured.undecided == 0) or accuracy.stops_early


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda A: pcl_bsh.collision_flags(A, A, -1.0), "clearance"),
        (lambda A: pcl_bsh.collision_flags(A, A, np.nan), "clearance"),
        (lambda A: pcl_bsh.collision_flags(A, A, 0.1, side="c"), "side: `c` is none"),
        (lambda A: pcl_bsh.any_collision(A, A, np.inf), "clearance"),
        (lambda A: pcl_bsh.any_collision(A, A, 0.1, accuracy="fine"), "fine"),
        (lambda A: pcl_bsh.closest_pair(A, A, accuracy=pcl_bsh.Accuracy.tolerance(-1)), "tolerance|length|-1"),
        (lambda A: pcl_bsh.nearest_contacts(A, A, -1.0), "clearance"),
        (lambda A: pcl_bsh.point_distances(A, A, -1.0), "max_distance|distance"),
        (lambda A: pcl_bsh.radius_search(A, [0.0, 0, 0], -1.0), "radius"),
        (lambda A: pcl_bsh.radius_search(A, np.zeros((2, 2)), 1.0), r"queries: have shape \(2, 2\)"),
        (lambda A: pcl_bsh.box_search(A, [np.nan, 0, 0], [1, 1, 1]), "NaN|nan|box"),
        (lambda A: pcl_bsh.euclidean_clusters(A, -1.0), "distance"),
        (lambda A: pcl_bsh.patch_spacings(A, 0.0), "gap"),
        (lambda A: pcl_bsh.collide_along(A, A, np.zeros((2, 4, 4)), 0.1), "poses|rigid|last row"),
        (lambda A: pcl_bsh.collide_along(A, A, np.eye(4), 0.1), r"\(m, 4, 4\)"),
        (lambda A: pcl_bsh.any_collision_on_motions(A, A, [np.eye(4)], [[0, 1]], 0.1, swept=0.1), "motion|pose"),
        (lambda A: pcl_bsh.any_collision_on_motions(A, A, [np.eye(4)], [[0, 0]], 0.1, swept=0.0), "swept"),
        (lambda A: pcl_bsh.SphereHierarchy.of_triangles(np.zeros((3, 3)), [[0, 1, 3]]), "names vertex 3"),
        (lambda A: pcl_bsh.SphereHierarchy.of_triangles(np.zeros((3, 3)), [[0, 1]]), r"triangles: have shape \(1, 2\)"),
        (lambda A: pcl_bsh.Accuracy("level=x"), "level=x"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(call, words):
    with pytest.raises(ValueError, match=words) as error:
        call(pcl_bsh.SphereHierarchy(cloud("random")))
    assert "\n" not in str(error.value) and ": " in str(error.value)


def test_arguments_of_another_type():
    A = pcl_bsh.SphereHierarchy(cloud("random"))
    for call in (lambda: pcl_bsh.collision_flags(A, cloud("random"), 0.1), lambda: pcl_bsh.collision_flags(A),
                 lambda: pcl_bsh.collision_flags(A, A, "0.1"), lambda: pcl_bsh.collision_flags(A, A, 0.1, np.eye(4)),
                 lambda: pcl_bsh.collision_flags(A, A, threads=-1), lambda: pcl_bsh.collision_flags(None, A),
                 lambda: pcl_bsh.collision_flags(A, A, accuracy=3), lambda: pcl_bsh.nearest_contacts(A, A, most=-1),
                 lambda: pcl_bsh.collide_along(A, A, [np.eye(4)], swept="far"),
                 lambda: pcl_bsh.Scene().add("a", [("b", "c")]), lambda: pcl_bsh.Scene().add("a", A, motion=3),
                 lambda: pcl_bsh.any_collision_on_motions(A, A, [np.eye(4)], [[0, 0]], 0.1)):
        with pytest.raises(TypeError):
            call()


def test_accuracies_are_compared():
    assert pcl_bsh.Accuracy("tolerance=0.1") == pcl_bsh.Accuracy.tolerance(0.1) != pcl_bsh.Accuracy.exact()
    assert pcl_bsh.Accuracy() != "exact" and pcl_bsh.Accuracy() != None  # noqa: E711


def test_work_is_counted():
    A, B = pcl_bsh.SphereHierarchy(cloud("random", 1, 2000)), pcl_bsh.SphereHierarchy(cloud("random", 2, 2000))
    work = pcl_bsh.closest_pair(A, B).work
    assert work.node_pairs > 0 and work.voxels_built > 0 and work.updates >= work.volumes_carried
    assert repr(work).startswith("Work(node_pairs=")


def warnings_of(ask):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        ask()
    assert all(warning.category is UserWarning for warning in told)
    return [str(warning.message) for warning in told]


def test_warnings_say_what_answers_do_not():
    floor = np.array([[i, j, 0] for i in range(20) for j in range(20)], dtype=np.float32)
    gaps = floor.copy()
    gaps[7, 1] = np.nan
    far = np.eye(4)
    far[0, 3] = 5e6
    a, b = pcl_bsh.SphereHierarchy(floor), pcl_bsh.SphereHierarchy(floor.astype(np.float64))
    nothing, some = pcl_bsh.SphereHierarchy(np.zeros((0, 3))), pcl_bsh.SphereHierarchy(gaps)
    utm = pcl_bsh.SphereHierarchy(floor + np.array([500000, 0, 0], dtype=np.float32))
    flags = lambda a, b, clearance, **more: warnings_of(lambda: pcl_bsh.collision_flags(a, b, clearance, **more))

    assert flags(a, b, 2.0) == []
    for _ in range(2):  # measured once
        (holes,) = flags(a, b, 1.0)
        assert holes.startswith("points lie 1 apart in a and 1 in b: surfaces may touch")
    lattice = pcl_bsh.SphereHierarchy(floor.copy())
    assert flags(lattice, lattice, 1.5) == []
    lattice.refit(floor * np.float32(3))  # measured anew
    (holes,) = flags(lattice, lattice, 1.5)
    assert holes.startswith("points lie 3 apart in a and 3 in b: surfaces may touch")
    assert flags(a, nothing, 2.0) == ["b: has no finite point: nothing collides with it"]
    assert flags(some, b, 2.0) == ["a: 1 of 400 points is not finite: it is left out"]
    (apart,) = flags(a, b, 2.0, pose_b=far)
    assert apart.startswith("the boxes of a and of b, with all of its motion, are 4.99998e+06 apart")
    assert flags(a, b, 2.0, pose_a=far, pose_b=far) == []
    assert flags(utm, utm, 0.25)[0].startswith("a: its float32 coordinates lie 0.03125 apart")

    queries = [
        lambda b: pcl_bsh.any_collision(a, b, 2.0),
        lambda b: pcl_bsh.colliding_indices(a, b, 2.0),
        lambda b: pcl_bsh.closest_pair(a, b),
        lambda b: pcl_bsh.point_distances(a, b),
        lambda b: pcl_bsh.symmetric_distances(a, b),
        lambda b: pcl_bsh.hausdorff_distance(a, b),
        lambda b: pcl_bsh.nearest_contacts(a, b, 2.0),
        lambda b: pcl_bsh.pairs_within(a, b, 2.0),
        lambda b: pcl_bsh.collide_along(a, b, [np.eye(4)], 2.0),
        lambda b: pcl_bsh.any_collision_at_poses(a, b, [np.eye(4)], 2.0),
        lambda b: pcl_bsh.closest_pair_at_poses(a, b, [np.eye(4)]),
        lambda b: pcl_bsh.any_collision_on_motions(a, b, [np.eye(4)], [[0, 0]], 2.0, swept=0.1),
    ]
    for query in queries:
        assert warnings_of(lambda: query(b)) == []
        (told,) = warnings_of(lambda: query(nothing))
        assert "has no finite point" in told
    assert len(warnings_of(lambda: pcl_bsh.any_collision_at_poses(a, b, [far], 2.0))) == 1
    assert warnings_of(lambda: pcl_bsh.any_collision_at_poses(a, b, [far, np.eye(4)], 2.0)) == []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning):
            pcl_bsh.collision_flags(a, nothing, 2.0)


def test_warnings_of_scenes():
    floor = pcl_bsh.SphereHierarchy(np.array([[i, j, 0.0] for i in range(20) for j in range(20)]))
    far = np.eye(4)
    far[0, 3] = 5e6
    drive = pcl_bsh.VelocityMotion([1, 0, 0])

    def told(clearance, *objects):
        scene = pcl_bsh.Scene(clearance=clearance, any=True)
        for i, (cloud, more) in enumerate(objects):
            scene.add(f"object {i}", cloud, **more)
        first = warnings_of(scene.query)
        assert warnings_of(lambda: scene.step(0.1)) == []  # nothing was added
        return first

    assert told(2.0, (floor, {}), (floor, {})) == []
    (holes,) = told(1.0, (floor, {}), (floor, {}))
    assert holes.startswith("points lie 1 apart in object 0 and 1 in object 1: surfaces may touch")
    (untested,) = told(1.0, (floor, {"fixed": True}), (floor, {"fixed": True}))
    assert untested.startswith("no pair of objects is tested: all 2 objects are fixed")
    small = pcl_bsh.SphereHierarchy(np.array([[i, j, 0.0] for i in range(20) for j in range(20)]) / 1000)
    (units,) = told(2.0, (floor, {}), (small, {}))
    assert units.startswith("object 0 is 1000 times as large as object 1: ")
    nothing = pcl_bsh.SphereHierarchy(np.zeros((0, 3)))
    assert told(2.0, (floor, {}), (nothing, {})) == ["object 1: has no finite point: nothing collides with it"]
    (apart,) = told(2.0, (floor, {}), (floor, {"pose": far}))
    assert apart.startswith("the boxes of ") and " are 4.99998e+06 apart" in apart
    assert told(2.0, (floor, {}), (floor, {"pose": far, "motion": drive})) == []  # it may come
