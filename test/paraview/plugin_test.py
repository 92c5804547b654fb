# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in ParaView: a wagon in a tunnel, held against NumPy's brute force, and its picture.

    pvbatch plugin_test.py PLUGIN FOLDER
"""
import os
import sys

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

plugin, folder = sys.argv[1:3]
CLEARANCE, WAY = 0.25, 12


def save(data, name):
    path = os.path.join(folder, name)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetDataModeToBinary()  # expat, once mended for security, refuses what VTK 9.1 appends
    writer.SetInputDataObject(data)
    assert writer.Write() == 1, path
    return path


def cloud(points):
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    vertices = vtkVertexGlyphFilter()  # ParaView draws cells
    vertices.SetInputData(data)
    vertices.Update()
    return vertices.GetOutput()


def array(proxy, name):
    return vtk_to_numpy(servermanager.Fetch(proxy).GetPointData().GetArray(name))


# A tunnel of rings about the x axis, and a wagon that comes near to its wall in a bend.
x, turn = np.meshgrid(np.arange(0.0, 12.0, 0.1), np.arange(0.0, 2 * np.pi, 0.05))
tunnel = np.c_[x.ravel(), 2 * np.cos(turn).ravel(), 2 * np.sin(turn).ravel()].astype(np.float32)
steps = np.linspace(-1.0, 1.0, 9)
side = np.array(np.meshgrid(steps, steps)).reshape(2, -1).T
wagon = np.concatenate([np.insert(side, k, sign, axis=1) for k in range(3) for sign in (-1.0, 1.0)]).astype(np.float32)
moves = np.c_[np.linspace(1.0, 11.0, WAY), 0.5 * np.sin(np.linspace(0.0, np.pi, WAY)), np.zeros(WAY)]
with open(os.path.join(folder, "poses.csv"), "w") as file:
    file.write("time,tx,ty,tz,qx,qy,qz,qw\n")
    for k, move in enumerate(moves):
        file.write(f"{k},{float(move[0])!r},{float(move[1])!r},{float(move[2])!r},0,0,0,1\n")

gaps = np.stack([np.min(np.linalg.norm((tunnel - move)[:, None].astype(np.float64) - wagon, axis=2), axis=1)
                 for move in moves])
assert np.min(np.abs(gaps - CLEARANCE)) > 1e-9, "no gap is so near to the clearance that rounding decides"
near = gaps <= CLEARANCE
first = np.where(near.any(axis=0), near.argmax(axis=0), -1)
assert 0 < near.any(axis=0).sum() < len(tunnel)

simple.LoadPlugin(plugin, remote=False, ns=globals())
scan = simple.OpenDataFile(save(cloud(tunnel), "tunnel.vtp"))
model = simple.OpenDataFile(save(cloud(wagon), "wagon.vtp"))
poses = simple.CSVReader(FileName=[os.path.join(folder, "poses.csv")])

# Along the path.
along = PointCloudCollision(Input=scan, Obstacle=model, Poses=poses, Clearance=CLEARANCE)  # noqa: F821 - of the plugin
along.UpdatePipeline()
assert np.array_equal(array(along, "collision"), near.any(axis=0))
assert np.array_equal(array(along, "first_pose"), first)
assert np.allclose(array(along, "distance")[first >= 0], gaps.min(axis=0)[first >= 0], rtol=1e-6)

# At one place; the transform moves the obstacle.
placed = PointCloudCollision(Input=scan, Obstacle=model, Clearance=CLEARANCE)  # noqa: F821
placed.Transform = "Transform"
placed.Transform.Translate = [float(v) for v in moves[WAY // 2]]
placed.UpdatePipeline()
assert np.array_equal(array(placed, "collision"), near[WAY // 2])

# Distances, of a surface too.
distance = PointCloudDistance(Input=scan, Obstacle=model)  # noqa: F821
distance.UpdatePipeline()
still = np.min(np.linalg.norm(tunnel[:, None].astype(np.float64) - wagon, axis=2), axis=1)
assert np.allclose(array(distance, "distance"), still, rtol=1e-12)
cube = vtkCubeSource()
cube.SetXLength(2), cube.SetYLength(2), cube.SetZLength(2)
cube.Update()
box = simple.OpenDataFile(save(cube.GetOutput(), "box.vtp"))
surface = PointCloudDistance(Input=scan, Obstacle=box)  # noqa: F821
surface.UpdatePipeline()
true = np.linalg.norm(np.maximum(np.abs(tunnel.astype(np.float64)) - 1.0, 0.0), axis=1)
assert np.allclose(array(surface, "distance"), true, rtol=1e-12)

# Solid: what is inside of the box has a negative distance, and collides.
inner = simple.OpenDataFile(save(cloud(np.float32([[0, 0, 0.25], [0.5, 0, 0], [3, 0, 0]])), "inner.vtp"))
depth = PointCloudDistance(Input=inner, Obstacle=box, Solid=1)  # noqa: F821
depth.UpdatePipeline()
assert np.array_equal(array(depth, "distance"), [-0.75, -0.5, 2.0])
held = PointCloudCollision(Input=inner, Obstacle=box, Solid=1)  # noqa: F821
held.UpdatePipeline()
assert np.array_equal(array(held, "collision"), [1, 1, 0])

spheres = BoundingSpheres(Input=scan, Level=1)  # noqa: F821
spheres.UpdatePipeline()
assert servermanager.Fetch(spheres).GetNumberOfCells() > 0

# The picture: blue is free, what collides has the colour of its first pose.
view = simple.CreateView("RenderView")
view.ViewSize, view.Background = [600, 400], [1, 1, 1]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 0
shown = simple.Show(along, view, "GeometryRepresentation")
shown.SetRepresentationType("Points")
shown.PointSize = 3
simple.ColorBy(shown, ("POINTS", "first_pose"))
colours = simple.GetColorTransferFunction("first_pose")
colours.ColorSpace = "RGB"
colours.RGBPoints = [-1, 0.0, 0.0, 1.0, 0, 0.0, 0.0, 1.0, 0.5, 1.0, 0.0, 0.0, WAY, 1.0, 1.0, 0.0]
shown.SetScalarBarVisibility(view, False)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [9, 13, 5], [6, 0, 0], [0, 0, 1]
simple.SaveScreenshot(os.path.join(folder, "first_pose.png"), view, ImageResolution=[600, 400])

reader = vtkPNGReader()
reader.SetFileName(os.path.join(folder, "first_pose.png"))
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)
blue = np.sum((pixels[:, 2] > 150) & (pixels[:, 0] < 80))
warm = np.sum((pixels[:, 0] > 150) & (pixels[:, 2] < 80))
assert blue > 5000 and warm > 200, (blue, warm)
print(f"passed: {near.any(axis=0).sum()} of {len(tunnel)} points collide; {blue} blue and {warm} warm pixels")
