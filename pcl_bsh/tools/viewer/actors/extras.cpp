// SPDX-License-Identifier: BSD-3-Clause
#include "extras.h"

#include "caption.h"

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/solid/open_edges.h>
#include <pcl_bsh/vtk/contact_data.h>
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/path_data.h>

#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkLineSource.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace pcl_bsh::viewer {
namespace {

/// Three great circles of radius 1: they outline a sphere from every side.
vtkSmartPointer<vtkPolyData> circles()
{
  constexpr int corners = 96;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  for (int axis = 0; axis < 3; ++axis) {
    lines->InsertNextCell(corners + 1);
    for (int i = 0; i <= corners; ++i) {
      double p[3] = {0, 0, 0};
      p[axis] = std::cos(2 * std::numbers::pi * i / corners);
      p[(axis + 1) % 3] = std::sin(2 * std::numbers::pi * i / corners);
      lines->InsertCellPoint(points->InsertNextPoint(p));
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

/// Adds translucent spheres, outlined where they are not too many. @param spheres points with an array `radius`
void addSpheres(PropGroup& group, vtkPolyData& spheres, const Eigen::Isometry3d& pose, const Color& color,
                double opacity)
{
  if (spheres.GetNumberOfPoints() == 0) return;
  const auto add = [&](vtkPolyData* shape, double how_opaque) {
    vtkNew<vtkGlyph3DMapper> mapper;
    mapper->SetInputData(&spheres);
    mapper->SetSourceData(shape);
    mapper->SetScaleArray("radius");
    mapper->SetScaleModeToScaleByMagnitude();
    mapper->SetScaleFactor(1.0);
    mapper->ScalarVisibilityOff();
    const auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    setColor(*actor, color);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetOpacity(how_opaque);
    actor->SetUserMatrix(matrixOf(pose));
    group.add(actor);
  };
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1.0);
  const vtkIdType count = spheres.GetNumberOfPoints();
  const int corners = count > 20'000 ? 8 : count > 500 ? 20 : 48;
  ball->SetThetaResolution(corners);
  ball->SetPhiResolution(corners);
  ball->Update();
  // The more there are, the less each may hide.
  const double crowd = std::clamp(40.0 / std::sqrt(static_cast<double>(count)), 0.15, 1.0);
  add(ball->GetOutput(), opacity * crowd);
  if (count <= 20'000) add(circles(), std::min(1.0, 0.15 + 2.5 * opacity * crowd));
}

void addWires(PropGroup& group, vtkPolyData& boxes, const Eigen::Isometry3d& pose, const Color& color)
{
  const auto actor = actorOf(&boxes);
  actor->GetMapper()->ScalarVisibilityOff();
  setColor(*actor, color);
  actor->GetProperty()->SetOpacity(0.6);
  actor->SetUserMatrix(matrixOf(pose));
  group.add(actor);
}

/// Opened spheres are drawn as their children, so each place is drawn once.
void addTraced(PropGroup& group, const std::vector<TracedSphere>& all, const Eigen::Isometry3d& pose)
{
  for (const SphereFate fate : {SphereFate::pruned, SphereFate::kept, SphereFate::compared}) {
    std::vector<TracedSphere> some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some),
                 [fate](const TracedSphere& sphere) { return sphere.fate == fate; });
    const double opacity = fate == SphereFate::compared ? 0.6 : fate == SphereFate::kept ? 0.3 : 0.12;
    addSpheres(group, *vtk::traceData(some), pose, fate_colors[static_cast<std::size_t>(fate)], opacity);
  }
}

void addBeams(PropGroup& group, const ViewContent& content)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (const std::array<Eigen::Vector3d, 2>& beam : content.beams()) {
    lines->InsertNextCell(2);
    for (const Eigen::Vector3d& end : beam) lines->InsertCellPoint(points->InsertNextPoint(end.data()));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  const auto actor = actorOf(data);
  setColor(*actor, path_color);
  actor->GetProperty()->SetOpacity(0.25);
  group.add(actor);
}

std::vector<OpenEdge> listOpenEdges(const ViewedCloud& viewed)
{
  std::vector<OpenEdge> edges;
  if (const TrianglesView* const triangles = viewed.points().triangles) openEdgesOf(*triangles, &edges);
  return edges;
}

/// Adds open edges, in front of all else because they lie in a surface, or behind it.
void addOpenEdges(PropGroup& group, const ViewedCloud& viewed, const Eigen::Isometry3d& pose)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (const OpenEdge& edge : listOpenEdges(viewed)) {
    const vtkIdType from = points->InsertNextPoint(edge.from.data());
    lines->InsertNextCell({from, points->InsertNextPoint(edge.to.data())});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  const auto actor = actorOf(data);
  setColor(*actor, open_edge_color);
  actor->GetProperty()->SetLineWidth(4.0f);
  actor->GetMapper()->SetResolveCoincidentTopologyToPolygonOffset();
  actor->GetMapper()->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -66000.0);
  actor->SetUserMatrix(matrixOf(pose));
  group.add(actor);
}

} // namespace

std::size_t openEdgesOf(const ViewedCloud& viewed)
{
  return listOpenEdges(viewed).size();
}

void addExtras(PropGroup& group, const ViewContent& content, const Extras& extras, std::size_t step)
{
  for (std::size_t i = 0; i < content.viewedClouds().size(); ++i) {
    const SphereHierarchy& hierarchy = *content.viewedClouds()[i].hierarchy;
    const Eigen::Isometry3d pose = content.poseOf(i, step);
    if (extras.level) addSpheres(group, *vtk::sphereData(hierarchy, *extras.level), pose, sphere_color, 0.16);
    if (extras.voxels) addWires(group, *vtk::voxelBoxes(hierarchy), pose, voxel_color);
    if (extras.open_edges) addOpenEdges(group, content.viewedClouds()[i], pose);
    if (extras.cells) addWires(group, *vtk::cellBoxes(hierarchy, extras.level.value_or(1)), pose, cell_color);
  }
  if (extras.beams) addBeams(group, content);
  if (!extras.trace) return;
  for (const Trace& query : content.traces(step)) {
    addTraced(group, query.trace.a, content.poseOf(query.a, step));
    addTraced(group, query.trace.b, content.poseOf(query.b, step));
  }
}

void addClosestPair(PropGroup& group, const ClosestPair& closest, const std::string& text)
{
  vtkNew<vtkLineSource> line;
  line->SetPoint1(closest.a.data());
  line->SetPoint2(closest.b.data());
  line->Update();
  const auto segment = actorOf(line->GetOutput());
  setColor(*segment, segment_color);
  segment->GetProperty()->SetLineWidth(3.0f);
  group.add(segment);
  vtkNew<vtkBillboardTextActor3D> label;
  const Eigen::Vector3d middle = (closest.a + closest.b) / 2;
  label->SetPosition(middle.x(), middle.y(), middle.z());
  label->SetDisplayOffset(8, 8);
  label->SetInput(text.c_str());
  const std::array<double, 3> c = fractions(segment_color);
  label->GetTextProperty()->SetColor(c[0], c[1], c[2]);
  label->GetTextProperty()->SetFontSize(text_size);
  setBacking(*label->GetTextProperty());
  group.add(label.Get());
}

void addContacts(PropGroup& group, const std::vector<Contact>& contacts, double length)
{
  if (contacts.empty()) return;
  const auto arrows = vtk::contactArrows(*vtk::contactData(contacts), length);
  vtkDataArray& gaps = *arrows->GetPointData()->GetArray("gap");
  setColors(*arrows->GetPointData(), arrows->GetNumberOfPoints(),
            [&](vtkIdType i) { return gaps.GetTuple1(i) < 0.0 ? overlap_color : contact_color; });
  const auto actor = actorOf(arrows);
  vtkMapper& mapper = *actor->GetMapper();
  mapper.SetResolveCoincidentTopologyToPolygonOffset();
  mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -1e9); // in front of what they point into
  group.add(actor);
}

void addPaths(PropGroup& group, const MotionPaths& paths)
{
  for (const std::vector<Eigen::Isometry3d>& motion : paths.poses) {
    const auto line = actorOf(vtk::pathData(motion));
    line->GetMapper()->ScalarVisibilityOff();
    setColor(*line, path_color);
    line->GetProperty()->SetLineWidth(2.0f);
    group.add(line);
  }
}

} // namespace pcl_bsh::viewer
