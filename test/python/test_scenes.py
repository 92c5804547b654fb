# SPDX-License-Identifier: BSD-3-Clause
"""Scenes against the queries of pairs."""

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud, distances, turned


def test_effects_are_those_of_the_pairs():
    clouds = [cloud("random", k, 80) for k in range(5)]
    poses = [turned(k) * 1.0 for k in range(5)]
    for k, pose in enumerate(poses):
        pose[:3, 3] += [0.8 * k, 0, 0]
    scene = pcl_bsh.Scene(clearance=0.1, any=True, flags=True, distance=np.inf, contacts=3)
    hierarchies = [pcl_bsh.SphereHierarchy(xyz) for xyz in clouds]
    for k in range(5):
        assert scene.add(f"cloud {k}", hierarchies[k], poses[k]) == k
    result = scene.query()
    colliding, flags = set(), [np.zeros(80, bool) for _ in range(5)]
    for i in range(5):
        for j in range(i + 1, 5):
            d = distances(clouds[i], clouds[j], poses[i], poses[j])
            if (d <= 0.1).any():
                colliding.add((i, j))
            flags[i] |= (d <= 0.1).any(axis=1)
            flags[j] |= (d <= 0.1).any(axis=0)
            found = [pair for pair in result.distance if (pair["a"], pair["b"]) == (i, j)]
            assert found[0]["distance"] == pytest.approx(d.min(), rel=1e-9) and d[found[0]["pair"]] == pytest.approx(d.min())
            contacts = [pair for pair in result.contacts if (pair["a"], pair["b"]) == (i, j)]
            expected = np.sort(d[d <= 0.1])[:3]
            np.testing.assert_allclose([c["distance"] for c in contacts[0]["contacts"]] if contacts else [], expected)
    assert {(pair["a"], pair["b"]) for pair in result.any} == colliding and 0 < len(colliding) < 10
    listed = {part["object"]: part["flags"] for part in result.flags}
    for k in range(5):
        np.testing.assert_array_equal(listed.get(k, np.zeros(80)), flags[k])
    assert "colliding pairs" in repr(result) and repr(scene) == "Scene(5 objects)"
    assert not result.first_contact and not result.swept and not result.outcomes and not result.undecided


def test_motions_responses_and_rules():
    point = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    wall = pcl_bsh.SphereHierarchy(np.array([[0.0, y, z] for y in np.arange(-1, 1, 0.05) for z in np.arange(-1, 1, 0.05)]))
    at = np.eye(4)
    at[0, 3] = 5
    scene = pcl_bsh.Scene(clearance=0.1, response="stop", first_contact=False, tolerance=1e-3)
    scene.add("wall", wall, at, fixed=True, group="walls")
    ball = scene.add("ball", point, motion=pcl_bsh.VelocityMotion([2, 0, 0], [0, 0, 1]), group="balls")
    outcome = scene.step(4.0).outcomes[0]
    assert outcome["touched"] and outcome["against"] == 0 and 4.9 - 2e-3 <= outcome["travelled"] <= 4.9
    assert scene.time == 4.0 and len(scene) == 2 and scene.find("ball") == ball and scene.find("none") is None
    scene.set_group_rule("walls", "balls", tested=False)
    scene.set_motion("ball", pcl_bsh.VelocityMotion([2, 0, 0]))
    assert not scene.step(1.0).outcomes[0]["touched"] and scene.pose(ball)[0, 3] == pytest.approx(6.9, abs=2e-3)
    scene.set_rule("wall", "ball", tested=True, clearance=0.3)
    scene.set_pose("ball", np.eye(4))
    assert scene.step(4.0).outcomes[0]["travelled"] == pytest.approx(4.7, abs=2e-3)

    circle = pcl_bsh.Scene(first_contact=True, swept=True, any=True)
    circle.add("post", point, at, fixed=True)
    circle.add("arm", point, at @ np.diag([1.0, 1, 1, 1]) - np.diag([0, 0, 0, 0]),
               motion=pcl_bsh.CircularMotion([0, 0, 0], [0, 0, 1], np.pi, turning=False))
    circle.query()
    assert circle.step(1.0).any == [] and circle.pose("arm")[0, 3] == pytest.approx(-5)
    there = np.eye(4)
    there[0, 3] = 10
    way = pcl_bsh.Scene(first_contact=True, swept=True)
    way.add("post", point, at, fixed=True)
    way.add("cart", point, motion=pcl_bsh.WaypointMotion([0, 1], [np.eye(4), there]))
    way.query()
    result = way.step(1.0)
    assert result.first_contact[0]["fraction"] == pytest.approx(0.5, abs=1e-3)
    assert [part["object"] for part in result.swept] == [0, 1]


def test_parts():
    point = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    near = np.eye(4)
    near[0, 3] = 0.05
    scene = pcl_bsh.Scene(clearance=0.1, self_collisions=True)
    scene.add("arm", [("upper", point), ("lower", point, near), ("hand", point, near)], adjacent=[(0, 1)])
    assert [(s["part_a"], s["part_b"]) for s in scene.query().self_collisions] == [(0, 2), (1, 2)]
    far = np.eye(4)
    far[0, 3] = 3
    scene.set_part_pose("arm", 2, far)
    assert scene.query().self_collisions == []


def test_what_was_swept_and_what_was_not():
    """A dart with a nose that is certain and a tail that is not; it meets a post at 0.475 of its way."""
    point = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    tail = pcl_bsh.SphereHierarchy(np.zeros((1, 3)), uncertainty=0.005)
    at, behind = np.eye(4), np.eye(4)
    at[0, 3], behind[0, 3] = 1, -0.5
    scene = pcl_bsh.Scene(first_contact=True, swept=True, clearance=0.05, deform=1.5)
    scene.add("post", point, at, fixed=True)
    dart = scene.add("dart", [("nose", point), ("tail", tail, behind)], motion=pcl_bsh.VelocityMotion([2, 0, 0]))
    result = scene.step(1.0)
    for contact in result.first_contact[0], result.certain_contact[0]:
        assert contact["fraction"] == pytest.approx(0.475, abs=1e-4) and contact["part_b"] == 0
    (motion,) = result.swept_motions
    assert motion["object"] == dart and motion["part"] is None and result.unswept == []
    np.testing.assert_array_equal(motion["leg"]["from"], np.eye(4))
    np.testing.assert_array_equal(motion["leg"]["to"], scene.pose("dart"))
    assert motion["leg"]["turn"] == (0, 0, 0) and len(motion["leg"]["center"]) == 3

    scene.deform("dart", np.full((1, 3), 0.01), 1)
    scene.set_part_pose("dart", 0, behind)
    scene.add("late", point, at * 1.0)
    result = scene.query()
    assert [(m["object"], m["part"]) for m in result.swept_motions] == [(dart, None), (dart, 0)]
    assert result.unswept == [
        {"object": dart, "added": False, "reshaped": True, "detoured": False},
        {"object": 2, "added": True, "reshaped": False, "detoured": False},
    ]


def test_outcomes_have_their_legs():
    point = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    scene = pcl_bsh.Scene(response="stop")
    scene.add("ball", point, motion=pcl_bsh.VelocityMotion([2, 0, 0]))
    (outcome,) = scene.step(0.5).outcomes
    assert outcome["legs"][0]["to"][0, 3] == 1.0 and outcome["travelled"] == 1.0


def test_gravity():
    x, y = np.meshgrid(np.arange(-1, 3, 0.05), np.arange(-1, 1, 0.05))
    floor = pcl_bsh.SphereHierarchy(np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1))
    scene = pcl_bsh.Scene(clearance=0.05, response="slide", gravity=0.5, down=[0, 0, -2])
    scene.add("floor", floor, fixed=True)
    high = np.eye(4)
    high[2, 3] = 0.3
    scene.add("box", pcl_bsh.SphereHierarchy(np.zeros((1, 3))), high, motion=pcl_bsh.VelocityMotion([1, 0, 0]))
    assert scene.step(1.0).outcomes[0]["grounded"] and scene.pose("box")[2, 3] <= 0.05 + 2e-4


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda s, p: pcl_bsh.Scene(response="jump"), "response: `jump` is none"),
        (lambda s, p: pcl_bsh.Scene(clearance=-1), "clearance"),
        (lambda s, p: s.add("", p), "name"),
        (lambda s, p: s.add("a", p), "a"),
        (lambda s, p: s.add("c", []), "part"),
        (lambda s, p: s.add("c", [("x",)]), "1 value"),
        (lambda s, p: s.pose("b"), "there is no object `b`"),
        (lambda s, p: s.pose(7), "there is no object 7"),
        (lambda s, p: s.set_part_pose("a", 1, np.eye(4)), "there is no part 1"),
        (lambda s, p: s.set_pose("a", np.eye(4) * 3), "pose"),
        (lambda s, p: s.set_motion("a", pcl_bsh.WaypointMotion([1, 0], [np.eye(4)] * 2)), "ascend|time"),
        (lambda s, p: s.step(-1.0), "step|dt|-1"),
    ],
)
def test_what_is_wrong_is_said(call, words):
    point = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
    scene = pcl_bsh.Scene()
    scene.add("a", point)
    with pytest.raises(ValueError, match=words) as error:
        call(scene, point)
    assert "\n" not in str(error.value)
