// SPDX-License-Identifier: BSD-3-Clause
// The bodies of a solid: its connected parts.
#pragma once

#include <pcl_bsh/base/made_once.h>
#include <pcl_bsh/solid/solid.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_bsh {

/// Finite triangles that share corners, by equal coordinates, are of one body. Each body closes by itself; so what is
/// inside the solid is inside one of them at least.
///
/// Edges on a line cancel if and only if at each place as many begin as end (open_edges.cpp). All edges at a place are
/// of one body: so those of each body cancel, also where corners of one lie within edges of another.
class SolidBodies {
public:
  /// Costs nothing until it is asked. @param solid borrowed
  explicit SolidBodies(const Solid& solid) : solid_(solid) {}

  /// One body. Where there is only one, its solid is the whole.
  struct Body {
    std::vector<std::uint32_t> triangles; ///< of the whole, ascending
    std::vector<Triangle> corners;        ///< of these; empty where it is the whole
    std::unique_ptr<const Solid> own;
  };

  /// Returns the bodies, in the order of their first triangles. Made once, by whichever thread comes first.
  const std::vector<Body>& all() const;

  const Solid& whole() const noexcept { return solid_; }
  const Solid& solidOf(const Body& body) const noexcept { return body.own ? *body.own : solid_; }

private:
  const Solid& solid_;
  mutable MadeOnce<const std::vector<Body>> bodies_;
};

} // namespace pcl_bsh
