# SPDX-License-Identifier: BSD-3-Clause
"""Arrays that hold the hierarchy which reads them are freed, and no others."""

import gc
import threading
import weakref

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud

RECORD = np.dtype([("x", "f8"), ("y", "f8"), ("z", "f8"), ("i", "u1")])


class Cloud(np.ndarray):
    pass


def owning(shape=(60, 3), dtype=np.float64):
    made = Cloud(shape, dtype)
    made[...] = np.zeros(shape, dtype)
    return made


HOLDERS = {
    "its_own": lambda c: pcl_bsh.SphereHierarchy(c),
    "of_a_part": lambda c: pcl_bsh.SphereHierarchy(c[10:]),
    "of_a_plain_part": lambda c: pcl_bsh.SphereHierarchy(c[10:].view(np.ndarray)),
    "of_a_part_of_a_part": lambda c: pcl_bsh.SphereHierarchy(c[10:].view(np.ndarray)[5:].view(Cloud)[::2]),
    "radii": lambda c: pcl_bsh.SphereHierarchy(np.zeros((60, 3)), radii=owner_of_radii(c)),
    "refitted": lambda c: refitted(c),
    "two": lambda c: [pcl_bsh.SphereHierarchy(c), pcl_bsh.SphereHierarchy(c[:9])],
}


def owner_of_radii(c):
    radii = owning(60, np.float32)
    radii.cloud = c
    return radii


def refitted(c):
    hierarchy = pcl_bsh.SphereHierarchy(np.zeros((60, 3)))
    hierarchy.refit(c)
    return hierarchy


@pytest.mark.parametrize("name", HOLDERS)
def test_an_array_that_holds_its_hierarchy_is_freed(name):
    held = owning()
    held.tree = HOLDERS[name](held)
    watch = weakref.ref(held)
    del held
    gc.collect()
    assert watch() is None


def test_an_organised_one_too():
    held = owning((6, 10), RECORD)
    held.tree = pcl_bsh.SphereHierarchy(held)
    watch = weakref.ref(held)
    del held
    gc.collect()
    assert watch() is None


def test_what_is_in_use_keeps_all_that_it_holds():
    held = owning()
    held.tree = pcl_bsh.SphereHierarchy(held)
    tree = held.tree
    del held
    gc.collect()
    assert tree.array.tree is tree and not tree.array.flags.writeable
    part = tree.array[3:]
    watch = weakref.ref(tree)
    del tree
    gc.collect()
    assert watch() is not None and part.base.tree is watch()


def test_a_scene_keeps_it():
    held = owning()
    held.tree = pcl_bsh.SphereHierarchy(held)
    held.name = "kept"
    watch = weakref.ref(held)
    scene = pcl_bsh.Scene(clearance=3.0, any=True)
    scene.add("a", held.tree)
    scene.add("b", pcl_bsh.SphereHierarchy(cloud("random", 1)))
    del held
    gc.collect()
    assert watch() is not None and watch().name == "kept" and watch().tree.array is watch()
    assert len(scene.query().any) == 1


def test_a_subclass_of_the_hierarchy():
    class Tree(pcl_bsh.SphereHierarchy):
        pass

    held = owning()
    held.tree = Tree(held)
    held.tree.back = held
    watch = weakref.ref(held.tree)
    del held
    gc.collect()
    assert watch() is None


def test_collections_while_points_change():
    ended = threading.Event()

    def collect():
        while not ended.is_set():
            gc.collect()

    thread = threading.Thread(target=collect)
    thread.start()
    try:
        for k in range(30):
            held = owning()
            held.tree = pcl_bsh.SphereHierarchy(held)
            held.name = k
            for _ in range(5):
                now = owning()
                now.tree, now.name = held.tree, k
                now.tree.refit(now)
                held = now
            assert held.tree.array is held and held.name == k
    finally:
        ended.set()
        thread.join()
