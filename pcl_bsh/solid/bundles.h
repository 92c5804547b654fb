// SPDX-License-Identifier: BSD-3-Clause
// A tree of bundles of triangles that lie nearly alike, as those of nested shells do: a ray crosses a bundle as a
// whole.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/solid/upward_ray.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_bsh {

/// The corners of a bundle's triangles are within a reach of those of a middle triangle. A ray crosses all of them as
/// it crosses the middle one, unless it passes its edges as near, or begins as near to it.
///
/// Error bound, with E per axis for the corners as seen from the place. A side errs by less than E times the sum of its
/// four coordinates, and 2 E^2. The volume errs by less than E times the sum of its cofactors, 2 E^2 times the sum of
/// its coordinates, and 6 E^3. Roundings in double add less than 16 v of the largest terms.
class Bundles {
public:
  /// @param first, last numbers of the triangles; brought into the tree's order @param seen the corners of one
  /// @param boxes of all triangles
  Bundles(std::uint32_t* first, std::uint32_t* last, const std::function<Triangle3(std::uint32_t)>& seen,
          const FloatBox* boxes);

  /// Appends the triangles that the ray from a place within `error` of `at`, per axis, may meet or begin on; perhaps
  /// others.
  /// @param first numbers of the triangles, as the constructor left them. @param looked_at bundles are added
  /// @return how often the ray surely crosses triangles that are not appended, fronts less backs
  int collect(const std::uint32_t* first, const Point3& at, double error, std::vector<std::uint32_t>& found,
              std::uint64_t& looked_at) const;

  std::size_t bytes() const noexcept { return bundles_.capacity() * sizeof(Bundle); }

private:
  struct Bundle {
    FloatBox box;               ///< of all
    float corners[3][3];        ///< of the middle triangle
    float reach;                ///< how far corners of its triangles are from these at most, per axis
    std::uint32_t begin, count; ///< triangles
    std::uint32_t next;         ///< the first bundle after this one and all below it
  };

  struct Alike;
  void bundle(Alike* first, Alike* last, std::uint32_t begin, const FloatBox* boxes);

  std::vector<Bundle> bundles_;
};

} // namespace pcl_bsh
