// SPDX-License-Identifier: BSD-3-Clause
// A hierarchy as VTK's data: spheres of a level, voxels, octree cells, and the spheres that a query tested.
//
// Levels count as those of Accuracy::level(): 0 the voxels' spheres, each level more one node further down; where a
// tree ends before, its leaves stay. A level above 0 builds every voxel.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/pairs/trace.h>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// The deepest level: all its spheres are those of leaves. Builds every voxel.
unsigned deepestLevel(const SphereHierarchy& hierarchy);

/// The level's spheres, a point at each centre. Point arrays: `radius` (cloud's unit), `level`, `voxel` (number, in
/// Morton order), `points` (how many it holds).
vtkSmartPointer<vtkPolyData> sphereData(const SphereHierarchy& hierarchy, unsigned level);

/// The spheres of a trace, a point at each centre, in the cloud's frame. Point arrays: `radius`, `level`, `fate` (a
/// SphereFate as a number).
vtkSmartPointer<vtkPolyData> traceData(const std::vector<TracedSphere>& spheres);

/// Triangles for each sphere of sphereData() or traceData(), with its arrays at every corner.
/// @param resolution corners around the equator, at least 3
vtkSmartPointer<vtkPolyData> sphereGlyphs(vtkPolyData& spheres, int resolution = 12);

/// The occupied cubes of the voxel grid, twelve lines each. Cell array `voxel`. Rounding may put a point into the next
/// cube, from which it is then within 1e-4 of an edge.
vtkSmartPointer<vtkPolyData> voxelBoxes(const SphereHierarchy& hierarchy);

/// The boxes around the points of the level's octree cells, twelve lines each. Cell arrays: `voxel`, `level`.
vtkSmartPointer<vtkPolyData> cellBoxes(const SphereHierarchy& hierarchy, unsigned level);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
