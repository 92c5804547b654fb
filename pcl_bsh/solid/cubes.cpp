// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/cubes.h>

#include <pcl_bsh/solid/cells_along.h>
#include <pcl_bsh/solid/clip.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Parts of a cube's width. Corners in one part count as equal.
constexpr std::uint32_t kParts = 8;
constexpr std::size_t kManyLong = 1024;   ///< the first long triangles, each of which is marked by itself
constexpr std::uint32_t kLatelyBits = 12; ///< of the number of later ones that are remembered

} // namespace

Cubes::Cubes(const Point3& low, const Point3& high) : low_(low), high_(high), marked_(kCubes * kCubes, 0)
{
  for (std::size_t k = 0; k < 3; ++k) per_[k] = high[k] - low[k] > 0.0 ? kCubes / (high[k] - low[k]) : 0.0;
}

std::uint32_t Cubes::cubeOf(double x, std::size_t axis) const noexcept
{
  return cellAlong(x, low_[axis], per_[axis], kCubes);
}

Cubes::Rough Cubes::roughOf(const Triangle3& triangle) const noexcept
{
  constexpr auto kPlaces = static_cast<std::uint32_t>(kParts * kCubes);
  Rough rough = {0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      rough[i] = rough[i] * kPlaces + cellAlong(triangle[i][k], low_[k], kParts * per_[k], kPlaces);
  return rough;
}

/// Whether a triangle with its corners in the same parts is remembered as marked. Remembers this one.
bool Cubes::wasMarked(const Triangle3& triangle)
{
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  if (lately_.empty()) lately_.assign(std::size_t{1} << kLatelyBits, {kNone, kNone, kNone});
  const Rough rough = roughOf(triangle);
  std::uint32_t hash = 0;
  for (const std::uint32_t part : rough) hash = (hash ^ part) * 0x9e3779b1u;
  Rough& slot = lately_[hash >> (32 - kLatelyBits)];
  if (slot == rough) return true;
  slot = rough;
  return false;
}

void Cubes::mark(const Triangle3& triangle)
{
  bool is_long = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, most] = std::minmax({triangle[0][k], triangle[1][k], triangle[2][k]});
    is_long = is_long || cubeOf(most, k) - cubeOf(least, k) > 2;
  }
  if (!is_long || ++long_ones_ <= kManyLong) return mark(triangle, kCellPad);
  // Triangles with corners in the same parts are nowhere farther from this one than a part's width per axis.
  if (!wasMarked(triangle)) mark(triangle, 1.0 / kParts + 2 * kCellPad);
}

/// Marks cubes that a triangle meets, or misses by at most `share` of a cube's width. The triangle is clipped to each
/// slab of cubes along the first axis, then to each row along the second: what is left tells the cubes along the last.
void Cubes::mark(const Triangle3& t, double share)
{
  Point3 pad;
  std::array<std::uint32_t, 3> from, to;
  const auto cube = [this](double x, std::size_t axis) { return cubeOf(x, axis); };
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
    pad[k] = share * (high_[k] - low_[k]) / kCubes;
    from[k] = cube(least - pad[k], k), to[k] = cube(most + pad[k], k);
  }
  const auto mark = [&](std::uint32_t i, std::uint32_t j, std::uint32_t low, std::uint32_t high) {
    marked_[i * kCubes + j] |= (~std::uint64_t{0} >> (kCubes - 1 - (high - low))) << low;
  };
  const auto isWide = [&](std::size_t axis) { return to[axis] - from[axis] > 1; };
  if (!isWide(0) && !isWide(1) && !isWide(2)) {
    for (std::uint32_t i = from[0]; i <= to[0]; ++i)
      for (std::uint32_t j = from[1]; j <= to[1]; ++j) mark(i, j, from[2], to[2]);
    return;
  }
  // The first and the last stand for what lies beyond, too.
  const auto low = [&](std::uint32_t i, std::size_t axis) {
    return i == 0 ? -kUnbounded : low_[axis] + i / per_[axis] - pad[axis];
  };
  const auto high = [&](std::uint32_t i, std::size_t axis) {
    return i + 1 == kCubes || !(per_[axis] > 0.0) ? kUnbounded : low_[axis] + (i + 1) / per_[axis] + pad[axis];
  };
  std::array<Point3, 9> part;
  for (std::uint32_t i = from[0]; i <= to[0]; ++i) {
    std::size_t corners = 0;
    double bottom = kUnbounded, top = -kUnbounded;
    forEachCorner(t.data(), 3, 0, low(i, 0), high(i, 0), [&](const Point3& p) {
      part[corners++] = p;
      bottom = std::min(bottom, p[1]), top = std::max(top, p[1]);
    });
    if (corners == 0) continue;
    const std::uint32_t last = cube(top + pad[1], 1);
    for (std::uint32_t j = cube(bottom - pad[1], 1); j <= last; ++j) {
      double least = kUnbounded, most = -kUnbounded;
      forEachCorner(part.data(), corners, 1, low(j, 1), high(j, 1),
                    [&](const Point3& p) { least = std::min(least, p[2]), most = std::max(most, p[2]); });
      if (least <= most) mark(i, j, cube(least - pad[2], 2), cube(most + pad[2], 2));
    }
  }
}

bool Cubes::areClear(const Point3& at, double reach) const noexcept
{
  constexpr std::uint32_t kWidest = 32;
  if (marked_.empty()) return false;
  std::array<std::uint32_t, 3> from, to;
  for (std::size_t k = 0; k < 3; ++k) {
    from[k] = cubeOf(at[k] - reach, k);
    to[k] = cubeOf(at[k] + reach, k);
    if (to[k] - from[k] >= kWidest) return false;
  }
  const std::uint64_t row = (~std::uint64_t{0} >> (kCubes - 1 - (to[2] - from[2]))) << from[2];
  for (std::uint32_t i = from[0]; i <= to[0]; ++i) {
    std::uint64_t met = 0;
    for (std::uint32_t j = from[1]; j <= to[1]; ++j) met |= marked_[i * kCubes + j];
    if ((met & row) != 0) return false;
  }
  return true;
}

} // namespace pcl_bsh
