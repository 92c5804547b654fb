// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/winding.h>

#include <pcl_bsh/geometry/triangle/nearest_features.h>

#include <cmath>
#include <type_traits>

namespace pcl_bsh {
namespace {

/// The crossing of a triangle. @param t its corners, relative to the point, the ray's axis first @param sure becomes
/// false where a sign is unknown; the result is then worth nothing
template <class Number>
Winding::Crossing meet(const std::array<Vector3<Number>, 3>& t, bool& sure)
{
  // All on one side: the ray does not come near, and the point is not on the triangle. An unknown sign counts as 0.
  for (std::size_t k = 0; k < 3; ++k) {
    int all = 0;
    bool known = true;
    for (std::size_t i = 0; i < 3; ++i) all += signOf(t[i][k], known);
    if (all == -3 || (k > 0 && all == 3)) return {};
  }
  // The ray begins at (0, e, e^2) for an infinitesimal e. An edge's turn says on which side the ray passes it: the sign
  // of the area of the edge and this place, seen along the ray, by falling powers of e.
  int turns[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3<Number>&u = t[i], &v = t[(i + 1) % 3];
    turns[i] = signOf(u[1] * v[2] - u[2] * v[1], sure);
    if (turns[i] == 0) turns[i] = signOf(u[2] - v[2], sure);
    if (turns[i] == 0) turns[i] = signOf(v[1] - u[1], sure);
  }
  const Vector3<Number> normal = cross(t[1] - t[0], t[2] - t[0]);
  const Number volume = dot(normal, t[0]);
  const int side = signOf(volume, sure);
  if (!sure) return {};
  if (side == 0) { // in the plane of the triangle, or there is no plane: on it?
    if constexpr (std::is_same_v<Number, RoughNumber>) {
      sure = false;
      return {};
    }
    else {
      const NearestFeatures<Number> nearest({Number(0.0), Number(0.0), Number(0.0)}, t);
      sure = nearest.sure();
      if (sure && signOf(nearest.squared().numerator, sure) == 0 && sure) return {0, true};
      if (!sure) return {};
    }
  }
  // Where side is 0, the point is off the triangle, but in its plane if there is one. So places infinitely near to the
  // point are off the triangle, too, and the ray passes by.
  if (side == 0 || turns[0] == 0 || turns[0] != turns[1] || turns[1] != turns[2]) return {};
  // The turns have the sign of the normal along the ray. The ray meets the plane in front of the point where the volume
  // has this sign, too.
  return {side == turns[0] ? turns[0] : 0, false};
}

} // namespace

Winding::Winding(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b, int axis)
: points_(pose_a, pose_b),
  turned_(pose_b.linear() != Eigen::Matrix3d::Identity()),
  axis_(static_cast<std::size_t>(axis))
{
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      a_[i][j] = pose_a.matrix()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      b_[i][j] = pose_b.matrix()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
}

/// T_b q - T_a p.
template <class Number>
std::array<Number, 3> Winding::seen(const Point3& p, const Point3& q) const
{
  std::array<Number, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = Number(b_[k][3]) - Number(a_[k][3]);
    for (std::size_t j = 0; j < 3; ++j) {
      if (b_[k][j] != 0.0) at[k] += Number(b_[k][j]) * Number(q[j]);
      if (a_[k][j] != 0.0) at[k] += Number(-a_[k][j]) * Number(p[j]);
    }
  }
  return at;
}

/// Turns corners to b's own axes, the ray's first, then cyclically. Lengths are multiplied by the determinant of b's
/// rotation: row k of the inverse times the determinant is the cross product of the columns k + 1 and k + 2.
template <class Number>
Winding::Corners<Number> Winding::turnedBack(const Corners<Number>& corners) const
{
  Corners<Number> turned;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t row = (k + axis_) % 3;
    if (!turned_) {
      for (std::size_t i = 0; i < 3; ++i) turned[i][k] = corners[i][row];
      continue;
    }
    const auto column = [&](std::size_t j) -> Vector3<Number> {
      return {Number(b_[0][j % 3]), Number(b_[1][j % 3]), Number(b_[2][j % 3])};
    };
    const Vector3<Number> inverse = cross(column(row + 1), column(row + 2));
    for (std::size_t i = 0; i < 3; ++i) turned[i][k] = dot(inverse, corners[i]);
  }
  return turned;
}

Winding::Crossing Winding::crossing(const Point3& p, const Triangle3& triangle, Stages* stages) const
{
  Stages none, &count = stages ? *stages : none;
  Corners<RoughNumber> rough;
  bool sure = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactDistance::Difference z = points_.approximate(p, triangle[i]);
    for (std::size_t k = 0; k < 3; ++k) rough[i][k] = {-z.vector[k], z.error};
  }
  if (const Crossing found = meet(turnedBack(rough), sure); sure) return ++count.doubles, found;
  sure = true;
  const auto seen_corners = [&]<class Number>(Number) {
    return turnedBack(
        Corners<Number>{seen<Number>(p, triangle[0]), seen<Number>(p, triangle[1]), seen<Number>(p, triangle[2])});
  };
  if (const Crossing found = meet(seen_corners(LongNumber()), sure); sure) return ++count.long_numbers, found;
  sure = true;
  ++count.integers;
  return meet(seen_corners(Dyadic()), sure);
}

std::optional<int> Winding::number(const Point3& p, std::size_t count,
                                   const std::function<Triangle3(std::size_t)>& triangle) const
{
  int turns = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle3 t = triangle(i);
    if (!isFinite(t)) continue;
    const Crossing found = crossing(p, t);
    if (found.on_surface) return std::nullopt;
    turns += found.turns;
  }
  return turns;
}

} // namespace pcl_bsh
