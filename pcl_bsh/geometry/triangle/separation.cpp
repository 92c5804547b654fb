// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/separation.h>

#include <pcl_bsh/geometry/triangle/ordinary_length.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();

constexpr double kVanishing = 0x1p-500; ///< shorter lengths have squares that underflow

double clampedShare(double part, double whole)
{
  return whole > 0.0 ? std::min(std::max(part / whole, 0.0), 1.0) : 0.0; // not std::clamp: of NaN, it makes NaN
}

/// Keeps the nearest of the pairs of places it is offered.
class NearestPlaces {
public:
  explicit NearestPlaces(Separation& into) : into_(into) {}

  void offer(const Point3& a, const Point3& b)
  {
    const Point3 between = a - b;
    const double squared = dot(between, between);
    if (!(squared < squared_)) return;
    squared_ = squared;
    into_.place_a = a;
    into_.place_b = b;
  }

  double squared() const { return squared_; }

private:
  Separation& into_;
  double squared_ = kInfinitelyFar;
};

Point3 onEdge(const Point3& p, const Point3& start, const Point3& end)
{
  const Point3 way = end - start;
  return start + clampedShare(dot(p - start, way), dot(way, way)) * way;
}

double largestOf(const Point3& u, const Point3& v)
{
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) largest = std::max({largest, std::abs(u[k]), std::abs(v[k])});
  return largest;
}

/// A normal of any length. Its square is in the range of double where the triangle's sides are not almost parallel.
Point3 faceNormal(const Triangle3& t)
{
  return cross(ofOrdinaryLength(t[1] - t[0]), ofOrdinaryLength(t[2] - t[0]));
}

/// Offers the place of a triangle's inside that is below or above a point, if there is such a place.
/// @param offer called with the place
template <class Offer>
void onFace(const Point3& p, const Triangle3& t, const Offer& offer)
{
  Point3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const double factor = toOrdinary(largestOf(u, v));
  if (factor != 1.0) u = factor * u, v = factor * v, w = factor * w;
  const Point3 normal = cross(u, v);
  const double square = dot(normal, normal); // where it is 0, no place below compares as inside
  const double on_v = dot(normal, cross(u, w)) / square, on_u = dot(normal, cross(w, v)) / square;
  if (!(on_u > 0.0 && on_v > 0.0 && on_u + on_v < 1.0)) return;
  offer(t[0] + on_u * (t[1] - t[0]) + on_v * (t[2] - t[0]));
}

void offerEdges(const Point3& a, const Point3& end_a, const Point3& b, const Point3& end_b, NearestPlaces& nearest)
{
  const Point3 way_a = end_a - a, way_b = end_b - b, between = a - b;
  const double aa = dot(way_a, way_a), bb = dot(way_b, way_b), ab = dot(way_a, way_b);
  const double on_a = dot(way_a, between), on_b = dot(way_b, between);
  double s = clampedShare(ab * on_b - on_a * bb, aa * bb - ab * ab);
  const double t = clampedShare(ab * s + on_b, bb);
  s = clampedShare(ab * t - on_a, aa);
  nearest.offer(a + s * way_a, b + t * way_b);
}

/// The place where an edge of one triangle passes through the other.
/// @param offer called with the place
template <class Offer>
void wherePierced(const Triangle3& edges, const Triangle3& t, const Offer& offer)
{
  const Point3 normal = faceNormal(t);
  double heights[3];
  for (std::size_t i = 0; i < 3; ++i) heights[i] = dot(normal, edges[i] - t[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (!(heights[i] > 0.0 && heights[next] < 0.0) && !(heights[i] < 0.0 && heights[next] > 0.0)) continue;
    const double share = heights[i] / (heights[i] - heights[next]);
    const Point3 at = edges[i] + share * (edges[next] - edges[i]);
    onFace(at, t, [&](const Point3& place) { offer(at, place); });
  }
}

void findNearest(const Corners& a, const Corners& b, NearestPlaces& nearest)
{
  if (a.count == 1 && b.count == 1) return nearest.offer(a.at[0], b.at[0]);
  if (b.count == 3)
    for (std::size_t i = 0; i < a.count; ++i)
      onFace(a.at[i], b.at, [&](const Point3& place) { nearest.offer(a.at[i], place); });
  if (a.count == 3)
    for (std::size_t j = 0; j < b.count; ++j)
      onFace(b.at[j], a.at, [&](const Point3& place) { nearest.offer(place, b.at[j]); });
  if (a.count == 1)
    for (std::size_t j = 0; j < 3; ++j) nearest.offer(a.at[0], onEdge(a.at[0], b.at[j], b.at[(j + 1) % 3]));
  else if (b.count == 1)
    for (std::size_t i = 0; i < 3; ++i) nearest.offer(onEdge(b.at[0], a.at[i], a.at[(i + 1) % 3]), b.at[0]);
  else {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) offerEdges(a.at[i], a.at[(i + 1) % 3], b.at[j], b.at[(j + 1) % 3], nearest);
    wherePierced(a.at, b.at, [&](const Point3& on_a, const Point3& on_b) { nearest.offer(on_a, on_b); });
    wherePierced(b.at, a.at, [&](const Point3& on_b, const Point3& on_a) { nearest.offer(on_a, on_b); });
  }
}

/// A coordinate of a corner's motion: at s, from + s way + 4 s (1 - s) bow.
struct Course {
  double from, way, bow;

  double at(double s) const { return from + s * way + 4.0 * s * (1.0 - s) * bow; }

  double least(double begin, double end) const
  {
    double value = std::min(at(begin), at(end));
    if (bow < 0.0) { // the parabola has a minimum
      const double foot = 0.5 + way / (8.0 * bow);
      if (foot > begin && foot < end) value = std::min(value, at(foot));
    }
    return value;
  }
};

Course along(const Point3& direction, const MovingCorners& corners, std::size_t i)
{
  return {dot(direction, corners.from[i]), dot(direction, corners.way[i]), dot(direction, corners.bow[i])};
}

double lengthOf(const Point3& v)
{
  return std::sqrt(dot(v, v));
}

/// No corner, nor anything between corners, goes faster.
double speedOf(const MovingCorners& corners)
{
  double speed = 0.0;
  for (std::size_t i = 0; i < corners.count; ++i)
    speed = std::max(speed, lengthOf(corners.way[i]) + 4.0 * lengthOf(corners.bow[i]));
  return speed;
}

/// The direction from b to a along which both are farthest apart, among those offered; of length 1.
class BestDirection {
public:
  BestDirection(const Corners& a, const Corners& b) : a_(a), b_(b) {}

  Point3 direction = {0, 0, 0};
  double gap = -kInfinitelyFar;

  void offer(const Point3& way)
  {
    const Point3 along = ofOrdinaryLength(way);
    const double length = lengthOf(along);
    if (!(length > kVanishing)) return; // its direction would not be of length 1
    const Point3 unit = (1.0 / length) * along;
    double low_a = kInfinitelyFar, high_b = -kInfinitelyFar;
    for (std::size_t i = 0; i < a_.count; ++i) low_a = std::min(low_a, dot(unit, a_.at[i]));
    for (std::size_t j = 0; j < b_.count; ++j) high_b = std::max(high_b, dot(unit, b_.at[j]));
    if (!(low_a - high_b > gap)) return;
    gap = low_a - high_b;
    direction = unit;
  }

private:
  const Corners &a_, &b_;
};

/// The distance, up to rounding, and between which places.
struct Near {
  Separation at; ///< its places and `high`
  double length, error;
};

Near nearOf(const Corners& a, const Corners& b)
{
  Near near{{}, 0.0, 0.0};
  NearestPlaces nearest(near.at);
  findNearest(a, b, nearest);
  double largest = 0.0;
  for (const Corners* corners : {&a, &b})
    for (std::size_t i = 0; i < corners->count; ++i)
      for (const double x : corners->at[i]) largest = std::max(largest, std::abs(x));
  near.error = kSeparationError * largest + kVanishing;
  near.length = std::sqrt(nearest.squared());
  near.at.high = near.length * (1.0 + kFewDoubleRoundings) + near.error;
  return near;
}

Separation separationOf(const Corners& a, const Corners& b, const Near& near)
{
  Separation apart = near.at;
  if (!(near.length > 0.0)) return apart;
  // Where faces or edges are parallel, many pairs of places are equally near, up to rounding. Only some directions
  // between such pairs separate both, so that several are tried.
  const Point3 between = apart.place_a - apart.place_b;
  BestDirection best(a, b);
  best.offer(between);
  const double most = near.length * (1.0 - kFewDoubleRoundings) - near.error; // no direction holds them farther apart
  for (const Corners* corners : {&a, &b}) {
    if (corners->count < 3 || best.gap >= most) continue;
    const Triangle3& t = corners->at;
    const Point3 normal = faceNormal(t);
    best.offer(dot(normal, between) < 0.0 ? -1.0 * normal : normal);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 edge = t[(i + 1) % 3] - t[i];
      const double square = dot(edge, edge);
      if (square > 0.0) best.offer(between - (dot(between, edge) / square) * edge);
    }
  }
  apart.direction = best.direction;
  apart.low = std::max(0.0, best.gap * (1.0 - kFewDoubleRoundings) - near.error);
  return apart;
}

/// Halves an interval until directions show that no instant in it matters, or it is so short that none differ.
class ApproachSearch {
public:
  ApproachSearch(const MovingCorners& a, const MovingCorners& b, double near_enough, double resolution, bool nearest,
                 double early_enough)
  : moving_(a, b),
    near_enough_(near_enough),
    resolution_(resolution),
    shortest_(resolution / (speedOf(a) + speedOf(b))),
    nearest_(nearest),
    early_enough_(early_enough)
  {
  }

  Approach run()
  {
    const Point3 direction = look(0.0, 0.0);
    if (nearest_ || !found_.contact) find(nearOf(moving_.a.at(1.0), moving_.b.at(1.0)), 1.0);
    if (matters(direction, 0.0, 1.0)) halve(0.0, 1.0);
    return found_;
  }

private:
  /// @return the direction along which both are apart at this instant, if something from `begin` on can still matter
  Point3 look(double s, double begin)
  {
    const Corners a = moving_.a.at(s), b = moving_.b.at(s);
    const Near near = nearOf(a, b);
    find(near, s);
    return nearest_ || mayBeFirst(begin) ? separationOf(a, b, near).direction : Point3{0, 0, 0};
  }

  void find(const Near& near, double s)
  {
    ++found_.looks;
    const double distance = near.at.high;
    if (!(distance <= near_enough_)) return;
    if (!found_.contact || s < found_.enter) found_.enter = s;
    if (!found_.contact || distance < found_.distance) {
      found_.distance = distance;
      found_.at = s;
    }
    found_.contact = true;
    found_.meets = found_.meets || near.length <= near.error;
  }

  /// Whether a contact from this instant on may be the first that counts.
  bool mayBeFirst(double begin) const { return !found_.contact || begin < std::min(found_.enter, early_enough_); }

  bool matters(const Point3& direction, double begin, double end) const
  {
    const bool may_be_first = mayBeFirst(begin);
    if (!may_be_first && !nearest_) return false;
    const double least = moving_.leastApart(direction, begin, end);
    if (least > near_enough_ - resolution_) return false; // so that each instant is of one kind or the other
    return may_be_first || std::max(least, 0.0) < found_.distance - resolution_; // nothing is nearer than at 0
  }

  void halve(double begin, double end)
  {
    if (!(end - begin > shortest_)) return;
    const double middle = 0.5 * (begin + end);
    if (!(middle > begin && middle < end)) return;
    const Point3 direction = look(middle, begin);
    if (matters(direction, begin, middle)) halve(begin, middle);
    if (matters(direction, middle, end)) halve(middle, end);
  }

  const MovingPair moving_;
  const double near_enough_, resolution_, shortest_;
  const bool nearest_;
  const double early_enough_;
  Approach found_;
};

} // namespace

Separation separationOf(const Corners& a, const Corners& b)
{
  const Near near = nearOf(a, b);
  return separationOf(a, b, near);
}

Point3 faceBetween(const Corners& a, const Corners& b, double least)
{
  BestDirection best(a, b);
  for (const Corners* corners : {&a, &b}) {
    if (corners->count < 3) continue;
    const Point3 normal = faceNormal(corners->at);
    best.offer(normal);
    best.offer(-1.0 * normal);
  }
  return best.gap >= least ? best.direction : Point3{0, 0, 0};
}

Corners MovingCorners::at(double s) const
{
  Corners corners{{}, count};
  const double bent = 4.0 * s * (1.0 - s);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      corners.at[i][axis] = from[i][axis] + s * way[i][axis] + bent * bow[i][axis];
  return corners;
}

MovingPair::MovingPair(const MovingCorners& moving_a, const MovingCorners& moving_b) : a(moving_a), b(moving_b)
{
  double largest = 0.0, way_of_b = 0.0;
  for (const MovingCorners* corners : {&a, &b})
    for (std::size_t i = 0; i < corners->count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double way = std::abs(corners->way[i][axis]) + std::abs(corners->bow[i][axis]);
        largest = std::max(largest, std::abs(corners->from[i][axis]) + way);
        if (corners == &b) way_of_b = std::max(way_of_b, way);
      }
  b_rests_ = way_of_b == 0.0;
  error_ = kSeparationError * largest + kVanishing;
}

double MovingPair::leastApart(const Point3& direction, double begin, double end) const
{
  double low_a = kInfinitelyFar, high_b = -kInfinitelyFar;
  for (std::size_t i = 0; i < a.count; ++i) low_a = std::min(low_a, along(direction, a, i).least(begin, end));
  for (std::size_t j = 0; j < b.count; ++j)
    high_b = std::max(high_b, b_rests_ ? dot(direction, b.from[j]) : -along(-1.0 * direction, b, j).least(begin, end));
  return low_a - high_b - error_;
}

Approach approachOf(const MovingCorners& a, const MovingCorners& b, double near_enough, double resolution, bool nearest,
                    double early_enough)
{
  return ApproachSearch(a, b, near_enough, resolution, nearest, early_enough).run();
}

} // namespace pcl_bsh
