# SPDX-License-Identifier: BSD-3-Clause
"""pcl_bsh.vtk: the filters in a pipeline of Debian's vtkmodules, held against brute force."""
import ast
import re

import numpy as np
import pytest

vtk = pytest.importorskip("pcl_bsh.vtk", reason="VTK's wrappers for Python were not found when the package was built")

from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonCore import vtkPoints  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkTable  # noqa: E402
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm, vtkTrivialProducer  # noqa: E402
from vtkmodules.vtkCommonTransforms import vtkTransform  # noqa: E402
from vtkmodules.vtkFiltersSources import vtkSphereSource  # noqa: E402

from stubs import PACKAGE, mypy_errors  # noqa: E402


def cloud(points):
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    return data


def array(algorithm, name):
    return vtk_to_numpy(algorithm.GetOutput().GetPointData().GetArray(name))


def gaps(a, b):
    return np.linalg.norm(a[:, None].astype(float) - b, axis=2)


@pytest.fixture(params=[np.float32, np.float64])
def clouds(request):
    random = np.random.default_rng(7)
    return random.random((400, 3)).astype(request.param), random.random((60, 3)).astype(request.param)


def test_collisions(clouds):
    a, b = clouds
    collision = vtk.vtkBSHCollisionFilter()
    assert isinstance(collision, vtk.vtkBSHFilter) and isinstance(collision, vtkPolyDataAlgorithm)
    collision.SetInputData(cloud(a))
    collision.SetObstacleData(cloud(b))
    move = vtkTransform()
    collision.SetTransform(move)
    collision.SetClearance(0.08)
    for shift in (0.0, 0.25):
        move.Identity()
        move.Translate(shift, 0, 0)
        collision.Update()
        near = gaps(a, b + np.array([shift, 0, 0])).min(axis=1) <= 0.08
        assert 0 < near.sum() < len(a)
        assert np.array_equal(array(collision, "collision"), near)
        assert collision.GetNumberOfCollidingPoints() == near.sum()
    assert collision.GetHierarchiesBuilt() == 2  # a new pose builds nothing


def test_a_path_and_connections(clouds):
    a, b = clouds
    shifts = np.linspace(-1.0, 1.0, 5)
    table = vtkTable()
    for column in range(12):
        values = shifts if column == 3 else np.full(5, float(column in (0, 5, 10)))
        data = numpy_to_vtk(values, deep=True)
        data.SetName(str(column))
        table.AddColumn(data)
    sources = []
    for data in (cloud(a), cloud(b), table):
        sources.append(vtkTrivialProducer())
        sources[-1].SetOutput(data)
    collision = vtk.vtkBSHCollisionFilter()
    collision.SetInputConnection(sources[0].GetOutputPort())
    collision.SetObstacleConnection(sources[1].GetOutputPort())
    collision.SetPosesConnection(sources[2].GetOutputPort())
    collision.SetClearance(0.1)
    told = []
    collision.AddObserver("ProgressEvent", lambda caller, event: told.append(caller.GetProgress()))
    collision.Update()
    near = np.stack([gaps(a, b + np.array([shift, 0, 0])).min(axis=1) <= 0.1 for shift in shifts])
    first = np.where(near.any(axis=0), near.argmax(axis=0), -1)
    assert np.array_equal(array(collision, "first_pose"), first)
    assert told[-1] == 1.0


def test_distances(clouds):
    a, b = clouds
    distance = vtk.vtkBSHDistanceFilter()
    distance.SetInputData(cloud(a))
    distance.SetObstacleData(cloud(b))
    distance.Update()
    assert np.allclose(array(distance, "distance"), gaps(a, b).min(axis=1), rtol=1e-12)
    assert np.array_equal(array(distance, "closest_point"), gaps(a, b).argmin(axis=1))


def test_surfaces_and_spheres(clouds):
    ball = vtkSphereSource()
    ball.SetRadius(0.5)
    distance = vtk.vtkBSHDistanceFilter()
    distance.SetInputData(cloud(np.zeros((1, 3))))
    distance.SetObstacleConnection(ball.GetOutputPort())
    distance.Update()
    assert 0.4 < array(distance, "distance")[0] < 0.5

    spheres = vtk.vtkBSHSphereSource()
    spheres.SetInputData(cloud(clouds[0]))
    spheres.SetLevel(2)
    spheres.Update()
    assert array(spheres, "points").sum() == len(clouds[0])


def test_what_fails_has_no_answer(clouds):
    collision = vtk.vtkBSHCollisionFilter()
    collision.SetInputData(cloud(clouds[0]))
    collision.SetObstacleData(cloud(clouds[1]))
    collision.SetClearance(-1.0)
    told = []
    collision.AddObserver("ErrorEvent", lambda caller, event: told.append(event))
    collision.GetExecutive().AddObserver("ErrorEvent", lambda caller, event: None)
    collision.Update()
    assert told == ["ErrorEvent"]
    assert collision.GetOutput().GetNumberOfPoints() == 0


def test_stubs(tmp_path):
    assert mypy_errors(
        tmp_path,
        "import pcl_bsh.vtk\n"
        "collision = pcl_bsh.vtk.vtkBSHCollisionFilter()\n"
        "collision.SetClearance(0.05)\n"
        "collision.SetTransform(None)\n"
        "near: int = collision.GetNumberOfCollidingPoints()\n"
        "collision.SetClearance('near')  # error\n"
        "collision.SetSwept()  # error\n"
        "text: str = pcl_bsh.vtk.vtkBSHSphereSource().GetLevel()  # error\n"
        "pcl_bsh.vtk.vtkBSHPathFilter()  # error\n") == [6, 7, 8, 9]


def test_stubs_say_what_the_wrappers_say():
    """VTK's wrappers write each method's signature into its docstring; None stands for a null object."""
    stub = ast.parse((PACKAGE / "vtk.pyi").read_text())
    named = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    assert set(named) == {name for name in vars(vtk) if name.startswith("vtk")}
    of_objects = {"IsTypeOf", "IsA", "GetNumberOfGenerationsFromBaseType", "GetNumberOfGenerationsFromBase"}
    for name, node in named.items():
        wrapped = getattr(vtk, name)
        assert [ast.unparse(base) for base in node.bases] == [wrapped.__bases__[0].__name__]
        methods = {part.name: part for part in node.body if part.name != "__init__"}
        assert set(methods) == {m for m in vars(wrapped) if not m.startswith("__")} - of_objects, name
        for method, part in methods.items():
            told = re.sub(r"\s+", " ", getattr(wrapped, method).__doc__.split("C++:")[0]).strip()
            arguments = ", ".join(
                a.arg + (f":{ast.unparse(a.annotation)}" if a.annotation else "") for a in part.args.args)
            said = f"{method}({arguments}) -> {ast.unparse(part.returns)}"
            assert re.sub(r"Optional\[(\w+)\]", r"\1", said) == told
