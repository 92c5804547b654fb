# SPDX-License-Identifier: BSD-3-Clause
"""Queries run without the interpreter's lock, in several threads, and until Ctrl-C."""

import _thread
import gc
import sys
import threading
import time

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud, turned


def in_threads(count, work):
    errors = []

    def run(i):
        try:
            work(i)
        except BaseException as error:  # noqa: B902: to be shown by the main thread
            errors.append(error)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if errors:
        raise errors[0]


def test_one_hierarchy_in_many_threads():
    a, b = cloud("random", 1, 3000), cloud("random", 2, 3000)
    poses = [turned(k) for k in range(8)]
    expected = [pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(a, copy=True), pcl_bsh.SphereHierarchy(b, copy=True), 0.03,
                                        pose_b=pose) for pose in poses]
    for _ in range(3):
        A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)  # built while they are asked

        def work(i):
            np.testing.assert_array_equal(pcl_bsh.collision_flags(A, B, 0.03, pose_b=poses[i]), expected[i])
            pcl_bsh.radius_search(A, b[:20], 0.1)

        in_threads(8, work)


def test_hierarchies_come_and_go_in_many_threads():
    xyz = cloud("random", 1, 500)
    other = pcl_bsh.SphereHierarchy(cloud("random", 2, 100))

    def work(i):
        for _ in range(50):
            pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(xyz[i:]), other, 0.05)

    in_threads(6, work)
    gc.collect()
    assert xyz.flags.writeable


def test_the_interpreter_goes_on_meanwhile():
    a, b = cloud("random", 1, 20000), cloud("random", 2, 20000)
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    pose = turned(1)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)  # a thread gives the interpreter's lock away only by itself
    try:
        for _ in range(10):  # this thread may get no processor while the query runs
            began, done = threading.Event(), threading.Event()

            def work():
                began.set()
                pcl_bsh.symmetric_distances(A, B, pose_b=pose)
                done.set()

            thread = threading.Thread(target=work)
            thread.start()
            began.wait()
            meanwhile = not done.is_set()
            thread.join()
            if meanwhile:
                return
    finally:
        sys.setswitchinterval(interval)
    raise AssertionError("the query held the interpreter's lock")


def test_a_callback_may_ask_itself():
    a, b = cloud("random", 1, 5000), cloud("random", 2, 5000)
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    expected = pcl_bsh.closest_pair(pcl_bsh.SphereHierarchy(a, copy=True), pcl_bsh.SphereHierarchy(b, copy=True)).distance
    for threads in (1, 2):
        asked = []
        pcl_bsh.point_distances(A, B, threads=threads,
                                progress=lambda done: asked.append(pcl_bsh.closest_pair(A, B).distance))
        assert asked and set(asked) == {expected}


def interrupted(call):
    """Presses Ctrl-C soon after the call began; returns how long it went on."""
    pressed = []

    def press():
        pressed.append(time.monotonic())
        _thread.interrupt_main()

    timer = threading.Timer(0.15, press)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
            time.sleep(5)  # it was done before: the interrupt comes here, and the test below fails
        return time.monotonic() - pressed[0]
    finally:
        timer.cancel()


def test_ctrl_c():
    a, b = cloud("random", 1, 60000), cloud("random", 2, 60000)
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    A.build_all(), B.build_all()
    poses = np.array([turned(k) for k in range(400)])
    for progress in (None, lambda done: None):
        assert interrupted(lambda: pcl_bsh.collide_along(A, B, poses, 0.2, distances=True, progress=progress)) < 2
    np.testing.assert_array_equal(
        pcl_bsh.collision_flags(A, B, 0.01),
        pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(a, copy=True), pcl_bsh.SphereHierarchy(b, copy=True), 0.01))


def test_ctrl_c_ends_a_pipeline():
    records = cloud("random", 1, 200000)
    chain = [{"type": "readers.pcd", "filename": "none.pcd", "tag": "scan"}]
    chain += [{"type": "filters.voxel_grid", "leaf_size": 1e-6 * (k + 1)} for k in range(200)]
    assert interrupted(lambda: pcl_bsh.run_pipeline(chain, {"scan": records})) < 3


def test_a_scene_in_many_threads():
    scene = pcl_bsh.Scene(clearance=0.05, any=True)
    ids = [scene.add(f"cloud {k}", pcl_bsh.SphereHierarchy(cloud("random", k, 200))) for k in range(4)]

    def work(i):
        for k in range(20):
            scene.set_pose(ids[i % 4], turned(k))
            scene.query()

    in_threads(4, work)
    assert len(scene.query().any) == 6
