# SPDX-License-Identifier: BSD-3-Clause
"""Which arrays a hierarchy reads, where, and what becomes of them."""

import gc
import weakref

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud


def flags(xyz, **options):
    other = pcl_bsh.SphereHierarchy(cloud("random", 2, 40), copy=True)
    return pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(xyz, **options), other, 0.1)


def records_of(xyz, padded=False):
    dtype = np.dtype({"names": ["i", "z", "x", "y"], "formats": ["u1", "f8", "f8", "f8"], "offsets": [0, 1, 9, 20],
                      "itemsize": 31 if padded else 28})
    records = np.zeros(len(xyz), dtype)
    for k, axis in enumerate("xyz"):
        records[axis] = xyz[:, k]
    return records


LAYOUTS = {
    "rows": (lambda p: p.copy(), True),
    "columns": (lambda p: np.asfortranarray(p), True),
    "transposed": (lambda p: p.T.copy().T, True),
    "wide": (lambda p: np.hstack([p, p, p])[:, 3:6], True),
    "every_second": (lambda p: np.repeat(p, 2, axis=0)[::2], True),
    "columns_apart": (lambda p: np.repeat(p, 2, axis=1)[:, ::2], True),
    "columns_backwards": (lambda p: p[:, ::-1].copy()[:, ::-1], True),
    "columns_as_arrays_backwards": (lambda p: np.asfortranarray(p[:, ::-1])[:, ::-1], True),
    "unaligned": (lambda p: np.frombuffer(b"\0" + p.tobytes(), np.uint8)[1:].view(np.float64).reshape(p.shape), True),
    "records": (records_of, True),
    "padded_records": (lambda p: records_of(p, padded=True), True),
    "organised_records": (lambda p: records_of(p).reshape(30, 5), True),
    "organised_window": (lambda p: np.repeat(records_of(p).reshape(30, 5), 2, axis=1)[:, ::2], True),
    "organised_as_steps": (lambda p: records_of(p).reshape(1, 30, 1, 5, 1), True),
    "organised_rows_apart": (lambda p: np.hstack([records_of(p).reshape(30, 5)] * 2)[:, :5], False),
    "organised_transposed": (lambda p: records_of(p).reshape(30, 5).T.copy().T, False),
    "organised_columns": (lambda p: np.asfortranarray(records_of(p).reshape(30, 5)), False),
    "organised_backwards": (lambda p: records_of(p).reshape(30, 5)[::-1].copy()[::-1], False),
    "organised_all_backwards": (lambda p: records_of(p)[::-1].copy().reshape(30, 5)[::-1, ::-1], False),
    "organised_read_only": (lambda p: np.frombuffer(records_of(p).tobytes(), records_of(p).dtype).reshape(30, 5), True),
    "recarray": (lambda p: records_of(p).view(np.recarray), True),
    "field_of_three": (lambda p: np.array([(r,) for r in p.tolist()], [("xyz", "f8", 3)])["xyz"], True),
    "strided_by_hand": (lambda p: np.lib.stride_tricks.as_strided(p.copy(), p.shape, p.strides), True),
    "of_a_buffer": (lambda p: np.asarray(memoryview(p.copy())), True),
    "rows_backwards": (lambda p: p[::-1].copy()[::-1], False),
    "list": (lambda p: p.tolist(), False),
    "read_only": (lambda p: np.frombuffer(p.tobytes()).reshape(p.shape), True),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_any_strides_give_the_same_answer(name):
    xyz = cloud("random", 1)
    make, in_place = LAYOUTS[name]
    given = make(xyz)
    hierarchy = pcl_bsh.SphereHierarchy(given)
    assert hierarchy.in_place == in_place
    assert (name == "list") or np.shares_memory(hierarchy.array, given) == in_place
    assert (hierarchy.array is given) == in_place
    if name != "list" and not in_place:
        assert given.flags.writeable
    np.testing.assert_array_equal(flags(given), flags(xyz))
    assert flags(xyz).any() and not flags(xyz).all()
    assert hierarchy.validate() == []


@pytest.mark.parametrize("shape", [(0, 5), (5, 0), (), (1, 1), (7, 1), (1, 7), (2, 3, 4)])
def test_records_have_any_shape(shape):
    records = np.zeros(shape, records_of(cloud("one")).dtype)
    hierarchy = pcl_bsh.SphereHierarchy(records)
    assert len(hierarchy) == hierarchy.records == records.size and hierarchy.in_place == (records.size > 0)
    hierarchy.refit(np.ones(shape, records.dtype))
    assert len(hierarchy) == records.size and hierarchy.validate() == []


def test_rows_over_each_other_are_copied():
    one = np.broadcast_to(np.array([0.25, 0.5, 0.75]), (10, 3))
    assert not pcl_bsh.SphereHierarchy(one).in_place
    np.testing.assert_array_equal(flags(one), flags(one.copy()))
    window = np.lib.stride_tricks.sliding_window_view(cloud("random", 5).ravel(), 3)
    assert not pcl_bsh.SphereHierarchy(window).in_place
    np.testing.assert_array_equal(flags(window), flags(window.copy()))


def test_one_row_and_none():
    for xyz in (cloud("one"), cloud("one")[::-1], cloud("one").T.copy().T, cloud("empty"), cloud("empty")[::-1]):
        assert len(pcl_bsh.SphereHierarchy(xyz)) == len(xyz)
        assert flags(xyz).shape == (len(xyz),)


@pytest.mark.parametrize(
    "given, words",
    [
        (np.zeros((4, 3), ">f8"), ["points", "float64", "order", "convert"]),
        (np.zeros((4, 3), ">f4"), ["float32"]),
        (np.zeros((4, 3), np.int64), ["int64", "convert"]),
        (np.zeros((4, 3), np.float16), ["float16"]),
        (np.zeros((4, 3), np.longdouble), ["float128"]),
        (np.zeros((4, 3), complex), ["complex128"]),
        (np.zeros((4, 3), object), ["object"]),
        (np.zeros((4, 2)), ["shape (4, 2)", "(n, 3)"]),
        (np.zeros(3), ["shape (3,)"]),
        (np.zeros((2, 2, 3)), ["shape (2, 2, 3)"]),
        (np.zeros(4, [("x", "f4"), ("y", "f4")]), ["without field z"]),
        (np.zeros(4, [("x", "f4"), ("y", "f8"), ("z", "f8")]), ["points"]),
        (np.zeros(4, [("x", ">f4"), ("y", ">f4"), ("z", ">f4")]), ["order"]),
        ([["a", "b", "c"]], ["points"]),
        (np.ma.masked_less(np.zeros((4, 3)), 1), ["masked", "filled"]),
    ],
)
def test_refuses_other_arrays(given, words):
    with pytest.raises(ValueError) as error:
        pcl_bsh.SphereHierarchy(given)
    for word in words:
        assert word in str(error.value)
    assert "\n" not in str(error.value)


def test_arrays_are_read_only_while_a_hierarchy_lives():
    base = cloud("random", 1)
    view = base[10:]
    first = pcl_bsh.SphereHierarchy(view)
    assert not view.flags.writeable and not base.flags.writeable
    second = pcl_bsh.SphereHierarchy(base)
    assert not view.flags.writeable and not base.flags.writeable
    with pytest.raises(ValueError):
        base[0] = 1
    del first
    assert not view.flags.writeable and not base.flags.writeable  # the second reads what both show
    del second
    assert view.flags.writeable and base.flags.writeable
    base[0] = view[0] = 1


@pytest.mark.parametrize("name", sorted(name for name, (_, in_place) in LAYOUTS.items() if in_place))
def test_what_is_read_in_place_is_locked_with_all_that_it_shows(name):
    given = LAYOUTS[name][0](cloud("random", 1))
    shown, bases = given, []
    while isinstance(shown, np.ndarray):
        bases.append(shown)
        shown = shown.base
    written = [array.flags.writeable for array in bases]
    hierarchy = pcl_bsh.SphereHierarchy(given)
    assert not any(array.flags.writeable for array in bases)
    with pytest.raises(ValueError):
        given[...] = given.copy()
    del hierarchy
    assert [array.flags.writeable for array in bases] == written


def test_the_next_frame_of_an_organised_cloud_is_refused():
    frames = np.zeros((2, 30, 5), records_of(cloud("random", 1)).dtype)
    here, there = frames[0], frames[1]
    hierarchy = pcl_bsh.SphereHierarchy(here)
    with pytest.raises(ValueError):
        here["x"] = 7
    with pytest.raises(ValueError):
        here[...] = there
    there["x"] = 7  # another view, and other memory
    hierarchy.refit(there)
    here["x"] = 5  # given back
    with pytest.raises(ValueError):
        there["x"] = 3
    hierarchy.refit(here)
    there["x"] = 3
    del hierarchy
    assert frames.flags.writeable and here.flags.writeable and there.flags.writeable


def test_views_that_share_no_byte_are_apart():
    both = np.zeros((20, 6))
    here, there = both[:, :3], both[:, 3:]
    hierarchy = pcl_bsh.SphereHierarchy(here)
    hierarchy.refit(there)
    assert here.flags.writeable and not there.flags.writeable


def test_what_a_view_of_another_kind_shows_is_locked():
    xyz = cloud("random", 1)
    for view in (np.lib.stride_tricks.as_strided(xyz, (50, 3), xyz.strides), np.asarray(memoryview(xyz))[5:],
                 np.frombuffer(xyz, np.float64).reshape(-1, 3)):
        hierarchy = pcl_bsh.SphereHierarchy(view)
        assert not xyz.flags.writeable
        del hierarchy
        assert xyz.flags.writeable


def test_radii_of_a_subclass_are_locked():
    class Own(np.ndarray):
        pass

    xyz = cloud("random", 1)
    radii = np.full(len(xyz), 0.01, np.float32)
    own = radii.view(Own)
    for name in ("radii", "uncertainties"):
        hierarchy = pcl_bsh.SphereHierarchy(xyz, **{name: own})
        assert not own.flags.writeable and not radii.flags.writeable
        del hierarchy
        assert own.flags.writeable and radii.flags.writeable


def test_arrays_that_were_read_only_stay_so():
    xyz = cloud("random", 1)
    xyz.flags.writeable = False
    del_me = pcl_bsh.SphereHierarchy(xyz)
    del del_me
    assert not xyz.flags.writeable


def test_a_copy_leaves_the_array_alone():
    xyz = cloud("random", 1)
    radii = np.full(len(xyz), 0.01, np.float32)
    hierarchy = pcl_bsh.SphereHierarchy(xyz, radii=radii, copy=True)
    expected = flags(xyz, radii=radii)
    assert xyz.flags.writeable and radii.flags.writeable and not hierarchy.in_place
    xyz[:] = 9
    radii[:] = 9
    other = pcl_bsh.SphereHierarchy(cloud("random", 2, 40))
    np.testing.assert_array_equal(pcl_bsh.collision_flags(hierarchy, other, 0.1), expected)


def test_a_failure_gives_the_arrays_back():
    xyz = cloud("random", 1)
    for options in ({"radii": np.full(len(xyz), -1, np.float32)}, {"radii": np.zeros(3, np.float32)},
                    {"indices": [len(xyz)]}, {"uncertainty": -1.0}, {"voxel_edge": -1.0}):
        with pytest.raises(ValueError):
            pcl_bsh.SphereHierarchy(xyz, **options)
        assert xyz.flags.writeable


def test_the_hierarchy_keeps_its_arrays():
    xyz = cloud("random", 1)
    radii = np.full(len(xyz), 0.02, np.float32)
    expected = flags(xyz, radii=radii)
    hierarchy = pcl_bsh.SphereHierarchy(xyz, radii=radii)
    watch = weakref.ref(xyz)
    del xyz, radii
    gc.collect()
    junk = [np.full((150, 3), 7.0) for _ in range(100)]
    assert watch() is not None
    other = pcl_bsh.SphereHierarchy(cloud("random", 2, 40))
    np.testing.assert_array_equal(pcl_bsh.collision_flags(hierarchy, other, 0.1), expected)
    del hierarchy, junk
    gc.collect()
    assert watch() is None


def test_results_keep_their_memory():
    a, b = pcl_bsh.SphereHierarchy(cloud("random", 1)), pcl_bsh.SphereHierarchy(cloud("random", 2))
    distance, nearest = pcl_bsh.point_distances(a, b)
    expected = distance.copy()
    column = pcl_bsh.radius_search(a, cloud("random", 3), 0.2)[3][0]
    kept = column.copy()
    del a, b
    gc.collect()
    junk = [np.full(1000, 7.0) for _ in range(100)]
    np.testing.assert_array_equal(distance, expected)
    np.testing.assert_array_equal(column, kept)
    assert not distance.flags.writeable and len(nearest) == 150 and junk


def test_subsets_radii_and_uncertainties_have_types():
    xyz = cloud("random", 1)
    with pytest.raises(ValueError, match="radii: are float64, not float32"):
        pcl_bsh.SphereHierarchy(xyz, radii=np.zeros(len(xyz)))
    with pytest.raises(ValueError, match="indices: are float64"):
        pcl_bsh.SphereHierarchy(xyz, indices=np.zeros(4))
    with pytest.raises(ValueError, match="index 150 is outside"):
        pcl_bsh.SphereHierarchy(xyz, indices=[150])
    with pytest.raises(ValueError, match="-1 is no record"):
        pcl_bsh.SphereHierarchy(xyz, indices=[-1])
    some = pcl_bsh.SphereHierarchy(xyz, indices=np.arange(0, 150, 3))
    assert (len(some), some.records) == (50, 150)
    flagged = flags(xyz, indices=np.arange(0, 150, 3))
    np.testing.assert_array_equal(flagged[::3], flags(xyz)[::3])
    assert not flagged[1::3].any() and not flagged[2::3].any()
    assert len(pcl_bsh.SphereHierarchy(xyz, indices=[])) == 0
    radii = np.zeros(300, np.float32)[::2]
    assert not pcl_bsh.SphereHierarchy(xyz, radii=radii) is None


def test_poses():
    a, b = (pcl_bsh.SphereHierarchy(cloud("random", k)) for k in (1, 2))
    for wrong in (np.eye(3), np.zeros((2, 4, 4)), np.eye(4) * 2, np.full((4, 4), np.nan), "pose",
                  np.vstack([np.eye(4)[:3], [[0, 0, 1, 1]]]), np.diag([1.0, 1, -1, 1])):
        with pytest.raises(ValueError, match="pose"):
            pcl_bsh.collision_flags(a, b, 0.1, pose_b=wrong)
    expected = pcl_bsh.collision_flags(a, b, 0.1)
    for same in (np.eye(4), np.eye(4, dtype=np.float32), np.eye(4)[:3], np.eye(4, dtype=int).tolist(),
                 np.asfortranarray(np.eye(4)), np.eye(4).astype(">f8")):
        np.testing.assert_array_equal(pcl_bsh.collision_flags(a, b, 0.1, pose_a=same, pose_b=same), expected)


def test_repr():
    xyz = cloud("holes", 1)
    finite = int(np.isfinite(xyz).all(axis=1).sum())
    hierarchy = pcl_bsh.SphereHierarchy(xyz, radii=np.zeros(150, np.float32), uncertainty=0.1)
    assert repr(hierarchy) == f"SphereHierarchy({finite} points of 150, float64, with radii, uncertain)"
    assert len(hierarchy) == finite and hierarchy.records == 150
    hierarchy.build_all(threads=2)
    statistics = hierarchy.statistics()
    assert statistics["points"] == finite and statistics["voxels"] == statistics["voxels_built"] > 0
    assert pcl_bsh.SphereHierarchy(np.full((1, 3), 1.5, np.float32)).coordinate_spacing == np.spacing(np.float32(1.5))
