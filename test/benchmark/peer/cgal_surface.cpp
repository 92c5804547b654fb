// SPDX-License-Identifier: BSD-3-Clause
// CGAL: its AABB tree with doubles, and the side of a mesh with filtered exact predicates. Its licence is the GPL: a
// benchmark that links it is not to be distributed.
#include "surface_peer.h"

#define CGAL_NO_DEPRECATION_WARNINGS // of headers that CGAL 6 has by other names
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <optional>

namespace pcl_bsh::bench {
namespace {

class Tree final : public SurfacePeer {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
  using Traits = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>;

public:
  Tree(const MeshVertices& vertices, const MeshTriangles& triangles) : SurfacePeer(vertices, triangles)
  {
    const auto place = [](const std::array<double, 3>& p) { return Kernel::Point_3(p[0], p[1], p[2]); };
    faces_.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto t = triangle(i);
      faces_.emplace_back(place(t[0]), place(t[1]), place(t[2]));
    }
    tree_.insert(faces_.begin(), faces_.end());
    tree_.build();
    tree_.accelerate_distance_queries();
  }

  bool flag(const double* xyz, std::size_t count, double d, std::uint8_t* out) override
  {
    for (std::size_t i = 0; i < count; ++i) out[i] = squared(xyz + 3 * i) <= d * d ? 1 : 0;
    return true;
  }

  bool distances(const double* xyz, std::size_t count, double* out) override
  {
    for (std::size_t i = 0; i < count; ++i) out[i] = std::sqrt(squared(xyz + 3 * i));
    return true;
  }

private:
  double squared(const double* p) const { return tree_.squared_distance(Kernel::Point_3(p[0], p[1], p[2])); }

  std::vector<Kernel::Triangle_3> faces_;
  CGAL::AABB_tree<Traits> tree_;
};

class Side final : public SurfacePeer {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

public:
  Side(const MeshVertices& vertices, const MeshTriangles& triangles) : SurfacePeer(vertices, triangles)
  {
    for (const auto& p : vertices) mesh_.add_vertex({p[0], p[1], p[2]});
    for (const auto& t : triangles)
      mesh_.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
    side_.emplace(mesh_);
  }

  bool inside(const double* xyz, std::size_t count, std::uint8_t* out) override
  {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = (*side_)({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}) != CGAL::ON_UNBOUNDED_SIDE ? 1 : 0;
    return true;
  }

private:
  Mesh mesh_;
  std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side_;
};

} // namespace

std::unique_ptr<SurfacePeer> makeCgalTree(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  return std::make_unique<Tree>(vertices, triangles);
}

std::unique_ptr<SurfacePeer> makeCgalSide(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  return std::make_unique<Side>(vertices, triangles);
}

} // namespace pcl_bsh::bench
