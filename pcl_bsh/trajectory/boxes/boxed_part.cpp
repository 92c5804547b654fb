// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/boxes/boxed_part.h>

#include <pcl_bsh/geometry/triangle/vector3.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr std::size_t kPartsOfEach = 4, kMostParts = 1U << 14;
constexpr std::size_t kRecordsOfPart = 16; ///< records to be compared with a part, at least, on average

double sideOf(const Triangle3& triangle, std::size_t i)
{
  const Point3 way = triangle[(i + 1) % 3] - triangle[i];
  return std::sqrt(dot(way, way));
}

std::size_t longestSideOf(const Triangle3& triangle)
{
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (sideOf(triangle, i) > sideOf(triangle, longest)) longest = i;
  return longest;
}

/// Halves a part at the middle of its longest side.
std::pair<BoxedPart, BoxedPart> halvesOf(const BoxedPart& part)
{
  const std::size_t i = longestSideOf(part.corners), next = (i + 1) % 3;
  Triangle3 first = part.corners, second = part.corners;
  first[next] = second[i] = 0.5 * (part.corners[i] + part.corners[next]);
  return {BoxedPart(first, part.record), BoxedPart(second, part.record)};
}

bool isThinner(const BoxedPart& one, const BoxedPart& other)
{
  return one.thickness < other.thickness;
}

} // namespace

BoxedPart::BoxedPart(const Triangle3& at, std::uint32_t of) : corners(at), record(of)
{
  Point3 sides = high() - low();
  std::sort(sides.begin(), sides.end());
  const Point3 moment = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double longest = sideOf(corners, longestSideOf(corners));
  const double height = longest > 0.0 ? std::sqrt(dot(moment, moment)) / longest : 0.0;
  thickness = std::max(sides[0], sides[1] - height);
}

Point3 BoxedPart::low() const noexcept
{
  Point3 end;
  for (std::size_t axis = 0; axis < 3; ++axis)
    end[axis] = std::min({corners[0][axis], corners[1][axis], corners[2][axis]});
  return end;
}

Point3 BoxedPart::high() const noexcept
{
  Point3 end;
  for (std::size_t axis = 0; axis < 3; ++axis)
    end[axis] = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
  return end;
}

Division divisionFor(std::size_t records, double largest_radius)
{
  return {largest_radius, std::clamp(records / kRecordsOfPart, Division().most, kMostParts)};
}

void divideThick(std::vector<BoxedPart>& parts, const Division& division)
{
  const double thin = division.thin;
  const std::size_t most = std::max(division.most, kPartsOfEach * parts.size());
  const auto begin_thick =
      std::partition(parts.begin(), parts.end(), [&](const BoxedPart& part) { return !(part.thickness > thin); });
  std::vector<BoxedPart> thick(begin_thick, parts.end());
  parts.erase(begin_thick, parts.end());
  std::make_heap(thick.begin(), thick.end(), isThinner);
  while (!thick.empty() && thick.size() + parts.size() < most) {
    std::pop_heap(thick.begin(), thick.end(), isThinner);
    const auto [first, second] = halvesOf(thick.back());
    thick.pop_back();
    for (const BoxedPart& part : {first, second}) {
      if (!(part.thickness > thin)) {
        parts.push_back(part);
        continue;
      }
      thick.push_back(part);
      std::push_heap(thick.begin(), thick.end(), isThinner);
    }
  }
  parts.insert(parts.end(), thick.begin(), thick.end());
}

} // namespace pcl_bsh
