# SPDX-License-Identifier: BSD-3-Clause
"""A man walks through a scanned building: where does he collide, when, and how much room is left?

    python3 walk_through_building.py building.ply man.off FOLDER_FOR_PICTURES

Cells begin with # %%, as notebooks and editors know them.
"""

# %% What is needed
import pathlib
import sys

import matplotlib
import numpy as np

import pcl_bsh

matplotlib.use("Agg")  # pictures in files, without a window
import matplotlib.pyplot as plt  # noqa: E402

scan_file, model_file, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
folder.mkdir(parents=True, exist_ok=True)
CLEARANCE = 0.5  # metres, as everything here

# %% Clouds
# Files become structured arrays with every field; PCL's names: x y z, normal_x, rgb ... Who uses Open3D has points
# already: pcl_bsh.SphereHierarchy(numpy.asarray(cloud.points)) reads them where they are.
building = pcl_bsh.read(scan_file)
model = pcl_bsh.read(model_file)


def xyz_of(records):
    return np.stack([records[axis] for axis in "xyz"], axis=1)


man = 1.8 * xyz_of(model)  # the model is 1 high
man[:, 2] -= man[:, 2].min()  # his feet stand at z = 0

hall, walker = pcl_bsh.SphereHierarchy(building), pcl_bsh.SphereHierarchy(man)
print(hall, walker, sep="\n")

# %% His way: poses are rigid transforms (m, 4, 4) from his frame to the building's
poses = np.tile(np.eye(4), (201, 1, 1))
poses[:, 0, 3] = np.linspace(-10, 0, len(poses))
poses[:, 2, 3] = -3.1

# %% One pose: which points come within the clearance, and how near is the nearest?
pose = poses[70]  # x = -6.5
flags = pcl_bsh.collision_flags(hall, walker, CLEARANCE, pose_b=pose)
pair = pcl_bsh.closest_pair(hall, walker, pose_b=pose)
print(f"at x = {pose[0, 3]:.1f}: {flags.sum()} points within {CLEARANCE} m, the nearest at {pair.distance:.3f} m")

# %% How far is each point of the building from him?
distance, closest_point = pcl_bsh.point_distances(hall, walker, max_distance=4.0, pose_b=pose)

# %% All the way: what is touched, when first, how near it gets; Ctrl-C ends it
run = pcl_bsh.collide_along(hall, walker, poses, CLEARANCE, distances=True, first_poses=True, closest_poses=True)
clashes = pcl_bsh.find_clashes(hall, run, cluster_distance=0.3)
print(run)
for clash in clashes[:5]:
    x = poses[clash.closest_pose, 0, 3]
    print(f"  {clash.id}: {clash.points} points, {clash.distance:.3f} m at x = {x:.2f}")
room, _ = pcl_bsh.closest_pair_at_poses(hall, walker, poses)

# %% A budget instead of exactness: what is certain after so many sphere tests?
for accuracy in ("level=2", "pairs=1000", "tolerance=0.01", "exact"):
    least, most = pcl_bsh.closest_pair(hall, walker, pose_b=poses[90], accuracy=accuracy).interval
    print(f"  {accuracy:15s} the distance at x = -5.5 is in [{least:.4f}, {most:.4f}] m")

# %% Pictures
points = xyz_of(building)
low = points[:, 2] < 0  # cut open above him
ORANGE, GREY = "#e8590c", "#adb5bd"


def draw_plan(axes, shown, value, colour_map, label):
    """The building from above, coloured where `shown`."""
    axes.scatter(*points[low & ~shown][:, :2].T, s=0.8, c=GREY, linewidths=0, rasterized=True)
    order = np.flatnonzero(shown & low)
    drawn = axes.scatter(*points[order][:, :2].T, s=5, c=value[order], cmap=colour_map, linewidths=0, rasterized=True)
    axes.figure.colorbar(drawn, ax=axes, label=label, shrink=0.8)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_xlim(-10.5, 2.5)
    axes.set_ylim(-5, 5)


figure, axes = plt.subplots(figsize=(10, 6.5), layout="constrained")
draw_plan(axes, np.isfinite(distance), distance, "viridis_r", "distance from the man [m]")
axes.scatter(*points[flags == pcl_bsh.Verdict.COLLIDING][:, :2].T, s=22, c=ORANGE, linewidths=0,
             label=f"within {CLEARANCE} m")
axes.scatter(*(man + pose[:3, 3])[:, :2].T, s=0.3, c="black", linewidths=0)
axes.legend(loc="upper right", markerscale=2)
axes.set_title(f"The man stands at x = {pose[0, 3]:.1f} m: {pair.distance * 1000:.0f} mm are left")
figure.savefig(folder / "distances.png", dpi=110)

figure, axes = plt.subplots(figsize=(10, 6.5), layout="constrained")
hit = run.flags == pcl_bsh.Verdict.COLLIDING
draw_plan(axes, hit, poses[run.first_pose.clip(0), 0, 3], "plasma", "where he stands when he touches it first: x [m]")
axes.plot(poses[:, 0, 3], poses[:, 1, 3], color="black", linewidth=1)
for number, clash in enumerate(clashes[:5], 1):
    middle = (np.array(clash.low) + clash.high) / 2
    axes.annotate(f"{number}: {clash.distance * 1000:.0f} mm", middle[:2], xytext=(middle[0], 1.2 + 0.5 * number),
                  ha="center", arrowprops={"arrowstyle": "-", "color": ORANGE, "alpha": 0.6}, color=ORANGE)
axes.set_title(f"Along his way: {run.colliding} points in {len(clashes)} places come within {CLEARANCE} m")
figure.savefig(folder / "path.png", dpi=110)

figure, axes = plt.subplots(figsize=(10, 4), layout="constrained")
axes.plot(poses[:, 0, 3], room, color="#1971c2")
axes.fill_between(poses[:, 0, 3], 0, CLEARANCE, where=room <= CLEARANCE, color=ORANGE, alpha=0.3, label="collides")
axes.axhline(CLEARANCE, color=ORANGE, linewidth=1)
axes.set_xlabel("x of the man [m]")
axes.set_ylabel("room that is left [m]")
axes.set_ylim(0, 3)
axes.legend()
figure.savefig(folder / "room.png", dpi=110)

# %% Back to files: every field of the scan and one more, which PCL's programs and ours read
fields = building.dtype.descr + [("collision", "u1")]
marked = np.zeros(building.shape, fields)
for name in building.dtype.names:
    marked[name] = building[name]
marked["collision"] = flags
pcl_bsh.write(folder / "marked.pcd", marked)
print("pictures and marked.pcd are in", folder)
