// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/section_polygon.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/exact/line_order.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl_bsh {
namespace {

/// Positive where c is to the left of the line from a to b, 0 on it: exact.
int sideOf(const SectionPoint& a, const SectionPoint& b, const SectionPoint& c)
{
  const auto in_space = [](const SectionPoint& p) { return Point3{p.offset, p.height, 0.0}; };
  return line_order::turn(in_space(a), in_space(b), in_space(a), in_space(c), 0, 1);
}

/// Whether the third of three places on a line lies between the two others, or on one of them.
bool isBetween(const SectionPoint& a, const SectionPoint& b, const SectionPoint& p)
{
  return std::min(a.offset, b.offset) <= p.offset && p.offset <= std::max(a.offset, b.offset) &&
         std::min(a.height, b.height) <= p.height && p.height <= std::max(a.height, b.height);
}

bool doMeet(const SectionPoint& a, const SectionPoint& b, const SectionPoint& c, const SectionPoint& d)
{
  const int abc = sideOf(a, b, c), abd = sideOf(a, b, d), cda = sideOf(c, d, a), cdb = sideOf(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && isBetween(a, b, c)) || (abd == 0 && isBetween(a, b, d)) || (cda == 0 && isBetween(c, d, a)) ||
         (cdb == 0 && isBetween(c, d, b));
}

std::string textOf(const SectionPoint& p)
{
  return plainText('(', p.offset, ", ", p.height, ')');
}

} // namespace

/// Error: a cross product errs by 8 v of its two terms' absolute sum (v is kDoubleUnit), so a sign beyond that is sure.
/// Other signs are computed exactly. A point whose foot is within an edge is w <= extent + distance from the edge's
/// beginning. The distance cross / length then errs by 16 v w, and by 4 v of itself for square, sum, division and root.
/// At an edge's ends both formulas differ by less than the foot's own error, 4 v w. Squares neither overflow nor
/// underflow for sizes between 1e-140 and 1e140.
double signedDistance(const std::vector<SectionPoint>& outline, const SectionPoint& point, OutlinePlace* nearest)
{
  constexpr double sure = 8 * kDoubleUnit;
  double least = std::numeric_limits<double>::infinity(), foot = 0.0;
  std::size_t at_edge = 0;
  bool inside = false;
  for (std::size_t i = 0, last = outline.size() - 1; i < outline.size(); last = i++) {
    const SectionPoint &a = outline[last], &b = outline[i];
    const double ex = b.offset - a.offset, ey = b.height - a.height;
    const double wx = point.offset - a.offset, wy = point.height - a.height;
    const double left = ex * wy, right = ey * wx, cross = left - right;
    const double along = ex * wx + ey * wy, square = ex * ex + ey * ey;
    double apart = wx * wx + wy * wy;
    if (along >= square) {
      const double vx = point.offset - b.offset, vy = point.height - b.height;
      apart = vx * vx + vy * vy;
    }
    else if (along > 0.0) {
      apart = cross * cross / square;
    }
    if (apart < least) {
      least = apart;
      at_edge = last;
      foot = along <= 0.0 ? 0.0 : along >= square ? 1.0 : along / square;
    }
    const bool crosses = (a.height <= point.height) != (b.height <= point.height);
    const bool doubtful = std::abs(cross) <= sure * (std::abs(left) + std::abs(right));
    if (!crosses && !doubtful) continue;
    const int side = doubtful ? sideOf(a, b, point) : cross > 0.0 ? 1 : -1;
    if (side == 0 && isBetween(a, b, point)) {
      if (nearest) *nearest = {point, last, std::clamp(along / square, 0.0, 1.0)};
      return 0.0;
    }
    if (crosses && (side > 0) == (b.height > a.height)) inside = !inside;
  }
  if (nearest) {
    const SectionPoint &a = outline[at_edge], &b = outline[(at_edge + 1) % outline.size()];
    *nearest = {{a.offset + foot * (b.offset - a.offset), a.height + foot * (b.height - a.height)}, at_edge, foot};
  }
  const double distance = std::max(std::sqrt(least), std::numeric_limits<double>::min()); // > 0: not on the outline
  return inside ? -distance : distance;
}

std::vector<SectionPoint> simplePolygon(std::vector<SectionPoint> corners)
{
  const auto refuse = [](const std::string& wrong, const std::string& remedy) {
    throw InvalidInput(Input::trajectory, "profile", wrong, remedy);
  };
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (!std::isfinite(corners[i].offset) || !std::isfinite(corners[i].height))
      refuse(plainText("corner ", i + 1, ' ', textOf(corners[i]), " is not finite"), "correct it, or leave it out");
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  const std::size_t count = corners.size();
  if (count < 3)
    refuse(plainText("has ", count, " different corners"), "give three at least, as the polygon's outline");
  for (std::size_t i = 0; i < count; ++i) {
    const SectionPoint &a = corners[i], &b = corners[(i + 1) % count], &after = corners[(i + 2) % count];
    if (sideOf(a, b, after) == 0 && (isBetween(a, b, after) || isBetween(b, after, a)))
      refuse("folds back onto itself at corner " + textOf(b), "leave that corner out");
    for (std::size_t j = i + 2; j < count; ++j) {
      if (i == 0 && j + 1 == count) continue; // neighbours
      if (doMeet(a, b, corners[j], corners[(j + 1) % count]))
        refuse("its edges from " + textOf(a) + " to " + textOf(b) + " and from " + textOf(corners[j]) + " to " +
                   textOf(corners[(j + 1) % count]) + " meet",
               "give the corners in order, so that the outline does not cross itself");
    }
  }
  return corners;
}

} // namespace pcl_bsh
