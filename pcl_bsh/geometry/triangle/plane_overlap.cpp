// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/plane_overlap.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_bsh {
namespace {

bool areEqual(const LongNumber& x, const LongNumber& y)
{
  return x.value() == y.value() && x.tail() == y.tail() && x.error() == 0.0 && y.error() == 0.0;
}

/// Whether all corners are at one exact place along an axis.
bool isAcross(const LongCorners& t, std::size_t axis)
{
  return areEqual(t[0][axis], t[1][axis]) && areEqual(t[0][axis], t[2][axis]);
}

struct Place {
  double x = 0.0, y = 0.0;
};

/// Twice the area of u, v, w; positive where they turn left.
double turn(const Place& u, const Place& v, const Place& w)
{
  return (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
}

/// Let coordinates be at most a scale, and off by a few roundings of the scale. Then a turn errs by far less than this
/// share of the scale's square.
constexpr double kTurnDoubt = 0x1p-40;
/// Where coordinates are off by more, a turn errs by less than this times the scale times their error. A turn is the
/// sum of two products of differences, each up to twice the scale, and each off by two errors.
constexpr double kTurnErrors = 32.0;

/// Whether a place is surely inside. @param doubt bound of the error of turns
bool isInside(const std::array<Place, 3>& t, const Place& at, double doubt)
{
  const double turns[3] = {turn(t[0], t[1], at), turn(t[1], t[2], at), turn(t[2], t[0], at)};
  return (turns[0] > doubt && turns[1] > doubt && turns[2] > doubt) ||
         (turns[0] < -doubt && turns[1] < -doubt && turns[2] < -doubt);
}

/// Whether some place of a surely is inside b. It tries the middle of their intersection, computed in doubles: this is
/// in a up to its rounding, and must be inside b by more than that.
/// @param error of any coordinate, without its rounding to double
bool surelyMeet(const std::array<Place, 3>& a, const std::array<Place, 3>& b, double error)
{
  double scale = 0.0;
  for (const auto* t : {&a, &b})
    for (const Place& p : *t) scale = std::max({scale, std::abs(p.x), std::abs(p.y)});
  if (!(scale > 0x1p-400)) return false; // squares of lengths would vanish
  constexpr std::size_t kMost = 12;      ///< corners: cut by a line, a convex polygon has one more
  Place part[kMost], cut[kMost];
  std::size_t count = 3;
  std::copy(a.begin(), a.end(), part);
  const double side = turn(b[0], b[1], b[2]) < 0.0 ? -1.0 : 1.0;
  for (std::size_t j = 0; j < 3; ++j) {
    const Place &from = b[j], &to = b[(j + 1) % 3];
    std::size_t left = 0;
    for (std::size_t i = 0; i < count && left + 2 <= kMost; ++i) {
      const Place &u = part[i], &v = part[(i + 1) % count];
      const double of_u = side * turn(from, to, u), of_v = side * turn(from, to, v);
      if (of_u >= 0.0) cut[left++] = u;
      if ((of_u < 0.0) == (of_v < 0.0)) continue;
      const double share = of_u / (of_u - of_v);
      cut[left++] = {u.x + share * (v.x - u.x), u.y + share * (v.y - u.y)};
    }
    count = left;
    std::copy(cut, cut + count, part);
  }
  if (count == 0) return false;
  Place middle;
  for (std::size_t i = 0; i < count; ++i) middle.x += part[i].x, middle.y += part[i].y;
  middle.x /= static_cast<double>(count), middle.y /= static_cast<double>(count);
  return isInside(b, middle, scale * (kTurnDoubt * scale + kTurnErrors * error));
}

/// Whether one of the corners of t surely lies on a closed triangle, seen along their normal. Where both touch along
/// parts of their edges, doubles know no place inside both. @param turnOf(from, to, corner): to which side it turns
template <class TurnOf>
bool surelyTouch(const LongCorners& t, const LongCorners& closed, const TurnOf& turnOf)
{
  for (const Vector3<LongNumber>& p : t) {
    bool sure = true;
    int left = 0, right = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const int sign = turnOf(closed[j], closed[(j + 1) % 3], p).sign(sure);
      left += sign > 0, right += sign < 0;
    }
    if (sure && (left == 0) != (right == 0)) return true;
  }
  return false;
}

} // namespace

std::optional<LongNumber> gapOfFacing(const LongCorners& a, const LongCorners& b)
{
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!isAcross(a, axis) || !isAcross(b, axis)) continue;
    const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    const auto isAbove = [&](const Vector3<LongNumber>& p, const Vector3<LongNumber>& q) {
      return areEqual(p[x], q[x]) && areEqual(p[y], q[y]);
    };
    bool is_above = false;
    for (const auto& p : a)
      for (const auto& q : b) is_above = is_above || isAbove(p, q);
    if (!is_above) {
      double error = 0.0;
      const auto placesOf = [&](const LongCorners& t) {
        std::array<Place, 3> places;
        for (std::size_t i = 0; i < 3; ++i) {
          const LongNumber from_x = t[i][x] - a[0][x], from_y = t[i][y] - a[0][y];
          places[i] = {from_x.value(), from_y.value()};
          error += from_x.error() + from_y.error();
        }
        return places;
      };
      const std::array<Place, 3> of_a = placesOf(a), of_b = placesOf(b);
      const auto turnOf = [&](const auto& from, const auto& to, const auto& p) {
        return (to[x] - from[x]) * (p[y] - from[y]) - (to[y] - from[y]) * (p[x] - from[x]);
      };
      if (!surelyMeet(of_a, of_b, error) && !surelyTouch(a, b, turnOf) && !surelyTouch(b, a, turnOf))
        return std::nullopt;
    }
    const LongNumber gap = a[0][axis] - b[0][axis];
    bool sure = true;
    const int sign = gap.sign(sure);
    if (gap.error() != 0.0 || !sure) return std::nullopt;
    return sign < 0 ? -gap : gap;
  }
  return std::nullopt;
}

bool areFacesBeyond(const LongCorners& a, const LongCorners& b, const LongNumber& numerator,
                    const LongNumber& denominator)
{
  for (const LongCorners* face : {&a, &b}) {
    const LongCorners &own = *face, &other = face == &a ? b : a;
    const Vector3<LongNumber> normal = cross(own[1] - own[0], own[2] - own[0]);
    const LongNumber limit = dot(normal, normal) * numerator;
    int sides = 0;
    bool all_beyond = true;
    for (const Vector3<LongNumber>& corner : other) {
      const LongNumber height = dot(normal, corner - own[0]);
      bool sure = true;
      sides += height.sign(sure);
      all_beyond = all_beyond && (denominator * (height * height) - limit).sign(sure) > 0;
    }
    if (all_beyond && (sides == 3 || sides == -3)) return true;
  }
  return false;
}

namespace {

/// Whether a line along an edge of t, seen along their normal, surely has t on one side and all of the other beyond it.
template <class TurnOf>
bool isApart(const LongCorners& t, const LongCorners& other, const TurnOf& turnOf)
{
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3<LongNumber>&from = t[j], &to = t[(j + 1) % 3];
    bool sure = true;
    const int own = turnOf(from, to, t[(j + 2) % 3]).sign(sure);
    if (own != 0 && std::all_of(other.begin(), other.end(), [&](const Vector3<LongNumber>& corner) {
          return turnOf(from, to, corner).sign(sure) == -own;
        }))
      return true;
  }
  return false;
}

Point3 roughly(const Vector3<LongNumber>& v)
{
  return {v[0].value(), v[1].value(), v[2].value()};
}

/// The greatest of a vector's errors.
double errorOf(const Vector3<LongNumber>& v)
{
  return std::max({v[0].error(), v[1].error(), v[2].error()});
}

} // namespace

PlaneOverlap overlapOf(const LongCorners& a, const LongCorners& b)
{
  // Coordinates in doubles: along an edge of a, and across it in the plane of a. Both axes are as long as the edge.
  const Vector3<LongNumber> edge = a[1] - a[0], normal = cross(edge, a[2] - a[0]);
  const Point3 along = roughly(edge), side = roughly(a[2] - a[0]), up = roughly(normal);
  const double length = std::sqrt(dot(along, along)), height = std::sqrt(dot(up, up));
  constexpr double needle = 0x1p-30; // the normal has more digits than doubles
  if (!(height > needle * length * std::sqrt(dot(side, side)))) return PlaneOverlap::unknown;
  const Point3 across = (1.0 / height) * cross(up, along);
  double farthest = 0.0, error = 0.0;
  const auto placesOf = [&](const LongCorners& t) {
    std::array<Place, 3> places;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3<LongNumber> from = t[i] - a[0];
      const Point3 at = roughly(from);
      places[i] = {dot(along, at), dot(across, at)};
      farthest = std::max(farthest, dot(at, at));
      error = std::max(error, errorOf(from));
    }
    return places;
  };
  const std::array<Place, 3> of_a = placesOf(a), of_b = placesOf(b);
  const double off = length * (kFewDoubleRoundings * std::sqrt(farthest) + 4 * (error + errorOf(edge)));
  if (surelyMeet(of_a, of_b, off)) return PlaneOverlap::over;
  const auto turnOf = [&normal](const auto& from, const auto& to, const auto& p) {
    return dot(cross(normal, to - from), p - from);
  };
  if (isApart(a, b, turnOf) || isApart(b, a, turnOf)) return PlaneOverlap::beside;
  return surelyTouch(a, b, turnOf) || surelyTouch(b, a, turnOf) ? PlaneOverlap::over : PlaneOverlap::unknown;
}

} // namespace pcl_bsh
