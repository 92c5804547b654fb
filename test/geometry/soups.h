// SPDX-License-Identifier: BSD-3-Clause
// Closed triangles that tests make.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <array>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

using Soup = std::vector<Triangle3>;

/// A box, fronts outward, each side of two triangles.
inline Soup boxOf(const Point3& low, const Point3& high)
{
  const auto corner = [&](int bits) {
    return Point3{(bits & 1) != 0 ? high[0] : low[0], (bits & 2) != 0 ? high[1] : low[1],
                  (bits & 4) != 0 ? high[2] : low[2]};
  };
  Soup soup;
  for (const auto& side : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                           std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    soup.push_back({corner(side[0]), corner(side[1]), corner(side[2])});
    soup.push_back({corner(side[0]), corner(side[2]), corner(side[3])});
  }
  return soup;
}

inline Soup tetrahedronOf(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
{
  return {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
}

inline Soup flipped(Soup soup)
{
  for (Triangle3& t : soup) std::swap(t[0], t[1]);
  return soup;
}

inline Soup both(Soup x, const Soup& y)
{
  x.insert(x.end(), y.begin(), y.end());
  return x;
}

} // namespace pcl_bsh::test
