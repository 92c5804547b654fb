# SPDX-License-Identifier: BSD-3-Clause
"""Neighbours, clusters, spacings and surfaces against brute force."""

import numpy as np
import pytest

import pcl_bsh
from clouds import KINDS, cloud, distances


def neighbors_of(d, most):
    """Sorts a row of distances: indices by distance, then by row."""
    order = np.lexsort((np.arange(len(d)), d))
    return order[np.isfinite(d[order])][:most]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_neighbors(kind, dtype):
    xyz = cloud(kind, 1)
    queries = (cloud(kind if kind != "one_place" else "lattice", 3, 30)).astype(dtype)
    if len(queries) > 3:
        queries[2, 1] = np.nan
    d = distances(queries, xyz)
    A = pcl_bsh.SphereHierarchy(xyz)
    radius = 1.0 if kind in ("lattice", "line", "one_place") else 0.3
    ties_are_exact = kind in ("lattice", "line", "one_place", "one", "empty")

    found = pcl_bsh.radius_search(A, queries, radius)
    assert len(found) == len(queries) and found.offsets.shape == (len(queries) + 1,)
    for i in range(len(queries)):
        indices, squared = found[i]
        row = np.where(d[i] <= radius, d[i], np.inf)
        if ties_are_exact:
            np.testing.assert_array_equal(indices, neighbors_of(row, None))
        assert set(indices.tolist()) == set(np.flatnonzero(row <= radius).tolist())
        np.testing.assert_allclose(squared, d[i][indices] ** 2, rtol=1e-5, atol=1e-12)
        assert (np.diff(squared) >= 0).all()
    flat = np.concatenate([found[i][0] for i in range(len(queries))] or [np.zeros(0, np.int32)])
    np.testing.assert_array_equal(found.indices, flat)
    np.testing.assert_array_equal(pcl_bsh.any_in_radius(A, queries, radius), np.diff(found.offsets) > 0)

    for k in (0, 1, 7, 1000):
        nearest = pcl_bsh.nearest_k_search(A, queries, k, threads=2)
        for i in range(len(queries)):
            indices, squared = nearest[i]
            expected = neighbors_of(d[i], k)
            assert len(indices) == len(expected)
            np.testing.assert_allclose(d[i][indices], d[i][expected], rtol=1e-9, atol=1e-9)
            if ties_are_exact:
                np.testing.assert_array_equal(indices, expected)

    few = pcl_bsh.radius_search(A, queries, radius, most=3)
    unsorted = pcl_bsh.radius_search(A, queries, radius, sorted=False)
    for i in range(len(queries)):
        np.testing.assert_array_equal(few[i][0], found[i][0][:3])
        assert sorted(unsorted[i][0].tolist()) == sorted(found[i][0].tolist())
        if dtype == np.float64:
            np.testing.assert_array_equal(pcl_bsh.radius_search(A, queries[i], radius)[0], found[i][0])
            assert pcl_bsh.any_in_radius(A, queries[i], radius) is bool(len(found[i][0]))
    with pytest.raises(IndexError):
        found[len(queries)]
    if len(queries):
        np.testing.assert_array_equal(found[-1][0], found[len(queries) - 1][0])


@pytest.mark.parametrize("kind", KINDS)
def test_box(kind):
    xyz = cloud(kind, 1)
    low, high = (np.array([1.0, 1, 0]), np.array([3.0, 2, 4])) if kind == "lattice" else (np.zeros(3), np.full(3, 0.5))
    with np.errstate(invalid="ignore"):
        inside = ((xyz >= low) & (xyz <= high)).all(axis=1)
    A = pcl_bsh.SphereHierarchy(xyz)
    np.testing.assert_array_equal(pcl_bsh.box_search(A, low, high), np.flatnonzero(inside))
    every = pcl_bsh.box_search(A, [-np.inf] * 3, [np.inf] * 3)
    np.testing.assert_array_equal(every, np.flatnonzero(np.isfinite(xyz).all(axis=1)))


def clusters_of(xyz, distance):
    finite = np.isfinite(np.asarray(xyz, float)).all(axis=1)
    near = distances(xyz, xyz) <= distance
    of = np.full(len(xyz), -1)
    count = 0
    for first in range(len(xyz)):
        if of[first] != -1 or not finite[first]:
            continue
        stack = [first]
        while stack:
            i = stack.pop()
            if of[i] == -1:
                of[i] = count
                stack.extend(np.flatnonzero(near[i] & (of == -1)).tolist())
        count += 1
    return of


@pytest.mark.parametrize("kind", KINDS)
def test_clusters(kind):
    xyz = cloud(kind, 1)
    for distance in (0.0, 0.12, 1.0):
        found = pcl_bsh.euclidean_clusters(pcl_bsh.SphereHierarchy(xyz), distance)
        expected = clusters_of(xyz, distance)
        np.testing.assert_array_equal(found.of, expected)
        np.testing.assert_array_equal(found.sizes, np.bincount(expected[expected >= 0]))
        assert len(found) == len(found.sizes)


@pytest.mark.parametrize("kind", KINDS)
def test_spacing(kind):
    xyz = cloud(kind, 1)
    d = distances(xyz, xyz)
    d[d == 0] = np.inf
    nearest = d.min(axis=1, initial=np.inf)[np.isfinite(np.asarray(xyz, float)).all(axis=1)]
    nearest = np.sort(nearest[np.isfinite(nearest)])
    found = pcl_bsh.spacing_of(pcl_bsh.SphereHierarchy(xyz))
    assert set(found) == {"samples", "median", "wide"}
    if len(nearest):
        assert nearest[0] * (1 - 1e-9) <= found["median"] <= found["wide"] <= nearest[-1] * (1 + 1e-9)
    else:
        assert found["median"] == 0


def distance_from_triangle(p, t):
    """By sampling: never less than the true distance, and at most `step` more."""
    u, v = np.meshgrid(np.linspace(0, 1, 80), np.linspace(0, 1, 80))
    keep = u + v <= 1
    on = t[0] + u[keep][:, None] * (t[1] - t[0]) + v[keep][:, None] * (t[2] - t[0])
    return np.linalg.norm(on[None] - p[:, None], axis=2).min(axis=1)


def test_surface():
    rng = np.random.default_rng(6)
    vertices = rng.random((6, 3))
    triangles = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    scan = rng.random((300, 3)) * 2 - 0.5
    mesh = pcl_bsh.SphereHierarchy.of_triangles(vertices, triangles)
    assert repr(mesh) == "SphereHierarchy(2 triangles, float64)" and len(mesh) == mesh.records == 2
    assert mesh.array is vertices and mesh.in_place and not vertices.flags.writeable
    surface = np.minimum(*(distance_from_triangle(scan, vertices[t]) for t in triangles))
    S = pcl_bsh.SphereHierarchy(scan)
    flags = pcl_bsh.collision_flags(S, mesh, 0.1)
    step = 0.03  # of the samples
    assert flags[surface <= 0.1].all() and not flags[surface > 0.1 + step].any()
    assert flags.any() and not flags.all()
    far = vertices + 10
    mesh.refit(far)
    assert mesh.array is far and vertices.flags.writeable
    assert not pcl_bsh.collision_flags(S, mesh, 0.1).any()
    with pytest.raises(ValueError, match="radii: are those of points"):
        mesh.refit(vertices, radii=np.zeros(6, np.float32))
    floats = pcl_bsh.SphereHierarchy.of_triangles(vertices.astype(np.float32), triangles.tolist())
    assert repr(floats) == "SphereHierarchy(2 triangles, float32)"
