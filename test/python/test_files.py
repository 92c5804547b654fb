# SPDX-License-Identifier: BSD-3-Clause
"""Files as structured arrays, and pipelines."""

import json
import pathlib

import numpy as np
import pytest

import pcl_bsh
from clouds import cloud


def records(n=20, dtype=None):
    dtype = dtype or [("x", "f8"), ("y", "f8"), ("z", "f8"), ("intensity", "f4"), ("ring", "u2"), ("label", "i4")]
    out = np.zeros(n, dtype)
    rng = np.random.default_rng(1)
    for k, name in enumerate(out.dtype.names):
        out[name] = rng.random(n) if out.dtype[name].kind == "f" else rng.integers(0, 100, n)
    return out


@pytest.mark.parametrize("name", ["cloud.pcd", "cloud.ply", "cloud.csv", "cloud.las"])
def test_what_is_written_is_read(tmp_path, name):
    given = records()
    pcl_bsh.write(tmp_path / name, given)
    read = pcl_bsh.read(str(tmp_path / name))
    assert read.shape == (20,)
    for axis in "xyz":
        np.testing.assert_allclose(read[axis], given[axis], atol=0 if name != "cloud.las" else 1e-6)
    if name in ("cloud.pcd", "cloud.ply"):
        assert read.dtype.names == given.dtype.names
        for field in given.dtype.names:
            assert read.dtype[field] == given.dtype[field]
            np.testing.assert_array_equal(read[field], given[field])
    assert len(pcl_bsh.SphereHierarchy(read)) == 20 and pcl_bsh.SphereHierarchy(read).in_place
    assert read.flags.writeable


def test_every_type_and_arrays_in_fields(tmp_path):
    dtype = [("x", "f4"), ("y", "f4"), ("z", "f4")] + [(code, code) for code in ("i1", "u1", "i2", "u2", "i4", "u4", "i8",
                                                                                 "u8", "f4", "f8")] + [("hist", "f4", 5)]
    given = records(7, dtype[:-1])
    full = np.zeros(7, dtype)
    for name in given.dtype.names:
        full[name] = given[name]
    full["hist"] = np.arange(35).reshape(7, 5)
    full["u8"][0] = 2**64 - 1
    pcl_bsh.write(tmp_path / "all.pcd", full)
    read = pcl_bsh.read(tmp_path / "all.pcd")
    for name in full.dtype.names:
        np.testing.assert_array_equal(read[name], full[name])
    flag = np.zeros(2, [("x", "f4"), ("y", "f4"), ("z", "f4"), ("hit", "?")])
    flag["hit"] = [True, False]
    pcl_bsh.write(tmp_path / "flag.pcd", flag)
    assert pcl_bsh.read(tmp_path / "flag.pcd")["hit"].tolist() == [1, 0]


def test_plain_arrays_strides_and_organised_clouds(tmp_path):
    xyz = cloud("float32", 1, 12)
    for given in (xyz, np.asfortranarray(xyz), xyz.astype(np.float64), np.repeat(xyz, 2, axis=0)[::2]):
        pcl_bsh.write(tmp_path / "plain.pcd", given)
        read = pcl_bsh.read(tmp_path / "plain.pcd")
        assert read["x"].dtype == given.dtype
        np.testing.assert_array_equal(np.stack([read[axis] for axis in "xyz"], axis=1), xyz)
    grid = records(12).reshape(3, 4)
    grid["x"][1, 2] = np.nan
    pcl_bsh.write(tmp_path / "grid.pcd", grid)
    read = pcl_bsh.read(tmp_path / "grid.pcd")
    assert read.shape == (3, 4)
    np.testing.assert_array_equal(read["x"], grid["x"])
    assert len(pcl_bsh.SphereHierarchy(read)) == 11
    pcl_bsh.write(tmp_path / "none.pcd", records(0))
    assert pcl_bsh.read(tmp_path / "none.pcd").shape == (0,)


def test_laz_is_read_on_any_number_of_threads(tmp_path):
    laz = pathlib.Path(__file__).parents[1] / "fuzz" / "corpus" / "laz" / "f1_v2_chunks"
    (tmp_path / "cloud.laz").write_bytes(laz.read_bytes())
    expected = pcl_bsh.read(tmp_path / "cloud.laz")
    assert len(expected) > 0
    for threads in (0, 1, 2):
        np.testing.assert_array_equal(pcl_bsh.read(tmp_path / "cloud.laz", threads=threads), expected)
        read, header = pcl_bsh.read_with_header(tmp_path / "cloud.laz", threads=threads)
        np.testing.assert_array_equal(read, expected)
        assert header.is_las
        np.testing.assert_array_equal(pcl_bsh.read_mesh(tmp_path / "cloud.laz", threads=threads)[0], expected)
    with pytest.raises(TypeError):
        pcl_bsh.read(tmp_path / "cloud.laz", threads=-1)


def test_headers_are_kept(tmp_path):
    pcl_bsh.write(tmp_path / "cloud.las", records())
    read, header = pcl_bsh.read_with_header(tmp_path / "cloud.las")
    assert header.is_las and header.viewpoint == (0, 0, 0, 1, 0, 0, 0)
    pcl_bsh.write(tmp_path / "again.las", read, header)
    assert (tmp_path / "again.las").read_bytes() == (tmp_path / "cloud.las").read_bytes()
    text = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n" \
           "VIEWPOINT 1 2 3 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n"
    (tmp_path / "seen.pcd").write_text(text)
    read, header = pcl_bsh.read_with_header(tmp_path / "seen.pcd")
    pcl_bsh.write(tmp_path / "again.pcd", read, header)
    assert pcl_bsh.read_with_header(tmp_path / "again.pcd")[1].viewpoint == (1, 2, 3, 1, 0, 0, 0)


def test_transforms_of_scans(tmp_path):
    def scan(rows):
        (tmp_path / "a.ptx").write_text(
            "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + rows + "\n5 6 7 1\n1 2 3 0.5\n")
        return tmp_path / "a.ptx"
    readers = (pcl_bsh.read, lambda *a, **k: pcl_bsh.read_with_header(*a, **k)[0],
               lambda *a, **k: pcl_bsh.read_mesh(*a, **k)[0])
    for read in readers:
        scaled = scan("1000 0 0 0\n0 1000 0 0\n0 0 1000 0")
        with pytest.raises(pcl_bsh.FileError, match="scan 0 has a transform that scales by 1000: .*allow_scale"):
            read(scaled)
        assert read(scaled, allow_scale=True)["x"].ravel() == [1005]
        with pytest.raises(pcl_bsh.FileError, match="flattens space: it is singular"):
            read(scan("1 0 0 0\n0 1 0 0\n0 1 0 0"), allow_scale=True)
        with pytest.warns(UserWarning, match="a.ptx: transform of scan 0: .*the nearest rotation is used"):
            read(scan("0.8 0.60002 0 0\n-0.6 0.8 0 0\n0 0 1 0"))


def test_units(tmp_path):
    (tmp_path / "a.pcd").write_text(
        "VERSION 0.7\nFIELDS x y z sigma\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n"
        "DATA ascii\n1500 1 -2 4\n")
    with pytest.warns(UserWarning, match="a.pcd: its lengths are converted from mm to m"):
        read, header = pcl_bsh.read_with_header(tmp_path / "a.pcd", unit="mm", to_unit="m", length_fields=["sigma"])
    assert header.unit == "m"
    assert read.dtype["x"] == np.float64 and read[0].tolist() == (1.5, 0.001, -0.002, 0.004)
    assert pcl_bsh.read(tmp_path / "a.pcd", unit="mm")["x"] == [1500]
    with pytest.raises(ValueError, match="to_unit: 'inch' is no unit: give mm, cm, m, ft or us-ft"):
        pcl_bsh.read(tmp_path / "a.pcd", to_unit="inch")
    with pytest.raises(pcl_bsh.FileError, match="a.pcd: does not say its unit, and is wanted in m"):
        pcl_bsh.read_mesh(tmp_path / "a.pcd", to_unit="m")


def test_coordinate_systems(tmp_path):
    (tmp_path / "a.xyz").write_text("500000 5400000 7\n")
    with pytest.raises(ValueError, match="to_crs: 'EPSG:99999' is no"):
        pcl_bsh.read(tmp_path / "a.xyz", to_crs="EPSG:99999")
    try:
        with pytest.warns(UserWarning, match="a.xyz: its coordinates are transformed from 'ETRS89 / UTM zone 33N"):
            read, header = pcl_bsh.read_with_header(tmp_path / "a.xyz", crs="EPSG:25833", to_crs="EPSG:25832")
    except ValueError as error:
        pytest.skip(str(error))  # built without PROJ
    assert header.coordinate_system == "ETRS89 / UTM zone 32N (EPSG:25832)" and header.unit == "m"
    assert 940000 < read["x"][0] < 943000 and read["z"] == [7]
    with pytest.raises(pcl_bsh.FileError, match="a.xyz: names no coordinate system, and is wanted in EPSG:25832"):
        pcl_bsh.read(tmp_path / "a.xyz", to_crs="EPSG:25832")


def test_meshes(tmp_path):
    (tmp_path / "square.off").write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
    vertices, triangles = pcl_bsh.read_mesh(tmp_path / "square.off")
    assert vertices.shape == (4,) and triangles.shape == (2, 3) and triangles.dtype == np.uint32
    square = pcl_bsh.SphereHierarchy.of_triangles(vertices, triangles)
    above = pcl_bsh.SphereHierarchy(np.array([[0.5, 0.5, 0.25]]))
    assert pcl_bsh.closest_pair(above, square).distance == 0.25


def test_parts_of_meshes(tmp_path):
    path = tmp_path / "plant.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 9 9 9\nv 5 0 0\nv 6 0 0\nf 1 2 3\no left\nf 1 2 3\no right\nf 5 6 3\n")
    with pytest.warns(UserWarning, match="plant.obj: 1 triangle before the first part's name: left out"):
        parts = pcl_bsh.read_mesh_parts(path, unit="m", to_unit="mm")
    assert list(parts) == ["left", "right"]
    vertices, triangles = parts["right"]
    assert vertices["x"].tolist() == [1000, 5000, 6000] and triangles.tolist() == [[1, 2, 0]]
    machines = {name: pcl_bsh.SphereHierarchy.of_triangles(*mesh) for name, mesh in parts.items()}
    found = pcl_bsh.collide_obstacles(pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0]])), machines, 1.0)
    assert found.each["left"].colliding == 1 and found.each["right"].colliding == 0
    with pytest.raises(pcl_bsh.FileError, match="square.off: has no parts with names"):
        pcl_bsh.read_mesh_parts(tmp_path / "square.off")


def test_files_that_cannot_be(tmp_path):
    for error in (ValueError, OSError, pcl_bsh.FileError):
        with pytest.raises(error, match="missing.pcd"):
            pcl_bsh.read(tmp_path / "missing.pcd")
    (tmp_path / "short.pcd").write_text("VERSION 0.7\nFIELDS x y z\n")
    with pytest.raises(pcl_bsh.FileError, match="short.pcd"):
        pcl_bsh.read(tmp_path / "short.pcd")
    with pytest.raises(pcl_bsh.FileError):
        pcl_bsh.write(tmp_path / "cloud.off", records())
    with pytest.raises(ValueError, match="complex128"):
        pcl_bsh.write(tmp_path / "cloud.pcd", np.zeros(2, [("x", "f4"), ("y", "f4"), ("z", "c16")]))
    with pytest.raises(ValueError, match=">f4"):
        pcl_bsh.write(tmp_path / "cloud.pcd", np.zeros(2, [("x", ">f4"), ("y", "f4"), ("z", "f4")]))
    with pytest.raises(ValueError, match=r"\(2, 2\)"):
        pcl_bsh.write(tmp_path / "cloud.pcd", np.zeros((2, 2)))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["short.pcd"]
    with pytest.raises(TypeError):
        pcl_bsh.read(None)


def test_a_pipeline(tmp_path):
    scan, robot = cloud("random", 1, 500), cloud("random", 2, 50)
    pcl_bsh.write(tmp_path / "robot.pcd", robot)
    pose = np.eye(4)
    pose[0, 3] = 0.5
    document = {"pipeline": [
        {"type": "readers.pcd", "filename": "scan.pcd", "tag": "scan"},
        {"type": "filters.bsh_flag", "obstacle": tmp_path / "robot.pcd", "clearance": np.float64(0.05),
         "pose": pose[:3].ravel(), "tag": "flagged"}]}
    told = []
    run = pcl_bsh.run_pipeline(document, {"scan": scan}, progress=told.append)
    expected = pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(scan), pcl_bsh.SphereHierarchy(robot), 0.05, pose_b=pose)
    np.testing.assert_array_equal(run.clouds["flagged"]["collision"], expected)
    assert expected.any() and run.warnings == []
    assert sum(t["done"] for t in told) == len(told) // 2 == told[-1]["finished"] == told[-1]["stages"]
    assert {t["tag"]: t["points"] for t in told if t["done"]}["flagged"] == 500
    again = pcl_bsh.run_pipeline(json.dumps(run.metadata), {"scan": scan})
    np.testing.assert_array_equal(again.clouds["flagged"]["collision"], expected)
    assert pcl_bsh.run_pipeline(document, {"scan": scan}, validate_only=True).clouds == {}
    with pytest.raises(pcl_bsh.Cancelled):
        pcl_bsh.run_pipeline(document, {"scan": scan}, progress=lambda stage: False)

    def fail(stage):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        pcl_bsh.run_pipeline(document, {"scan": scan}, progress=fail)


@pytest.mark.parametrize(
    "document, words",
    [
        ([{"type": "filters.voxel_gird"}], "voxel_grid"),
        ([{"type": "readers.pcd", "filename": "a.pcd"}, {"type": "filters.voxel_grid", "leaf": 1}], "leaf_size"),
        ("{", "pipeline"),
        ({"pipelin": []}, "pipeline"),
        (["no such file.pcd"], "no such file.pcd"),
    ],
)
def test_pipelines_that_cannot_be(document, words):
    for error in (ValueError, pcl_bsh.PipelineError):
        with pytest.raises(error, match=words) as raised:
            pcl_bsh.run_pipeline(document)
        assert "\n" not in str(raised.value)
    with pytest.raises(ValueError, match="no reader"):
        pcl_bsh.run_pipeline([{"type": "readers.pcd", "filename": "a.pcd"}], {"b": cloud("one")})


def test_real_files_read_as_they_are():
    shared = pathlib.Path(__file__).parents[3] / "shared" / "data"
    if not shared.is_dir():
        pytest.skip("no real scans beside the sources")
    read = pcl_bsh.read(shared / "lidar_sweep_a.pcd")
    assert len(pcl_bsh.SphereHierarchy(read)) > 10000


def test_columns_may_be_named(tmp_path):
    rows = "".join(f"{i} {i / 4} 0.5 0.25\n" for i in range(1, 5))
    (tmp_path / "a.xyz").write_text(rows)
    with pytest.warns(UserWarning, match="its first column counts up by one"):
        assert pcl_bsh.read(tmp_path / "a.xyz")["x"][1] == 2
    named = pcl_bsh.read(tmp_path / "a.xyz", columns=["_", "E", "N", "H"])
    assert named.dtype.names == ("x", "y", "z") and named["x"][1] == 0.5
    with pytest.raises(pcl_bsh.FileError, match="names of 3 columns are given"):
        pcl_bsh.read_with_header(tmp_path / "a.xyz", columns=["x", "y", "z"])


def test_the_viewpoint_keeps_its_bits(tmp_path):
    (tmp_path / "a.pcd").write_text(
        "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nVIEWPOINT 500000.123456789 5400000.1 2 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n"
    )
    cloud, header = pcl_bsh.read_with_header(tmp_path / "a.pcd")
    assert header.viewpoint[:2] == (500000.123456789, 5400000.1) and header.coordinate_system == ""
    for name in ("b.pcd", "b.ply"):
        pcl_bsh.write(tmp_path / name, cloud, header)
        assert pcl_bsh.read_with_header(tmp_path / name)[1].viewpoint == header.viewpoint
