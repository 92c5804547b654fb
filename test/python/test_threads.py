# SPDX-License-Identifier: BSD-3-Clause
"""Queries run without the interpreter's lock, in several threads, until Ctrl-C or the interpreter's end, and past forks."""

import _thread
import gc
import os
import signal
import subprocess
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
    poses = np.array([turned(k) for k in range(400)] * 50)  # minutes, were it not ended
    for progress in (None, lambda done: None):
        assert interrupted(lambda: pcl_bsh.collide_along(A, B, poses, 0.2, distances=True, progress=progress)) < 10
    np.testing.assert_array_equal(
        pcl_bsh.collision_flags(A, B, 0.01),
        pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(a, copy=True), pcl_bsh.SphereHierarchy(b, copy=True), 0.01))


def test_ctrl_c_ends_what_reports_no_progress():
    turn = np.linspace(0, 2 * np.pi, 24000, endpoint=False)
    rim = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    faces = np.stack([np.arange(24000), (np.arange(24000) + 1) % 24000, np.full(24000, 24000)], axis=1)
    A, B = (pcl_bsh.SphereHierarchy.of_triangles(np.vstack([rim, [[0, 0, 1]]]) + [0, 0, z], faces) for z in (0, 1e-9))
    scene = pcl_bsh.Scene(clearance=0.5, contacts=1000)
    scene.add("cone", A), scene.add("its copy", B)
    for query in (lambda: pcl_bsh.nearest_contacts(A, B, 0.5, most=1000), scene.query):  # minutes: all meet at the tip
        assert interrupted(query) < 10
    assert pcl_bsh.any_collision(A, B, 0.5)


def test_ctrl_c_ends_a_pipeline():
    records = cloud("random", 1, 200000)
    chain = [{"type": "readers.pcd", "filename": "none.pcd", "tag": "scan"}]
    chain += [{"type": "filters.voxel_grid", "leaf_size": 1e-6 * (k + 1)} for k in range(5000)]  # a minute
    assert interrupted(lambda: pcl_bsh.run_pipeline(chain, {"scan": records})) < 10


def test_a_scene_in_many_threads():
    scene = pcl_bsh.Scene(clearance=0.05, any=True)
    ids = [scene.add(f"cloud {k}", pcl_bsh.SphereHierarchy(cloud("random", k, 200))) for k in range(4)]

    def work(i):
        for k in range(20):
            scene.set_pose(ids[i % 4], turned(k))
            scene.query()

    in_threads(4, work)
    assert len(scene.query().any) == 6


AT_EXIT = """
import sys, threading, time
import numpy as np
import pcl_bsh
rng = np.random.default_rng(1)
a, b = (pcl_bsh.SphereHierarchy(rng.random((20000, 3))) for _ in range(2))
began = threading.Barrier(4)

def work():
    began.wait()
    while True:
        {query}

for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
began.wait()
time.sleep(0.05)
"""


@pytest.mark.parametrize(
    "query",
    [
        "pcl_bsh.collision_flags(a, b, 0.05)",
        "pcl_bsh.point_distances(a, b, threads=2, progress=lambda done: time.sleep(0.001))",
        "pcl_bsh.SphereHierarchy(rng.random((2000, 3))).refit(rng.random((2000, 3)))",
        "pcl_bsh.run_pipeline([{'type': 'readers.pcd', 'filename': 'none.pcd', 'tag': 'scan'}], {'scan': rng.random((9, 3))},"
        " progress=lambda stage: None)",
    ],
)
def test_the_interpreter_ends_while_daemons_ask(query):
    for _ in range(4):
        done = subprocess.run([sys.executable, "-c", AT_EXIT.format(query=query)], capture_output=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, b"")


def in_child(work):
    """Whether `work`, done in a forked process, returns True within a minute."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            code = 0 if work() else 2
        finally:
            os._exit(code)
    for _ in range(6000):
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status) == 0
        time.sleep(0.01)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return False


def test_a_child_forked_while_others_compute_goes_on():
    a, b = cloud("random", 1, 5000), cloud("random", 2, 5000)
    A, B = pcl_bsh.SphereHierarchy(a), pcl_bsh.SphereHierarchy(b)
    now = a + 0.01
    expected = pcl_bsh.closest_pair(pcl_bsh.SphereHierarchy(now, copy=True), B).distance
    ended = threading.Event()
    began = threading.Barrier(3)

    def work():
        began.wait()
        while not ended.is_set():  # hierarchies are built while the process forks
            pcl_bsh.symmetric_distances(pcl_bsh.SphereHierarchy(b, copy=True), A)

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    began.wait()

    def moved():
        A.refit(now)
        return pcl_bsh.closest_pair(A, B).distance == expected and B.refit(b.copy()) is not None

    try:
        for _ in range(8):
            assert in_child(moved)
    finally:
        ended.set()
        for thread in threads:
            thread.join()
    A.refit(now)  # and so does this process
    assert pcl_bsh.closest_pair(A, B).distance == expected


def test_a_callback_may_fork():
    A, B = pcl_bsh.SphereHierarchy(cloud("random", 1, 3000)), pcl_bsh.SphereHierarchy(cloud("random", 2, 3000))
    asked = []

    def progress(done):
        if not asked:
            asked.append(in_child(lambda: pcl_bsh.closest_pair(A, B).distance >= 0))

    pcl_bsh.point_distances(A, B, progress=progress)
    assert asked == [True]
    A.refit(cloud("random", 3, 3000))


@pytest.mark.parametrize("stop", [False, np.False_, np.bool_(0), np.zeros(3).any()])
def test_any_false_stops(stop):
    A, B = pcl_bsh.SphereHierarchy(cloud("random", 1, 3000)), pcl_bsh.SphereHierarchy(cloud("random", 2, 3000))
    with pytest.raises(pcl_bsh.Cancelled):
        pcl_bsh.point_distances(A, B, progress=lambda done: stop)
    with pytest.raises(pcl_bsh.Cancelled):
        pcl_bsh.run_pipeline([{"type": "readers.pcd", "filename": "none.pcd", "tag": "scan"},
                              {"type": "filters.voxel_grid", "leaf_size": 0.1}],
                             {"scan": cloud("random", 1)}, progress=lambda stage: stop)


@pytest.mark.parametrize("answer", [None, True, np.True_, 0, 0.0, "", np.zeros(2)])
def test_nothing_else_stops(answer):
    A, B = pcl_bsh.SphereHierarchy(cloud("random", 1, 3000)), pcl_bsh.SphereHierarchy(cloud("random", 2, 3000))
    pcl_bsh.point_distances(A, B, progress=lambda done: answer)
