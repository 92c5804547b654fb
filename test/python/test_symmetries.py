# SPDX-License-Identifier: BSD-3-Clause
"""Changes that must not change an answer: axes, powers of two, orders, halves, doubled points, exact turns."""

import json
import pathlib

import numpy as np
import pytest

import pcl_bsh

HARD_CASES = pathlib.Path(__file__).resolve().parents[1] / "hard_cases"
TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


def places(rng, tied):
    """Up to 80 points within a few units; tied: multiples of 1/8."""
    n = int(rng.integers(2, 80))
    return rng.integers(0, 17, (n, 3)) / 8.0 if tied else rng.random((n, 3)) * 2


def pose_of(turn, shift):
    pose = np.eye(4)
    pose[:3, :3] = turn
    pose[:3, 3] = shift
    return pose


def turned(places, axes):
    """By signed axes; of places that are not finite, too."""
    return np.stack([places[:, np.argmax(np.abs(axis))] * axis[np.argmax(np.abs(axis))] for axis in axes.T], 1)


def answers(a, b, pose, clearance, triangles):
    """By name; those of single points are arrays over a's points, or b's."""
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    surface = pcl_bsh.SphereHierarchy.of_triangles(b, triangles)
    both = pcl_bsh.symmetric_distances(A, B, pose_b=pose)
    run = pcl_bsh.collide_along(A, B, [pose, np.eye(4)], clearance, distances=True)
    return {
        "a": {
            "flags": pcl_bsh.collision_flags(A, B, clearance, pose_b=pose),
            "distance": both.a.distance,
            "path": run.flags,
            "path_distance": run.distance,
            "surface": pcl_bsh.collision_flags(A, surface, clearance, pose_b=pose),
            "surface_distance": pcl_bsh.point_distances(A, surface, pose_b=pose).distance,
        },
        "b": {"flags": pcl_bsh.collision_flags(B, A, clearance, pose_a=pose), "distance": both.b.distance},
        "all": {
            "any": bool(pcl_bsh.any_collision(A, B, clearance, pose_b=pose)),
            "closest": pcl_bsh.closest_pair(A, B, pose_b=pose).distance,
            "hausdorff": both.hausdorff,
        },
    }


LENGTHS = ("distance", "path_distance", "surface_distance", "closest", "hausdorff")


def expect_same(found, expected, from_a=slice(None), from_b=slice(None), scale=1.0):
    """@param from_a, from_b: the old record of each new one"""
    for kind, records in (("a", from_a), ("b", from_b), ("all", Ellipsis)):
        for name, old in expected[kind].items():
            old = np.asarray(old)[records] * (scale if name in LENGTHS else 1)
            np.testing.assert_array_equal(found[kind][name], old, err_msg=f"{kind} {name}")


def exactly(places, scale):
    """The places times a power of two; None where they leave the range in which that and squares are exact."""
    sizes = np.abs(places[np.isfinite(places) & (places != 0)])
    least, most = (1e-30, 1e30) if places.dtype == np.float32 else (1e-140, 1e140)
    return None if np.any((sizes < least) | (sizes > most)) else places * places.dtype.type(scale)


def expect_no_change(rng, a, b, pose, clearance):
    """@param rng chooses which axes, scales, orders and triangles of b"""
    triangles = rng.integers(0, len(b), (12, 3)).astype(np.uint32)
    expected = answers(a, b, pose, clearance, triangles)

    axes = np.eye(3)[rng.permutation(3)] * rng.choice([-1.0, 1.0], 3)
    conjugated = pose_of(axes @ pose[:3, :3] @ axes.T, axes @ pose[:3, 3])
    of_floats = axes.T.astype(a.dtype)
    expect_same(answers(turned(a, of_floats), turned(b, of_floats), conjugated, clearance, triangles), expected)

    scale = 2.0 ** int(rng.integers(-30, 30))
    scaled_a, scaled_b, shift = exactly(a, scale), exactly(b, scale), exactly(pose[:3, 3], scale)
    if scaled_a is not None and scaled_b is not None and shift is not None:
        scaled = answers(scaled_a, scaled_b, pose_of(pose[:3, :3], shift), clearance * scale, triangles)
        expect_same(scaled, expected, scale=scale)

    of_a, of_b = rng.permutation(len(a)), rng.permutation(len(b))
    renamed = np.argsort(of_b)[triangles].astype(np.uint32)
    expect_same(answers(a[of_a], b[of_b], pose, clearance, renamed), expected, of_a, of_b)

    twice_a, twice_b = np.tile(np.arange(len(a)), 2), np.tile(np.arange(len(b)), 2)
    expect_same(answers(a[twice_a], b[twice_b], pose, clearance, triangles), expected, twice_a, twice_b)

    # Strided, reversed, and in Fortran's order, as NumPy has it.
    wide = np.zeros((len(a), 5), a.dtype)
    wide[:, 1:4] = a
    expect_same(answers(wide[:, 1:4], np.asfortranarray(b), pose, clearance, triangles), expected)
    backward = np.arange(len(a))[::-1]
    expect_same(answers(a[::-1], b, pose, clearance, triangles), expected, backward)

    if len(a) < 2:
        return
    halves = [answers(a[first::2], b, pose, clearance, triangles) for first in (0, 1)]
    for name, old in expected["a"].items():
        for first in (0, 1):
            np.testing.assert_array_equal(halves[first]["a"][name], np.asarray(old)[first::2], err_msg=name)
    assert expected["all"]["any"] == (halves[0]["all"]["any"] or halves[1]["all"]["any"])
    assert expected["all"]["closest"] == min(half["all"]["closest"] for half in halves)
    np.testing.assert_array_equal(np.minimum(halves[0]["b"]["distance"], halves[1]["b"]["distance"]),
                                  expected["b"]["distance"])


@pytest.mark.filterwarnings("ignore:.*belong to no face")
@pytest.mark.parametrize("seed", range(24))
def test_what_must_not_change_an_answer(seed):
    rng = np.random.default_rng(seed)
    tied = seed % 2 == 0
    a, b = places(rng, tied), places(rng, tied)
    pose = pose_of(TURN if tied else np.eye(3), [1.0, 0.25, -0.5])
    expect_no_change(rng, a, b, pose, float(rng.integers(0, 5)) / 8)


def small_hard_cases():
    for case in json.loads((HARD_CASES / "cases.json").read_text())["cases"]:
        read = (pcl_bsh.read(HARD_CASES / case[side]) for side in "ab")
        a, b = (np.stack([cloud[axis] for axis in "xyz"], 1) for cloud in read)
        if 0 < len(a) * len(b) <= 40000:
            yield pytest.param(case, a, b, id=case["name"])


@pytest.mark.filterwarnings("ignore:.*belong to no face")
@pytest.mark.parametrize("case, a, b", small_hard_cases())
def test_what_must_not_change_an_answer_of_a_hard_case(case, a, b):
    pose = np.eye(4)
    pose[:3] = np.reshape(case.get("pose", np.eye(4)[:3]), (3, 4))
    expect_no_change(np.random.default_rng(len(a)), a, b, pose, case["clearance"])
