// SPDX-License-Identifier: BSD-3-Clause
// Which points or triangles of a file lie within the clearance of a mesh, and which points does it enclose? Asked of
// us, or of one of our peers: what test/hard_cases/run_surfaces.py runs.
//
//   hard_surfaces_peers PEER within|labels INPUT.pcd|INPUT.off MESH.off CLEARANCE [T_input_mesh, twelve numbers]
//
// Prints a digit for each: 1 within; 0 outside, 1 inside, 2 on the surface. Peers are given the mesh turned in double.
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/solid/labels.h>

#include "support/off_mesh.h"
#include "support/pcd_points.h"

#define CGAL_NO_DEPRECATION_WARNINGS // of headers that CGAL 6 has by other names
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>
#include <fcl/fcl.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelectEnclosedPoints.h>
#include <vtkStaticCellLocator.h>

#include <iostream>
#include <optional>
#include <string>

namespace pcl_bsh {
namespace {

struct Question {
  std::vector<Point3> points; ///< or triangles, in `other`
  std::optional<test::OffMesh> other;
  test::OffMesh mesh, moved; ///< as given, and as those have it who move vertices and round them
  double clearance = 0.0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();

  std::size_t count() const { return other ? other->triangles.size() : points.size(); }
};

[[noreturn]] void refuse(const char* what)
{
  throw std::runtime_error(std::string("has no such question: ") + what);
}

// Ours --------------------------------------------------------------------------------------------------------------

std::string withinOurs(const Question& q)
{
  const SphereHierarchy a(q.other ? viewOf(q.other->view()) : viewOf(q.points.front().data(), q.points.size())),
      b(viewOf(q.mesh.view()));
  FlagsRequest request;
  request.clearance = q.clearance;
  std::string digits;
  for (const Verdict verdict : collisionFlags({a}, {b, q.pose}, request).a)
    digits += verdict == Verdict::colliding ? '1' : '0';
  return digits;
}

std::string labelsOurs(const Question& q)
{
  const SphereHierarchy a(viewOf(q.points.front().data(), q.points.size()));
  const Solid solid(q.mesh.view());
  std::string digits;
  for (const std::uint8_t label : labelPoints({a}, {solid, q.pose}).labels) digits += static_cast<char>('0' + label);
  return digits;
}

// FCL: the smallest distance of each triangle, of points that of a triangle without extent
// -----------------------------

using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<FclMesh> toFcl(const std::vector<Point3>& vertices, const std::vector<Triangle>& triangles)
{
  auto mesh = std::make_shared<FclMesh>();
  std::vector<fcl::Vector3d> points;
  std::vector<fcl::Triangle> faces;
  for (const Point3& p : vertices) points.emplace_back(p[0], p[1], p[2]);
  for (const Triangle& t : triangles) faces.emplace_back(t[0], t[1], t[2]);
  mesh->beginModel();
  mesh->addSubModel(points, faces);
  mesh->endModel();
  return mesh;
}

std::string withinFcl(const Question& q)
{
  const auto mesh = toFcl(q.moved.vertices, q.moved.triangles);
  std::string digits;
  for (std::size_t i = 0; i < q.count(); ++i) {
    std::vector<Point3> corners(3, q.other ? Point3{} : q.points[i]);
    for (std::size_t k = 0; q.other && k < 3; ++k) corners[k] = q.other->vertices[q.other->triangles[i][k]];
    const auto one = toFcl(corners, {{0, 1, 2}});
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    const auto origin = fcl::Transform3d::Identity();
    const double distance = fcl::distance(one.get(), origin, mesh.get(), origin, request, result);
    digits += distance <= q.clearance ? '1' : '0';
  }
  return digits;
}

std::string labelsFcl(const Question&)
{
  refuse("FCL");
}

// CGAL with a kernel of doubles
// ----------------------------------------------------------------------------------------

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

Surface toCgal(const test::OffMesh& mesh)
{
  Surface made;
  std::vector<Surface::Vertex_index> vertices;
  for (const Point3& p : mesh.vertices) vertices.push_back(made.add_vertex({p[0], p[1], p[2]}));
  for (const Triangle& t : mesh.triangles)
    if (made.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) == Surface::null_face())
      throw std::runtime_error("CGAL does not take the mesh");
  return made;
}

std::string withinCgal(const Question& q)
{
  if (q.other) refuse("triangles within a distance");
  const Surface mesh = toCgal(q.moved);
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Surface>;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(faces(mesh).first, faces(mesh).second, mesh);
  std::string digits;
  for (const Point3& p : q.points)
    digits += tree.squared_distance({p[0], p[1], p[2]}) <= q.clearance * q.clearance ? '1' : '0';
  return digits;
}

std::string labelsCgal(const Question& q)
{
  const Surface mesh = toCgal(q.moved);
  if (!CGAL::is_closed(mesh)) throw std::runtime_error("CGAL says it is not closed");
  const CGAL::Side_of_triangle_mesh<Surface, Kernel> side(mesh);
  std::string digits;
  for (const Point3& p : q.points) {
    const CGAL::Bounded_side on = side({p[0], p[1], p[2]});
    digits += on == CGAL::ON_BOUNDARY ? '2' : on == CGAL::ON_BOUNDED_SIDE ? '1' : '0';
  }
  return digits;
}

// VTK
// ---------------------------------------------------------------------------------------------------------------------

vtkNew<vtkPoints> toVtk(const std::vector<Point3>& points)
{
  vtkNew<vtkPoints> made;
  made->SetDataTypeToDouble();
  for (const Point3& p : points) made->InsertNextPoint(p.data());
  return made;
}

vtkNew<vtkPolyData> toVtk(const test::OffMesh& mesh)
{
  vtkNew<vtkPolyData> made;
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : mesh.triangles) {
    const vtkIdType corners[3] = {t[0], t[1], t[2]};
    cells->InsertNextCell(3, corners);
  }
  made->SetPoints(toVtk(mesh.vertices));
  made->SetPolys(cells);
  return made;
}

std::string withinVtk(const Question& q)
{
  if (q.other) refuse("triangles within a distance");
  const vtkNew<vtkPolyData> mesh = toVtk(q.moved);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(mesh);
  locator->BuildLocator();
  std::string digits;
  for (const Point3& p : q.points) {
    double nearest[3], squared = 0.0;
    vtkIdType cell = 0;
    int part = 0;
    locator->FindClosestPoint(p.data(), nearest, cell, part, squared);
    digits += squared <= q.clearance * q.clearance ? '1' : '0';
  }
  return digits;
}

std::string labelsVtk(const Question& q)
{
  const vtkNew<vtkPolyData> mesh = toVtk(q.moved);
  vtkNew<vtkPolyData> points;
  points->SetPoints(toVtk(q.points));
  vtkNew<vtkSelectEnclosedPoints> select;
  select->SetInputData(points);
  select->SetSurfaceData(mesh);
  select->SetTolerance(0.0);
  select->Update();
  std::string digits;
  for (std::size_t i = 0; i < q.points.size(); ++i) digits += select->IsInside(static_cast<vtkIdType>(i)) ? '1' : '0';
  return digits;
}

// The program
// -------------------------------------------------------------------------------------------------------------

struct Peer {
  const char* name;
  std::string (*within)(const Question&);
  std::string (*labels)(const Question&);
};

constexpr Peer peers[] = {{"pcl_bsh", withinOurs, labelsOurs},
                          {"fcl", withinFcl, labelsFcl},
                          {"cgal", withinCgal, labelsCgal},
                          {"vtk", withinVtk, labelsVtk}};

Question read(const std::vector<std::string>& words)
{
  Question question;
  if (words[2].ends_with(".off"))
    question.other = test::readOffMesh(words[2]);
  else
    question.points = test::readPcdPoints(words[2]).points;
  question.moved = question.mesh = test::readOffMesh(words[3]);
  question.clearance = std::stod(words[4]);
  for (std::size_t i = 5; i < words.size(); ++i)
    question.pose.matrix()(static_cast<Eigen::Index>(i - 5) / 4, static_cast<Eigen::Index>(i - 5) % 4) =
        std::stod(words[i]);
  if (!question.pose.matrix().isIdentity(0.0))
    for (Point3& p : question.moved.vertices) {
      const Eigen::Vector3d at = question.pose * Eigen::Vector3d(p[0], p[1], p[2]);
      p = {at[0], at[1], at[2]};
    }
  return question;
}

} // namespace
} // namespace pcl_bsh

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  const pcl_bsh::Peer* peer = nullptr;
  for (const pcl_bsh::Peer& any : pcl_bsh::peers)
    if (!words.empty() && words.front() == any.name) peer = &any;
  if (!peer || (words.size() != 5 && words.size() != 17) || (words[1] != "within" && words[1] != "labels")) {
    std::cerr << "usage: " << argv[0]
              << " PEER within|labels INPUT.pcd|INPUT.off MESH.off CLEARANCE [T_input_mesh, twelve numbers]\nPEER:";
    for (const pcl_bsh::Peer& any : pcl_bsh::peers) std::cerr << ' ' << any.name;
    std::cerr << '\n';
    return 2;
  }
  try {
    const pcl_bsh::Question question = pcl_bsh::read(words);
    std::cout << (words[1] == "within" ? peer->within : peer->labels)(question) << '\n';
  }
  catch (const std::exception& error) {
    std::cerr << "hard_surfaces_peers: " << error.what() << '\n';
    return 1;
  }
}
