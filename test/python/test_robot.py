# SPDX-License-Identifier: BSD-3-Clause
"""Robots with joints among clouds, against brute force over balls and points."""

import threading
import warnings

import numpy as np
import pytest

import pcl_bsh
from arms import BALLS, ball_gaps, gap_to_itself, gap_to_points, link_poses, pose_of, states, turned_about, write_arm
from test_threads import interrupted

if not hasattr(pcl_bsh, "Robot"):
    pytest.skip("this package reads no URDF: install liburdfdom-dev and build it", allow_module_level=True)

FREE, COLLIDING, UNDECIDED = (int(pcl_bsh.Verdict[name]) for name in ("FREE", "COLLIDING", "UNDECIDED"))


@pytest.fixture
def arm(tmp_path):
    return write_arm(tmp_path)


@pytest.fixture
def points():
    rng = np.random.default_rng(5)
    return rng.uniform(-1, 1, (60, 3)) + [0, 0, 0.5]


def world_of(arm, points, **options):
    return pcl_bsh.RobotWorld(arm, points, **options)


def test_a_robot_is_what_its_files_say(arm, tmp_path):
    assert (arm.name, arm.links) == ("arm", ["base", "mast", "upper", "fore", "hand"])
    assert arm.joints == ["turn", "elbow", "slide"] and repr(arm) == "Robot(arm, 5 links, 3 joints)"
    np.testing.assert_array_equal(arm.limits, [[-np.inf, np.inf], [-2.8, 2.8], [0, 0.2]])
    assert arm.groups == arm.states == {}
    np.testing.assert_array_equal(arm.state({"elbow": 0.5}), [0, 0.5, 0])
    np.testing.assert_array_equal(arm.state(), [0, 0, 0])
    named = pcl_bsh.Robot(str(tmp_path / "arm.urdf"), str(tmp_path / "arm.srdf"))
    np.testing.assert_array_equal(named.groups["reach"], [0, 2])
    np.testing.assert_array_equal(named.states["home"], [0.25, 0, 0.1])
    np.testing.assert_array_equal(named.state({"elbow": 1, "slide": 0.2}, named="home"), [0.25, 1, 0.2])


def test_link_poses_are_those_of_their_formulas(arm):
    q = states(20)
    poses = arm.link_poses(q)
    assert poses.shape == (20, 5, 4, 4)
    for i, state in enumerate(q):
        expected = link_poses(state)
        for link, pose in expected.items():
            np.testing.assert_allclose(poses[i, arm.links.index(link)], pose, atol=1e-14)
        np.testing.assert_array_equal(arm.link_poses(state), poses[i])
    np.testing.assert_array_equal(poses[0, 1], pose_of([0, 0, 0.5]))


@pytest.mark.parametrize("clearance, padding, moved", [(0.0, 0.0, False), (0.05, 0.0, True), (0.02, 0.03, True)])
def test_states_are_those_of_brute_force(tmp_path, points, clearance, padding, moved):
    arm = write_arm(tmp_path, padding=padding)
    base = pose_of([0.1, -0.2, 0.05], turned_about((1, 0, 0), 0.4)) if moved else np.eye(4)
    world = world_of(arm, points, clearance=clearance, with_self=False, base=base)
    q = states(300)
    gaps = np.array([gap_to_points(state, points, padding=padding, base=base) for state in q])
    expected = np.where(gaps <= clearance, COLLIDING, FREE)
    assert 30 < (expected == FREE).sum() < 270 and np.abs(gaps - clearance).min() > 1e-9
    checks = world.check_states(q)
    np.testing.assert_array_equal(checks.verdict, expected)
    np.testing.assert_array_equal(world.is_free(q), expected == FREE)
    np.testing.assert_array_equal(world.is_free(q, threads=2), expected == FREE)
    assert checks.verdict.dtype == np.uint8 and checks.link.dtype == np.int32
    for i, state in enumerate(q):
        assert world.is_free(state) is bool(expected[i] == FREE)
        if expected[i] == FREE:
            assert checks.link[i] == checks.shape[i] == checks.obstacle[i] == checks.record[i] == -1
            continue
        found = {(link, shape): gap for link, shape, gap in ball_gaps(state, points, padding=padding, base=base)}
        assert found[arm.links[checks.link[i]], checks.shape[i]][checks.record[i]] <= clearance
        assert (checks.obstacle[i], checks.other_link[i], checks.other_shape[i]) == (0, -1, -1)


def test_clearances_are_those_of_brute_force(arm, points):
    world = world_of(arm, points, with_self=False)
    q = states(200, 1)
    found = world.clearance(q, threads=2)
    assert found.gap.shape == (200, 2) and len(repr(found)) > 0
    for i, state in enumerate(q):
        gap = gap_to_points(state, points)
        assert found.gap[i, 0] <= gap + 1e-12 and gap - 1e-12 <= found.gap[i, 1] <= found.gap[i, 0] + 1e-6
        near = {(link, shape): to for link, shape, to in ball_gaps(state, points)}
        assert near[arm.links[found.link[i]], found.shape[i]][found.record[i]] == pytest.approx(gap, abs=1e-6)
        one = world.clearance(state)
        assert one.gap.shape == (2,) and one.link.shape == () and (one.gap == found.gap[i]).all()
    limited = world.clearance(q, 0.02)
    far = np.array([gap_to_points(state, points) > 0.02 for state in q])
    assert far.any() and not far.all()
    assert (limited.link[far] == -1).all() and (limited.gap[far, 1] == np.inf).all()
    np.testing.assert_allclose(limited.gap[far, 0], 0.02, atol=1e-6)
    np.testing.assert_allclose(limited.gap[~far], found.gap[~far], atol=1e-6)
    np.testing.assert_array_equal(limited.record[~far], found.record[~far])


def test_a_robot_meets_itself(arm, tmp_path):
    q = states(300, 2)
    gaps = np.array([gap_to_itself(state) for state in q])
    assert 10 < (gaps <= 0.1).sum() < 290
    world = pcl_bsh.RobotWorld(arm, self_clearance=0.1)
    checks = world.check_states(q)
    np.testing.assert_array_equal(checks.verdict, np.where(gaps <= 0.1, COLLIDING, FREE))
    hit = gaps <= 0.1
    assert {*checks.link[hit], *checks.other_link[hit]} == {arm.links.index("upper"), arm.links.index("hand")}
    assert (checks.other_shape[hit] >= 0).all() and (checks.obstacle == -1).all() and (checks.record == -1).all()
    found = world.clearance(q)
    assert (found.gap[:, 0] <= gaps + 1e-12).all() and (found.gap[:, 1] >= gaps - 1e-12).all()
    assert (found.other_link >= 0).all() and (found.obstacle == -1).all()
    apart = pcl_bsh.Robot(tmp_path / "arm.urdf", tmp_path / "arm.srdf")
    assert pcl_bsh.RobotWorld(apart, self_clearance=0.1).is_free(q).all()
    assert pcl_bsh.RobotWorld(arm, self_clearance=0.1, with_self=False).is_free(q).all()


def line(q0, q1, t):
    """States on a motion; the first joint goes the shorter way."""
    way = q1 - q0
    way[0] = np.remainder(way[0] + np.pi, 2 * np.pi) - np.pi
    return q0 + t * way


@pytest.mark.parametrize("clearance", [0.0, 0.03])
def test_motions_are_those_of_samples(arm, points, clearance):
    world = world_of(arm, points, clearance=clearance, with_self=False)
    q0, q1 = states(60, 3), states(60, 4)
    q1 = q0 + 0.15 * (q1 - q0)
    checks = world.check_motions(q0, q1, with_last_valid=True)
    np.testing.assert_array_equal(world.is_motion_free(q0, q1, threads=2), checks.verdict == FREE)
    assert (checks.verdict == FREE).sum() > 5 and (checks.verdict == COLLIDING).sum() > 5
    for i in range(60):
        t = np.linspace(0, 1, 201)
        gaps = np.array([gap_to_points(line(q0[i].copy(), q1[i].copy(), s), points) for s in t])
        assert (gaps[t < checks.last_valid[i]] > clearance - 1e-12).all()
        if checks.verdict[i] == FREE:
            assert (gaps > clearance).all() and checks.fraction[i] == checks.last_valid[i] == 1 and checks.link[i] == -1
        elif checks.verdict[i] == COLLIDING:
            there = line(q0[i].copy(), q1[i].copy(), checks.fraction[i])
            near = {(link, shape): to for link, shape, to in ball_gaps(there, points)}
            assert near[arm.links[checks.link[i]], checks.shape[i]][checks.record[i]] <= clearance + 1e-12
            assert checks.last_valid[i] <= checks.fraction[i]
        one = world.check_motions(q0[i], q1[i], with_last_valid=True)
        assert (one.verdict, one.fraction, one.last_valid) == (checks.verdict[i], checks.fraction[i], checks.last_valid[i])
        assert world.is_motion_free(q0[i], q1[i]) is bool(checks.verdict[i] == FREE)
    behind = world.check_motions(q0, q1)
    np.testing.assert_array_equal(behind.last_valid, np.where(checks.verdict == FREE, 1.0, 0.0))


def test_the_last_valid_fraction_is_where_the_formula_has_it(arm):
    obstacle = np.array([[0.0, 0.3, 0.5]])  # met by the outer ball of the upper arm, of radius 0.09
    world = world_of(arm, obstacle, with_self=False, tolerance=1e-6)
    bent = np.array([0.0, 2.8, 0.0])
    found = world.check_motions(bent, [1.5, 2.8, 0.0], with_last_valid=True)
    meets = np.pi / 2 - 2 * np.arcsin(0.09 / 0.6)
    gap = gap_to_points(np.array([meets, 2.8, 0.0]), obstacle)
    assert abs(gap) < 1e-12 and found.verdict == COLLIDING
    assert found.last_valid * 1.5 == pytest.approx(meets, abs=1e-5) and found.last_valid * 1.5 <= meets


def test_one_state_goes_with_many(arm, points):
    world = world_of(arm, points)
    q = states(10, 6)
    both = world.check_motions(np.tile(q[0], (10, 1)), q)
    np.testing.assert_array_equal(world.check_motions(q[0], q).verdict, both.verdict)
    np.testing.assert_array_equal(world.check_motions(q, q[0]).verdict,
                                  world.check_motions(q, np.tile(q[0], (10, 1))).verdict)
    assert world.is_free(np.zeros((0, 3))).shape == (0,) and world.is_motion_free(q[0], np.zeros((0, 3))).shape == (0,)


def test_what_is_undecided_is_not_free(arm):
    # The ball of radius 0.1 about (0, 0, 0.5) does not move: the point is at 0.25 from it in exact arithmetic, but its
    # pose in doubles might err
    world = world_of(arm, np.array([[-0.35, 0.0, 0.5]]), clearance=0.25, with_self=False)
    q = np.array([0.0, 0.0, 0.0])
    checks = world.check_states(q)
    gap = world.clearance(q).gap
    assert gap[0] <= 0.25 <= gap[1] and checks.verdict == UNDECIDED and checks.verdict.shape == ()
    assert arm.links[checks.link] == "upper" and checks.record == 0
    assert world.is_free(q) is False and world.is_free([q]).tolist() == [False]
    motion = world.check_motions(q, [0.1, 0, 0], with_last_valid=True)
    assert motion.verdict == UNDECIDED and motion.last_valid < 1
    assert world.is_motion_free(q, [0.1, 0, 0]) is False
    assert repr(world.check_states([q])) == "StateChecks(0 free, 0 colliding, 1 undecided)"


def test_obstacles_of_all_kinds(arm, points):
    q = states(100, 7)
    radii = np.full(60, 0.02, np.float32)
    gaps = np.array([gap_to_points(state, points) for state in q])
    balls = pcl_bsh.SphereHierarchy(points, radii=radii)
    np.testing.assert_array_equal(world_of(arm, balls, with_self=False).is_free(q), gaps > radii[0].astype(float))
    floor = pcl_bsh.SphereHierarchy.of_triangles(np.array([[-9.0, -9, 0.3], [9, -9, 0.3], [0, 9, 0.3]]), [[0, 1, 2]])
    heights = np.array([min((pose @ [x, 0, 0, 1])[2] - r for link, pose in link_poses(state).items()
                            for x, r in BALLS[link]) for state in q])
    world = world_of(arm, [floor, points[:30], balls], with_self=False)
    found = world.clearance(q)
    expected = np.minimum.reduce([heights - 0.3, [gap_to_points(state, points[:30]) for state in q], gaps - float(radii[0])])
    above = heights > 0.3
    assert above.sum() > 20
    np.testing.assert_allclose(found.gap[above].mean(axis=1), expected[above], atol=1e-6)
    assert set(found.obstacle[above]) == {0, 2}  # a ball of the third is nearer than its point in the second
    assert len(world.obstacles) == 3 and world.obstacles[0] is floor and world.robot is arm
    assert repr(world) == "RobotWorld(arm, 3 obstacles)"


def test_a_world_follows_its_obstacles(arm, points):
    q = states(200, 8)
    cloud = pcl_bsh.SphereHierarchy(points)
    world = world_of(arm, cloud, with_self=False)
    first = world.is_free(q)
    now = points + [0.3, -0.1, 0.2]
    expected = np.array([gap_to_points(state, now) > 0 for state in q])
    assert (expected != first).any()
    cloud.refit(now)
    np.testing.assert_array_equal(world.is_free(q), expected)
    np.testing.assert_allclose(world.clearance(q).gap[:, 0], [gap_to_points(state, now) for state in q], atol=1e-6)
    world.set_obstacles(points)
    np.testing.assert_array_equal(world.is_free(q), first)
    base = pose_of([0, 0, -0.3], turned_about((0, 0, 1), 0.5))
    world.set_base(base)
    np.testing.assert_allclose(world.base, base, atol=1e-15)
    np.testing.assert_array_equal(world.is_free(q), [gap_to_points(state, points, base=base) > 0 for state in q])
    world.set_obstacles([])
    assert world.is_free(q).all() and (world.clearance(q).gap == np.inf).all()


def test_uncertain_places_and_values(arm, points):
    q = states(200, 11)
    own = np.random.default_rng(12).uniform(0, 0.05, 60).astype(np.float32)
    cloud = pcl_bsh.SphereHierarchy(points, uncertainties=own)
    world = world_of(arm, cloud, with_self=False)
    checks = world.check_states(q)
    for state, verdict in zip(q, checks.verdict):
        low = min((gap - own).min() for _, _, gap in ball_gaps(state, points))
        high = min((gap + own).min() for _, _, gap in ball_gaps(state, points))
        assert verdict == (FREE if low > 0 else COLLIDING if high <= 0 else UNDECIDED)
    assert np.bincount(checks.verdict, minlength=3).min() > 5
    off = np.array([0.02, 0.01, 0.005])
    unsure = world_of(arm, points, with_self=False, joint_uncertainties=off).check_states(q).verdict
    signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
    for state, verdict in zip(q, unsure):
        gaps = np.array([gap_to_points(state + sign * off, points) for sign in [*signs, np.zeros(3)]])
        assert verdict == UNDECIDED or ((gaps > 0).all() if verdict == FREE else (gaps <= 0).all())
    assert np.bincount(unsure, minlength=3).min() > 5


def test_obstacles_are_moved_and_loads_are_attached(arm, points):
    q = states(200, 13)
    world = world_of(arm, [points[:30], points[30:]], with_self=False)
    pose = pose_of([0.2, -0.1, 0.3], turned_about((0, 0, 1), 0.7))
    world.set_obstacle_poses([np.eye(4), pose])
    moved = np.vstack([points[:30], points[30:] @ pose[:3, :3].T + pose[:3, 3]])
    np.testing.assert_array_equal(world.is_free(q), [gap_to_points(state, moved) > 0 for state in q])
    world.set_obstacle_poses(np.tile(np.eye(4), (2, 1, 1)))
    expected = np.array([gap_to_points(state, points) for state in q])
    np.testing.assert_array_equal(world.is_free(q), expected > 0)
    world.attach("cup", "hand", [pcl_bsh.Shape.sphere(0.2, pose_of([0.1, 0, 0]))], ignored=["fore"])
    assert world.robot.links == [*arm.links, "cup"] and arm.links[-1] == "hand"
    of_cup = np.array([np.linalg.norm(points - (link_poses(state)["hand"] @ [0.1, 0, 0, 1])[:3], axis=1).min() - 0.2
                       for state in q])
    np.testing.assert_array_equal(world.is_free(q), (expected > 0) & (of_cup > 0))
    found = world.check_states(q[(expected > 0) & (of_cup <= 0)])
    assert len(found.link) > 0 and {world.robot.links[link] for link in found.link} == {"cup"}
    world.detach("cup")
    np.testing.assert_array_equal(world.is_free(q), expected > 0)
    for shape in (pcl_bsh.Shape.box((0.3, 0.4, 0.5)), pcl_bsh.Shape.cylinder(0.2, 0.4), pcl_bsh.Shape.capsule(0.2, 0.3)):
        world.attach(repr(shape), "hand", [shape])
        assert world.is_free(q).sum() < (expected > 0).sum()
        world.detach(repr(shape))


def test_meshes_and_packages(tmp_path):
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6),
             (1, 3, 5), (3, 7, 5)]
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    package = tmp_path / "shapes"
    package.mkdir()
    (package / "cube.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) +
                                      "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces))
    text = ('<robot name="block"><link name="root"/><link name="cube"><collision><geometry><mesh filename='
            '"package://shapes/cube.obj" scale="0.5 0.25 0.1"/></geometry></collision></link><joint name="up" type='
            '"prismatic"><parent link="root"/><child link="cube"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" '
            'effort="1" velocity="1"/></joint></robot>')
    file = tmp_path / "block.urdf"
    file.write_text(text)
    block = pcl_bsh.Robot(file, packages={"shapes": package}, padding={"cube": 0.125})
    world = pcl_bsh.RobotWorld(block, np.array([[0.0, 0, 1.0]]))
    found = world.clearance([0.25])
    assert found.gap[0] <= 1 - 0.25 - 0.1 - 0.125 <= found.gap[1] and found.gap[1] - found.gap[0] < 1e-6
    with pytest.raises(OSError, match=r"block.urdf: link 'cube' has a mesh package://shapes/cube.obj: .*ROS_PACKAGE_PATH"):
        pcl_bsh.Robot(file)
    file.write_text(text.replace("cube.obj", "none.obj"))
    with pytest.raises(pcl_bsh.FileError, match="none.obj, which is not there: check the name"):
        pcl_bsh.Robot(file, packages={"shapes": str(package)})
    (package / "none.obj").write_text("v 0 0 0\n")
    with pytest.raises(ValueError, match="none.obj"):
        pcl_bsh.Robot(file, packages={"shapes": str(package)})


def test_wrong_files_are_refused(arm, tmp_path):
    with pytest.raises(OSError, match="no.urdf"):
        pcl_bsh.Robot(tmp_path / "no.urdf")
    (tmp_path / "bad.urdf").write_text("<robot")
    with pytest.raises(pcl_bsh.FileError, match="bad.urdf: .*: mend the URDF"):
        pcl_bsh.Robot(tmp_path / "bad.urdf")
    with pytest.raises(ValueError, match="bad.urdf: is no XML"):
        pcl_bsh.Robot(tmp_path / "arm.urdf", tmp_path / "bad.urdf")
    text = (tmp_path / "arm.urdf").read_text()
    (tmp_path / "bad.urdf").write_text(text.replace('type="prismatic"', 'type="planar"'))
    with pytest.raises(OSError, match="joint 'slide' is neither fixed, revolute"):
        pcl_bsh.Robot(tmp_path / "bad.urdf")
    (tmp_path / "bad.urdf").write_text(text.replace('radius="0.06"', 'radius="-0.06"'))
    with pytest.raises(ValueError, match="link 'hand'|radius|-0.06"):
        pcl_bsh.Robot(tmp_path / "bad.urdf")
    for padding, wrong in ((-1.0, "has the padding -1"), (np.nan, "has the padding nan"), ({"head": 0.1}, "link 'head'")):
        with pytest.raises(ValueError, match=wrong):
            pcl_bsh.Robot(tmp_path / "arm.urdf", padding=padding)
    for padding in ("thick", None, {"hand": "thick"}):
        with pytest.raises(TypeError):
            pcl_bsh.Robot(tmp_path / "arm.urdf", padding=padding)


def test_wrong_states_are_refused(arm, points):
    world = world_of(arm, points)
    q = states(5)
    queries = (world.is_free, world.check_states, world.clearance, lambda q: world.is_motion_free(q, q),
               lambda q: world.check_motions(arm.state(), q))
    for ask in (*queries, arm.link_poses):
        for wrong in (q[:, :2], q[0, :2], 0.0, [], [[]], q[None], [0.0, 0.0, 0.0, 0.0]):
            with pytest.raises(ValueError, match=r"q\d?: has shape \(.*\): give \(J,\) or \(n, J\), .* 3 joints of arm"):
                ask(wrong)
        with pytest.raises((TypeError, ValueError)):
            ask(["a", "b", "c"])
    for number, joint, value, wrong in ((1, 0, np.nan, "'turn'.*nan: give a finite one"), (2, 1, 2.9, "'elbow'.*2.9.*-2.8"),
                                        (3, 2, -0.1, "'slide'.*-0.1"), (4, 1, np.inf, "'elbow'.*inf")):
        bad = q.copy()
        bad[number, joint] = value
        for ask in queries:
            with pytest.raises(ValueError, match=f"(state|motion) {number}: joint {wrong}"):
                ask(bad)
    with pytest.raises(ValueError, match="q1: has 4 states: give as many as q0 has, 5, or one"):
        world.is_motion_free(q, q[:4])
    with pytest.raises(ValueError, match="limit: is not a number"):
        world.clearance(q, np.nan)
    for wrong, text in (({"wrist": 1.0}, "joint 'wrist'"), ({"stand": 1.0}, "joint 'stand': is fixed")):
        with pytest.raises(ValueError, match=text):
            arm.state(wrong)
    with pytest.raises(ValueError, match="state 'rest': is not in the SRDF of arm"):
        arm.state(named="rest")


def test_wrong_worlds_are_refused(arm, points):
    for name in ("clearance", "self_clearance", "tolerance"):
        for wrong in (-1.0, np.nan, np.inf, *([0.0] if name == "tolerance" else [])):
            with pytest.raises(ValueError, match=f"{name}: is "):
                world_of(arm, points, **{name: wrong})
    for base in (np.diag([1, 1, -1, 1.0]), 2 * np.eye(4), np.full((4, 4), np.nan), np.eye(3)):
        with pytest.raises(ValueError, match="base"):
            world_of(arm, points, base=base)
        with pytest.raises(ValueError, match="base"):
            world_of(arm, points).set_base(base)
    tilted = turned_about((0, 0, 1), 0.3).astype(np.float32)  # rigid within 1e-6
    assert world_of(arm, points, base=pose_of([0, 0, 0], tilted)).is_free(arm.state()) in (True, False)
    with pytest.raises(ValueError, match=r"obstacles: .*\(60, 2\)|obstacles.*have shape"):
        world_of(arm, points[:, :2])
    with pytest.raises(ValueError, match=r"obstacles\[1\]"):
        world_of(arm, [points, points[:, 0]])
    for wrong, text in (([0.1], "are 1: give one for each of the 3 joints"), ([0, -1, 0], "for joint 'elbow'")):
        with pytest.raises(ValueError, match=f"joint_uncertainties: .*{text}"):
            world_of(arm, points, joint_uncertainties=wrong)
    world = world_of(arm, points)
    for poses, text in (([], "poses: are 0: give one for each of the 1 obstacle"), ([2 * np.eye(4)], r"poses\[0\]")):
        with pytest.raises(ValueError, match=text):
            world.set_obstacle_poses(poses)
    for name, link, shapes, text in (("hand", "hand", [], "name of a link"), ("cup", "head", [], "link 'head'"),
                                     ("cup", "hand", [pcl_bsh.Shape.sphere(0)], "size 0")):
        with pytest.raises(ValueError, match=text):
            world.attach(name, link, shapes)
    with pytest.raises(ValueError, match="link 'hand': is not attached"):
        world.detach("hand")
    assert world.robot is arm
    for wrong in (3, "scan.pcd", None):
        with pytest.raises(TypeError):
            world_of(arm, wrong)
    with pytest.raises(TypeError):
        pcl_bsh.RobotWorld("arm", points)


def test_holes_and_missing_points_are_told(arm):
    scan = np.stack([*np.meshgrid(np.arange(20) * 0.1, np.arange(20) * 0.1)], axis=-1).reshape(-1, 2)
    scan = np.column_stack([scan, np.full(400, 2.0)])
    with pytest.warns(UserWarning, match="points lie 0.1 apart in obstacles: .* the surface of arm with no point within"):
        world_of(arm, scan, clearance=0.01)
    with pytest.warns(UserWarning, match=r"obstacles\[1\]: has no finite point"):
        world_of(arm, [scan[:5], np.full((3, 3), np.nan)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        world_of(arm, scan, clearance=0.2)
        world = world_of(arm, pcl_bsh.SphereHierarchy(scan, radii=np.full(400, 0.1, np.float32)))
    with pytest.warns(UserWarning, match="points lie 0.1 apart in obstacles"):
        world.set_obstacles(scan)


def test_progress_and_threads(arm, points):
    world = world_of(arm, points)
    q = states(500, 9)
    expected = world.check_states(q).verdict
    for ask in (lambda **w: world.is_free(q, **w), lambda **w: world.check_states(q, **w),
                lambda **w: world.clearance(q, **w), lambda **w: world.is_motion_free(q[:50], q[50:100], **w),
                lambda **w: world.check_motions(q[0], q[1], **w)):
        for threads in (1, 2):
            told = []
            ask(threads=threads, progress=told.append)
            assert told == sorted(told) and told[-1] == 1.0
            with pytest.raises(pcl_bsh.Cancelled):
                ask(threads=threads, progress=lambda done: False)
    nested = []
    world.is_free(q, progress=lambda done: nested.append(world.is_free(q[0])))
    assert set(nested) == {bool(expected[0] == FREE)}
    moved = []
    world.is_free(q, progress=lambda done: moved or moved.append(world.set_base(pose_of([0, 0, 5]))))
    assert world.is_free(q).sum() >= (expected == FREE).sum()
    results = []

    def work():
        for _ in range(5):
            results.append((world.check_states(q[:100]).verdict == FREE).sum())
            world.set_base(np.eye(4))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 20 and results[-1] == (expected[:100] == FREE).sum()


def test_ctrl_c(arm, points):
    world = world_of(arm, points)
    q = np.tile(states(1000, 10), (4000, 1))  # minutes, were it not ended
    for threads in (1, 2):
        assert interrupted(lambda: world.is_free(q, threads=threads)) < 10
