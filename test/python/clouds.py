# SPDX-License-Identifier: BSD-3-Clause
"""Clouds to test with, and the answers of NumPy's brute force."""

import numpy as np

KINDS = ("random", "float32", "lattice", "line", "one_place", "holes", "far", "one", "empty")


def cloud(kind, seed=0, n=150):
    """(n, 3) coordinates. The kinds lattice, line and one_place have many ties, which float64 decides exactly."""
    rng = np.random.default_rng(seed)
    if kind == "random":
        return rng.random((n, 3))
    if kind == "float32":
        return rng.random((n, 3)).astype(np.float32)
    if kind == "lattice":
        return rng.integers(0, 5, (n, 3)).astype(np.float64)
    if kind == "line":
        xyz = np.zeros((n, 3))
        xyz[:, 0] = rng.integers(0, 20, n)
        return xyz
    if kind == "one_place":
        return np.full((n, 3), float(seed % 3))
    if kind == "holes":
        xyz = rng.random((n, 3))
        xyz[rng.integers(0, n, n // 4), rng.integers(0, 3, n // 4)] = rng.choice([np.nan, np.inf, -np.inf], n // 4)
        return xyz
    if kind == "far":
        return rng.random((n, 3)) + [500000.0, 5400000.0, 300.0]
    return rng.random((1 if kind == "one" else 0, 3))


def rigid(seed, step=0.3):
    """A pose; of seed 0 the identity, of others a quarter turn and a shift that float64 holds exactly."""
    pose = np.eye(4)
    if seed:
        pose[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        pose[:3, 3] = [seed, -0.5 * seed, 0.25]
    return pose


def turned(seed):
    """Any rigid pose."""
    rng = np.random.default_rng(seed)
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    if np.linalg.det(q) < 0:
        q[:, 0] = -q[:, 0]
    pose = np.eye(4)
    pose[:3, :3] = q
    pose[:3, 3] = rng.random(3)
    return pose


def moved(xyz, pose):
    with np.errstate(invalid="ignore"):
        return np.asarray(xyz, np.float64) @ pose[:3, :3].T + pose[:3, 3]


def distances(a, b, pose_a=np.eye(4), pose_b=np.eye(4)):
    """(n, m) distances; inf where a point is not finite."""
    with np.errstate(invalid="ignore", over="ignore"):
        d = np.linalg.norm(moved(a, pose_a)[:, None, :] - moved(b, pose_b)[None, :, :], axis=2)
    d[~np.isfinite(np.asarray(a, np.float64)).all(axis=1)] = np.inf
    d[:, ~np.isfinite(np.asarray(b, np.float64)).all(axis=1)] = np.inf
    return d
