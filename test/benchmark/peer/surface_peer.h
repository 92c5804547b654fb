// SPDX-License-Identifier: BSD-3-Clause
// The interface of a library in a race about a mesh. It returns false where it cannot answer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_bsh::bench {

using MeshVertices = std::vector<std::array<double, 3>>;
using MeshTriangles = std::vector<std::array<std::uint32_t, 3>>;

/// Borrows what it is given for as long as it lives.
class SurfacePeer {
public:
  SurfacePeer(const MeshVertices& vertices, const MeshTriangles& triangles) : vertices_(vertices), triangles_(triangles)
  {
  }
  virtual ~SurfacePeer() = default;
  SurfacePeer(const SurfacePeer&) = delete;
  SurfacePeer& operator=(const SurfacePeer&) = delete;

  /// For `count` points x y z: out[i] = 1 where the surface is within d, else 0.
  virtual bool flag(const double*, std::size_t, double /*d*/, std::uint8_t*) { return false; }

  virtual bool distances(const double*, std::size_t, double*) { return false; }

  /// out[i] = 1 where it is inside, else 0.
  virtual bool inside(const double*, std::size_t, std::uint8_t*) { return false; }

  /// For a mesh and itself moved by `shift`: whether any two places are within d; and their smallest distance.
  virtual bool any(const std::array<double, 3>& /*shift*/, double /*d*/, bool*) { return false; }
  virtual bool distance(const std::array<double, 3>& /*shift*/, double*) { return false; }

protected:
  std::array<std::array<double, 3>, 3> triangle(std::size_t i) const
  {
    const auto& [a, b, c] = triangles_[i];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }

  const MeshVertices& vertices_;
  const MeshTriangles& triangles_;
};

struct SurfaceLibrary {
  const char* name;
  std::unique_ptr<SurfacePeer> (*make)(const MeshVertices&, const MeshTriangles&); ///< builds all that it has
  bool labels; ///< made for `inside` alone, or for all else
};

/// Libraries that were found when the build was configured.
std::vector<SurfaceLibrary> surfaceLibraries();

// A file each.
std::unique_ptr<SurfacePeer> makeEmbree(const MeshVertices&, const MeshTriangles&);
std::unique_ptr<SurfacePeer> makeFcl(const MeshVertices&, const MeshTriangles&);
std::unique_ptr<SurfacePeer> makeVtkLocator(const MeshVertices&, const MeshTriangles&);
std::unique_ptr<SurfacePeer> makeVtkEnclosed(const MeshVertices&, const MeshTriangles&);
std::unique_ptr<SurfacePeer> makeCgalTree(const MeshVertices&, const MeshTriangles&);
std::unique_ptr<SurfacePeer> makeCgalSide(const MeshVertices&, const MeshTriangles&);

} // namespace pcl_bsh::bench
