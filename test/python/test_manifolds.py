# SPDX-License-Identifier: BSD-3-Clause
"""The few contacts of two bodies, ways out, and masses, against brute force and formulas."""

import itertools

import numpy as np
import pytest

import pcl_bsh
from clouds import turned
from test_solids import CORNERS, FACES, box, signed


def floor(size=20.0):
    corners = np.array([[-size, -size, 0], [size, -size, 0], [size, size, 0], [-size, size, 0.0]])
    return pcl_bsh.SphereHierarchy.of_triangles(corners, [[0, 1, 2], [0, 2, 3]])


def lifted(height, x=0.0):
    pose = np.eye(4)
    pose[[0, 2], 3] = [x, height]
    return pose


def area(places):
    """The largest area of a polygon with these corners in the plane."""
    return max(abs(sum(p[i][0] * p[i - 1][1] - p[i][1] * p[i - 1][0] for i in range(len(p)))) / 2
               for p in itertools.permutations(places))


def test_a_box_on_a_floor_has_its_corners():
    found = pcl_bsh.contact_manifold(box(), floor(), 0.25, pose_a=lifted(1.125, 0.5))
    assert len(found) == 4 and repr(found) == "Manifold(4 contacts)"
    np.testing.assert_array_equal(found.distance, [0.125] * 4)
    np.testing.assert_array_equal(found.normal, [[0, 0, 1]] * 4)
    np.testing.assert_array_equal(found.place_a[:, 2], [0.125] * 4)
    np.testing.assert_array_equal(found.place_b, found.place_a * [1, 1, 0])
    assert {tuple(p) for p in found.place_a[:, :2]} == {(-0.5, -1), (1.5, -1), (-0.5, 1), (1.5, 1)}
    assert found.id.tolist() == [1, 2, 3, 4] and found.patch.tolist() == [0] * 4 and found.thickness == 0
    assert all(found.place_a[i] in (CORNERS[FACES[a]] + [0.5, 0, 1.125]) for i, a in enumerate(found.a))
    for name, shape, dtype in (("a", (4,), np.int32), ("b", (4,), np.int32), ("distance", (4,), np.float64),
                               ("normal", (4, 3), np.float64), ("residual", (4,), np.float64), ("id", (4,), np.int32)):
        column = getattr(found, name)
        assert (column.shape, column.dtype, column.flags.writeable) == (shape, dtype, False)
    assert found.work.node_pairs > 0


@pytest.mark.parametrize("seed", range(6))
def test_dots_over_a_floor_are_chosen_as_brute_force_does(seed):
    rng = np.random.default_rng(seed)
    dots = rng.random((40, 3)) * [2, 2, 0.1]
    margin = 0.08
    found = pcl_bsh.contact_manifold(pcl_bsh.SphereHierarchy(dots), floor(), margin, most_patches=1, height=1.0)
    gaps = dots[:, 2]
    candidates = np.flatnonzero(gaps <= margin)
    chosen = [candidates[gaps[candidates].argmin()]]
    weight = (margin - gaps) / (margin - gaps[chosen[0]])
    spans = (lambda i: np.linalg.norm(dots[i, :2] - dots[chosen[0], :2]),
             lambda i: area(dots[[*chosen, i], :2]),
             lambda i: hull_area(dots[[*chosen, i], :2]) - area(dots[chosen, :2]))
    for span in spans:
        chosen.append(max((i for i in candidates if i not in chosen), key=lambda i: weight[i] * span(i)))
    assert found.a.tolist() == chosen
    np.testing.assert_allclose(found.distance, gaps[chosen], atol=1e-15)
    np.testing.assert_allclose(found.place_a, dots[chosen], atol=1e-14)
    np.testing.assert_allclose(found.place_b, dots[chosen] * [1, 1, 0], atol=1e-14)


def hull_area(places):
    """The area of the convex hull of four places: the largest of triangles and quadrangles that they span."""
    return max([area(places[list(of)]) for of in itertools.combinations(range(4), 3)] + [area(places)])


def test_what_a_solid_holds_has_gaps_below_zero():
    rng = np.random.default_rng(8)
    dots = rng.uniform(-1.2, 1.2, (200, 3))
    pose = turned(3)
    tank = pcl_bsh.Collider(box(), solid=True)
    found = pcl_bsh.contact_manifold(pcl_bsh.SphereHierarchy(dots), tank, 0.1, pose_b=pose, thickness=0.0)
    d = signed(dots, pose)
    assert d[found.a[0]] == d.min() and found.distance[0] == pytest.approx(d.min(), abs=1e-12)
    np.testing.assert_allclose(found.distance, d[found.a], atol=1e-12)
    np.testing.assert_allclose(found.place_a - found.place_b, found.distance[:, None] * found.normal, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(found.normal, axis=1), 1)
    assert repr(tank) == "Collider(12 triangles, solid)" and tank.solid and isinstance(tank.cloud, pcl_bsh.SphereHierarchy)
    with pytest.warns(UserWarning, match="`solid`"):  # as surfaces, faces hold nothing
        pcl_bsh.contact_manifold(pcl_bsh.SphereHierarchy(dots[d < -0.2]), pcl_bsh.Collider(box()), 0.1, pose_b=pose)


def test_balls_have_places_on_their_surfaces():
    ball = pcl_bsh.SphereHierarchy(np.zeros((1, 3)), radii=np.array([0.5], np.float32))
    found = pcl_bsh.contact_manifold(ball, floor(), 0.5, pose_a=lifted(1.0), thickness=0.25)
    assert found.distance.tolist() == [0.25] and found.thickness == 0.25
    np.testing.assert_array_equal(found.place_a, [[0, 0, 0.5]])
    both = pcl_bsh.contact_manifold(ball, ball, 0.5, pose_a=lifted(1.25))
    np.testing.assert_array_equal(both.normal, [[0, 0, 1]])
    assert both.distance.tolist() == [0.25]


def test_normals_of_points_are_fitted_or_given():
    grid = np.stack([*np.meshgrid(np.arange(20) * 0.125, np.arange(20) * 0.125), np.zeros((20, 20))], axis=-1).reshape(-1, 3)
    scan, foot = pcl_bsh.SphereHierarchy(grid), pcl_bsh.SphereHierarchy(np.array([[1.2, 1.2, 0.05]]))
    fitted = pcl_bsh.contact_manifold(foot, scan, 0.1, thickness=0.0)
    np.testing.assert_allclose(fitted.normal, [[0, 0, 1]], atol=1e-12)
    assert fitted.residual[0] < 1e-12 and pcl_bsh.Collider(scan).spacing == 0.125
    slope = np.array([0.6, 0, 0.8])
    given = pcl_bsh.Collider(scan, normals=np.tile(3 * slope, (400, 1)))
    found = pcl_bsh.contact_manifold(foot, given, 0.1, thickness=0.0)
    np.testing.assert_allclose(found.normal, [slope], atol=1e-7)
    turned_over = pcl_bsh.contact_manifold(given, foot, 0.1, thickness=0.0)
    np.testing.assert_allclose(turned_over.normal, [-slope], atol=1e-7)


def test_ids_live_as_long_as_contacts():
    crate, ground = pcl_bsh.Collider(box(), solid=True), pcl_bsh.Collider(floor())
    first = pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(1.125))
    places = {i: tuple(p) for i, p in zip(first.id.tolist(), (first.place_a - [0, 0, 0]).tolist())}
    then = pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(1.0625, 0.01), previous=first)
    assert sorted(then.id.tolist()) == [1, 2, 3, 4]
    for i, place in zip(then.id.tolist(), then.place_a):
        np.testing.assert_allclose(place - places[i], [0.01, 0, -0.0625], atol=1e-12)
    alone = pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(1.0625, 0.01))
    assert alone.id.tolist() == [1, 2, 3, 4]
    away = pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(9.0), previous=then)
    assert len(away) == 0 and away.normal.shape == (0, 3) and away.id.shape == (0,)
    back = pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(1.125), previous=away)
    assert back.id.tolist() == [5, 6, 7, 8]
    strict = pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(1.125, 0.5), previous=first, same_within=0.0)
    assert sorted(strict.id.tolist()) == [1, 2, 3, 4]  # in the crate's frame nothing moved


def test_options_limit_contacts_and_patches():
    corner = pcl_bsh.SphereHierarchy.of_triangles(CORNERS * 10, FACES)  # a room, seen from within
    pose = np.eye(4)
    pose[:3, 3] = [8.9, -8.875, 8.95]
    words = {"margin": 0.25, "height": 0.25, "pose_a": pose}
    found = pcl_bsh.contact_manifold(box(), corner, **words)
    assert set(found.patch) == {0, 1, 2} and len({tuple(np.abs(n).round(6)) for n in found.normal}) == 3
    assert set(pcl_bsh.contact_manifold(box(), corner, most_patches=2, **words).patch) == {0, 1}
    few = pcl_bsh.contact_manifold(box(), corner, most=2, **words)
    assert all((few.patch == p).sum() <= 2 for p in few.patch)
    assert len(pcl_bsh.contact_manifold(box(), corner, most=0, **words)) == 0


def test_a_collider_follows_its_cloud():
    dots = np.array([[0.0, 0, 0.1], [1, 0, 0.1], [0, 1, 0.1]])
    cloud, ground = pcl_bsh.SphereHierarchy(dots, copy=True), pcl_bsh.Collider(floor())
    feet = pcl_bsh.Collider(cloud)
    assert pcl_bsh.contact_manifold(feet, ground, 0.2, thickness=0.0).distance.tolist() == [0.1] * 3
    cloud.refit(dots + [0, 0, 0.05])
    np.testing.assert_allclose(pcl_bsh.contact_manifold(feet, ground, 0.2, thickness=0.0).distance, 0.15)
    mesh = box()
    crate = pcl_bsh.Collider(mesh, solid=True)
    mesh.refit(CORNERS * [1, 1, 2])
    assert pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(2.125)).distance.tolist() == [0.125] * 4
    torn = CORNERS.copy()
    torn[0] = np.nan
    mesh.refit(torn)
    with pytest.raises(ValueError, match="edges are open"):
        pcl_bsh.contact_manifold(crate, ground, 0.25, pose_a=lifted(2.125))


def test_partings_are_depths_of_a_box():
    tank = pcl_bsh.Collider(box(), solid=True)
    for depth, dot in ((0.25, [0.25, 0, 0.75]), (0.5, [0, -0.5, 0.1])):
        dot = pcl_bsh.Collider(pcl_bsh.SphereHierarchy(np.array([dot])))
        found = pcl_bsh.contact_manifold(dot, tank)
        lower, upper = pcl_bsh.parting(dot, tank, found, tolerance=1e-4, most=5)
        assert depth - 1e-4 <= lower <= depth <= upper <= depth + 2e-4
        assert pcl_bsh.parting(dot, tank, found, 0, tolerance=1e-4, most=0.1)[1] == np.inf
    with pytest.raises(IndexError, match="contact: 1 is not among the manifold's 1 contact"):
        pcl_bsh.parting(dot, tank, found, 1, tolerance=1e-4, most=5)
    for words in ({"tolerance": 0.0, "most": 5}, {"tolerance": 1e-4, "most": np.inf}):
        with pytest.raises(ValueError, match="give a finite length above 0"):
            pcl_bsh.parting(dot, tank, found, **words)
    with pytest.raises(ValueError, match="neither is a solid"):
        pcl_bsh.parting(dot, pcl_bsh.Collider(box()), found, tolerance=1e-4, most=5)


def test_wrong_manifolds_are_refused():
    cloud, mesh = pcl_bsh.SphereHierarchy(np.zeros((3, 3))), box()
    for name in ("margin", "thickness", "height", "fit", "same_within"):
        for wrong in (-1.0, np.nan, np.inf, *([0.0] if name == "fit" else [])):
            with pytest.raises(ValueError, match="give a finite length"):
                pcl_bsh.contact_manifold(cloud, mesh, **{name: wrong})
    with pytest.raises(ValueError, match="pose_a: has a last row other than 0 0 0 1"):
        pcl_bsh.contact_manifold(cloud, mesh, pose_a=2 * np.eye(4))
    for wrong in (3, None, np.zeros((3, 3))):
        with pytest.raises(TypeError, match="b: give a Collider or a SphereHierarchy"):
            pcl_bsh.contact_manifold(cloud, wrong)
    with pytest.raises(TypeError):
        pcl_bsh.contact_manifold(cloud, mesh, most=-1)
    with pytest.raises(pcl_bsh.Cancelled):
        pcl_bsh.contact_manifold(cloud, mesh, 2.0, progress=lambda done: False)
    with pytest.raises(ValueError, match="solid: the cloud has no faces"):
        pcl_bsh.Collider(cloud, solid=True)
    with pytest.raises(ValueError, match="solid: 3 edges are open, the first from .* in triangle"):
        pcl_bsh.Collider(pcl_bsh.SphereHierarchy.of_triangles(CORNERS, FACES[:-1]), solid=True)
    for normals, wrong in ((np.ones((2, 3)), "normals: are 2: give one for each record"),
                           (np.ones((3, 2)), "normals: have shape"),
                           ([[0, 0, 1], [0, 0, 0], [0, 0, 1]], "normals: row 1 has no direction"),
                           ([[0, 0, 1], [0, 0, 1], [0, 0, np.nan]], "normals: row 2 has no direction")):
        with pytest.raises(ValueError, match=wrong):
            pcl_bsh.Collider(cloud, normals=normals)
    with pytest.raises(ValueError, match="normals: are those of points"):
        pcl_bsh.Collider(mesh, normals=np.ones((12, 3)))


def of_samples(inside, low, high, n=60):
    """Mass, centre and inertia of a body by cubes."""
    edges = [np.linspace(low[k], high[k], n + 1) for k in range(3)]
    middles = np.stack(np.meshgrid(*[(e[1:] + e[:-1]) / 2 for e in edges], indexing="ij"), axis=-1).reshape(-1, 3)
    middles = middles[inside(middles)]
    cube = np.prod((np.asarray(high, float) - low) / n)
    center = middles.mean(axis=0)
    r = middles - center
    return len(middles) * cube, center, cube * ((r ** 2).sum() * np.eye(3) - r.T @ r)


def test_masses_of_a_box_are_those_of_its_formula():
    for shift in ([0, 0, 0], [1e6, -3e5, 7]):
        corners = CORNERS * [1, 1.5, 2] + shift
        of = pcl_bsh.mass_properties(pcl_bsh.SphereHierarchy.of_triangles(corners, FACES), density=2.0)
        assert of.mass == 48 and of.center.tolist() == shift
        np.testing.assert_array_equal(of.inertia, np.diag([4 * (9 + 16), 4 * (4 + 16), 4 * (4 + 9)]))
    light = of.with_mass(12.0)
    assert light.mass == 12 and (light.inertia == of.inertia / 4).all() and light.center.tolist() == shift
    assert repr(of) == "MassProperties(mass=48.0)" and not of.inertia.flags.writeable


def test_masses_of_turned_bodies_are_those_of_samples():
    pose = turned(5)
    corners = (CORNERS * [0.5, 0.8, 1.1]) @ pose[:3, :3].T + pose[:3, 3]
    of = pcl_bsh.mass_properties(pcl_bsh.SphereHierarchy.of_triangles(corners, FACES[:, ::-1]), density=3.0)
    mass, center, inertia = of_samples(
        lambda p: (np.abs((p - pose[:3, 3]) @ pose[:3, :3]) <= [0.5, 0.8, 1.1]).all(axis=1), corners.min(axis=0),
        corners.max(axis=0))
    assert of.mass == pytest.approx(3 * mass, rel=0.02)
    np.testing.assert_allclose(of.center, center, atol=0.01)
    np.testing.assert_allclose(of.inertia, 3 * inertia, atol=0.05 * np.abs(of.inertia).max())


def test_masses_of_balls_are_their_sum():
    rng = np.random.default_rng(4)
    centers, radii = rng.random((30, 3)), rng.random(30).astype(np.float32)
    centers[3] = np.nan
    of = pcl_bsh.mass_properties(pcl_bsh.SphereHierarchy(centers, radii=radii), 1.5)
    keep = np.arange(30) != 3
    m = 1.5 * 4 / 3 * np.pi * radii[keep].astype(float) ** 3
    center = m @ centers[keep] / m.sum()
    r = centers[keep] - center
    inertia = sum(m[i] * ((r[i] @ r[i] + 0.4 * float(radii[keep][i]) ** 2) * np.eye(3) - np.outer(r[i], r[i]))
                  for i in range(29))
    assert of.mass == pytest.approx(m.sum(), rel=1e-14)
    np.testing.assert_allclose(of.center, center, rtol=1e-13)
    np.testing.assert_allclose(of.inertia, inertia, rtol=1e-12, atol=1e-13)


def test_wrong_masses_are_refused():
    with pytest.raises(ValueError, match="solid: 3 edges are open, the first from .* in triangle .*: close the mesh"):
        pcl_bsh.mass_properties(pcl_bsh.SphereHierarchy.of_triangles(CORNERS, FACES[:-1]))
    with pytest.raises(ValueError, match="balls: none has a radius above 0"):
        pcl_bsh.mass_properties(pcl_bsh.SphereHierarchy(np.zeros((3, 3))))
    for density in (0.0, -1.0, np.nan, np.inf):
        for cloud in (box(), pcl_bsh.SphereHierarchy(np.zeros((1, 3)), radii=np.ones(1, np.float32))):
            with pytest.raises(ValueError, match="density: .*: give a finite one above 0"):
                pcl_bsh.mass_properties(cloud, density)
    flat = pcl_bsh.SphereHierarchy.of_triangles(CORNERS[:3], [[0, 1, 2], [0, 2, 1]])
    with pytest.raises(ValueError, match="its volume is 0"):
        pcl_bsh.mass_properties(flat)
    with pytest.raises(TypeError):
        pcl_bsh.mass_properties(CORNERS)
