# SPDX-License-Identifier: BSD-3-Clause
"""A made arm as URDF, and its gaps by NumPy's brute force."""

import numpy as np

import pcl_bsh

BALLS = {"upper": [(0.0, 0.1), (0.15, 0.08), (0.3, 0.09)], "fore": [(0.0, 0.07), (0.2, 0.05)], "hand": [(0.0, 0.06)]}

URDF = """<robot name="arm">
  <link name="base"/><link name="mast"/>
  <link name="upper">{upper}</link><link name="fore">{fore}</link><link name="hand">{hand}</link>
  <joint name="stand" type="fixed"><parent link="base"/><child link="mast"/><origin xyz="0 0 0.5"/></joint>
  <joint name="turn" type="continuous"><parent link="mast"/><child link="upper"/><axis xyz="0 0 1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.4 0 0" rpy="0.3 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-2.8" upper="2.8" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="fore"/><child link="hand"/><origin xyz="0.3 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.2" effort="1" velocity="1"/></joint>
</robot>"""

SRDF = """<robot name="arm">
  <group name="reach"><joint name="turn"/><joint name="slide"/></group>
  <group_state name="home" group="reach"><joint name="turn" value="0.25"/><joint name="slide" value="0.1"/></group_state>
  <disable_collisions link1="upper" link2="hand"/>
</robot>"""


def write_arm(folder, **options):
    """The files of the arm, and the robot that they make."""
    balls = {link: "".join(f'<collision><origin xyz="{x} 0 0"/><geometry><sphere radius="{r}"/></geometry></collision>'
                           for x, r in of) for link, of in BALLS.items()}
    (folder / "arm.urdf").write_text(URDF.format(**balls))
    (folder / "arm.srdf").write_text(SRDF)
    return pcl_bsh.Robot(folder / "arm.urdf", **options)


def turned_about(axis, angle):
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def pose_of(shift, rotation=np.eye(3)):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, shift
    return pose


def link_poses(q):
    """Where upper, fore and hand are."""
    upper = pose_of([0, 0, 0.5], turned_about((0, 0, 1), q[0]))
    fore = upper @ pose_of([0.4, 0, 0], turned_about((1, 0, 0), 0.3) @ turned_about((0, 1, 0), q[1]))
    return {"upper": upper, "fore": fore, "hand": fore @ pose_of([0.3 + q[2], 0, 0])}


def ball_gaps(q, points, padding=0.0, base=np.eye(4)):
    """(link, its shape, gap to each point) of each ball."""
    for link, pose in link_poses(q).items():
        for shape, (x, radius) in enumerate(BALLS[link]):
            center = (base @ pose @ [x, 0, 0, 1])[:3]
            yield link, shape, np.linalg.norm(points - center, axis=1) - radius - padding


def gap_to_points(q, points, **options):
    return min(gap.min() for _, _, gap in ball_gaps(q, points, **options))


def gap_to_itself(q):
    """The least gap of hand and upper: the others are parent and child."""
    poses = link_poses(q)
    return min(np.linalg.norm((poses["upper"] @ [x, 0, 0, 1] - poses["hand"] @ [0, 0, 0, 1])[:3]) - r - BALLS["hand"][0][1]
               for x, r in BALLS["upper"])


def states(count, seed=0):
    return np.random.default_rng(seed).uniform([-9, -2.8, 0], [9, 2.8, 0.2], (count, 3))
