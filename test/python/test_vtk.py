# SPDX-License-Identifier: BSD-3-Clause
"""pcl_bsh.vtk: the filters in a pipeline of Debian's vtkmodules, held against brute force."""
import numpy as np
import pytest

vtk = pytest.importorskip("pcl_bsh.vtk", reason="VTK's wrappers for Python were not found when the package was built")

from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonCore import vtkPoints  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkTable  # noqa: E402
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm, vtkTrivialProducer  # noqa: E402
from vtkmodules.vtkCommonTransforms import vtkTransform  # noqa: E402
from vtkmodules.vtkFiltersSources import vtkSphereSource  # noqa: E402


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
    assert np.array_equal(array(distance, "nearest"), gaps(a, b).argmin(axis=1))


def test_surfaces_and_spheres(clouds):
    ball = vtkSphereSource()
    ball.SetRadius(0.5)
    distance = vtk.vtkBSHDistanceFilter()
    distance.SetInputData(cloud(np.zeros((1, 3))))
    distance.SetObstacleConnection(ball.GetOutputPort())
    distance.SetSurfaceTolerance(0.01)
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
