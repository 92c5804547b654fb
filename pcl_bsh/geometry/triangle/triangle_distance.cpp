// SPDX-License-Identifier: BSD-3-Clause
// Stages, each used only where it is sure of itself: an enclosure in double, the nearest features in numbers of twice
// the digits that know their error, and the same in integers of any length.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl_bsh/geometry/exact/nearest_double.h>
#include <pcl_bsh/geometry/exact/rough_root_less.h>
#include <pcl_bsh/geometry/triangle/double_distance.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>
#include <pcl_bsh/geometry/triangle/plane_overlap.h>
#include <pcl_bsh/geometry/triangle/root_of_fraction.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace pcl_bsh {
namespace {

constexpr double kAnyLength = std::numeric_limits<double>::infinity();

TriangleDistance::Stages& orNone(TriangleDistance::Stages* stages, TriangleDistance::Stages& none)
{
  return stages ? *stages : none;
}

/// Whether both pairs of features use one corner or one edge of the second triangles: triangles of a mesh share theirs.
bool areOne(const Features& x, const Triangle3& of_x, const Features& y, const Triangle3& of_y)
{
  if (x.kind != y.kind || x.i != y.i) return false;
  if (x.kind == Features::corners || x.kind == Features::edge_corner) return of_x[x.j] == of_y[y.j];
  if (x.kind != Features::corner_edge && x.kind != Features::edges) return false;
  const Point3 &from_x = of_x[x.j], &to_x = of_x[(x.j + 1) % 3u], &from_y = of_y[y.j], &to_y = of_y[(y.j + 1) % 3u];
  return (from_x == from_y && to_x == to_y) || (from_x == to_y && to_x == from_y);
}

/// Features whose distance is that of parallel planes: the first face, which has a normal, and a corner of the second.
constexpr Features kPlanes = {Features::face_corner, 0, 0};

} // namespace

TriangleDistance::TriangleDistance(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
: points_(pose_a, pose_b)
{
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      a_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose_a.matrix()(i, j);
      b_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose_b.matrix()(i, j);
    }
  }
}

// Double ----------------------------------------------------------------------------------------------------------

/// Compares a distance with a sum, in double first. The sum takes eight additions at most, rounded relative to the
/// absolute values of its terms.
template <class Pair>
int TriangleDistance::compareByStages(const Pair& pair, const ExactDistance::Sum& reach, Stages& stages) const
{
  double sum = pair.radius, magnitude = std::abs(pair.radius);
  for (const double term : reach) {
    sum += term;
    magnitude += std::abs(term);
  }
  if (reach[0] == kAnyLength) return ++stages.doubles, -1;
  Enclosure found;
  if constexpr (std::is_same_v<Pair, PointPair>) {
    found = enclose(pair.a, pair.b);
  }
  else {
    const Seen at = seen(pair.a, pair.b);
    found = distanceOfTriangles(at.a, at.b, at.error, sum).distance;
  }
  const double rounding = 2 * kFewDoubleRoundings * magnitude;
  if (found.high < sum - rounding) return ++stages.doubles, -1;
  if (found.low > sum + rounding) return ++stages.doubles, 1;
  return settle(pair, reach, stages);
}

int TriangleDistance::compare(const PointPair& pair, const ExactDistance::Sum& reach, Stages* stages) const
{
  Stages none;
  return compareByStages(pair, reach, orNone(stages, none));
}

int TriangleDistance::compare(const TrianglePair& pair, const ExactDistance::Sum& reach, Stages* stages) const
{
  Stages none;
  return compareByStages(pair, reach, orNone(stages, none));
}

int TriangleDistance::compare(const Point3& p, const Triangle3& b, double clearance, double radius,
                              Stages* stages) const
{
  return compare(PointPair{p, b, radius}, {clearance}, stages);
}

int TriangleDistance::compare(const Triangle3& a, const Triangle3& b, double clearance, Stages* stages) const
{
  return compare(TrianglePair{a, b}, {clearance}, stages);
}

// Longer numbers --------------------------------------------------------------------------------------------------

template <class Number>
std::array<Number, 3> TriangleDistance::placed(const Pose& pose, const Point3& p) const
{
  return placedBy<Number>([&pose](std::size_t row, std::size_t column) { return pose[row][column]; }, p);
}

LongCorners TriangleDistance::longCorners(const Pose& pose, const Triangle3& t) const
{
  return {placed<LongNumber>(pose, t[0]), placed<LongNumber>(pose, t[1]), placed<LongNumber>(pose, t[2])};
}

template <class Number, class Pair>
NearestFeatures<Number> TriangleDistance::nearest(const Pair& pair) const
{
  const auto corners = [this](const Pose& pose, const Triangle3& t) -> std::array<std::array<Number, 3>, 3> {
    return {placed<Number>(pose, t[0]), placed<Number>(pose, t[1]), placed<Number>(pose, t[2])};
  };
  if constexpr (std::is_same_v<Pair, PointPair>) {
    return {placed<Number>(a_, pair.a), corners(b_, pair.b)};
  }
  else {
    const Seen at = seen(pair.a, pair.b);
    return {corners(a_, pair.a), corners(b_, pair.b), distanceOfTriangles(at.a, at.b, at.error, kAnyLength).pairs};
  }
}

template <class Number, class Pair>
Fraction<Number> TriangleDistance::squared(const Pair& pair, const Features& features) const
{
  const auto corner_a = [&](std::size_t i) {
    if constexpr (std::is_same_v<Pair, PointPair>)
      return placed<Number>(a_, pair.a);
    else
      return placed<Number>(a_, pair.a[i]);
  };
  return squaredDistance<Number>(features, corner_a, [&](std::size_t j) { return placed<Number>(b_, pair.b[j]); });
}

/// The distance of triangles perpendicular to one axis, where their planes tell it; 0 where they share a corner. Where
/// many features are equally near, long numbers cannot be sure which are nearest.
template <class Pair>
std::optional<LongNumber> TriangleDistance::acrossAxis(const Pair& pair) const
{
  if (shareCorner(pair)) return LongNumber(0.0);
  if constexpr (std::is_same_v<Pair, PointPair>)
    return std::nullopt;
  else
    return gapOfFacing(longCorners(a_, pair.a), longCorners(b_, pair.b));
}

/// How they lie to each other if their planes are parallel.
template <class Pair>
PlaneOverlap TriangleDistance::overlap(const Pair& pair) const
{
  if constexpr (std::is_same_v<Pair, PointPair>) {
    return PlaneOverlap::unknown;
  }
  else {
    if (pair.known == nullptr) return findOverlap(pair);
    if (!pair.known->overlap) pair.known->overlap = findOverlap(pair);
    return *pair.known->overlap;
  }
}

/// Whether both certainly have a corner at one place. In a mesh against itself, nearly all that meet do.
template <class Pair>
bool TriangleDistance::shareCorner(const Pair& pair) const
{
  if (a_ != b_) return false;
  const auto isOfB = [&pair](const Point3& corner) {
    return std::find(pair.b.begin(), pair.b.end(), corner) != pair.b.end();
  };
  if constexpr (std::is_same_v<Pair, PointPair>)
    return isOfB(pair.a);
  else
    return std::any_of(pair.a.begin(), pair.a.end(), isOfB);
}

/// Which features are nearest, by the quickest numbers that are sure.
template <class Pair>
Features TriangleDistance::nearestFeatures(const Pair& pair, bool& by_integers) const
{
  if constexpr (std::is_same_v<Pair, TrianglePair>) {
    Known* const known = pair.known;
    if (known != nullptr && known->has_features) return {static_cast<Features::Kind>(known->kind), known->i, known->j};
    const Features found = findFeatures(pair, overlap(pair), by_integers);
    if (known != nullptr) *known = {known->overlap, found.kind, found.i, found.j, true};
    return found;
  }
  else {
    return findFeatures(pair, PlaneOverlap::unknown, by_integers);
  }
}

template <class Pair>
Features TriangleDistance::findFeatures(const Pair& pair, PlaneOverlap overlap, bool& by_integers) const
{
  if (shareCorner(pair)) return {Features::meeting, 0, 0};
  if (overlap == PlaneOverlap::over) return kPlanes;
  const Seen at = seen(pair.a, pair.b);
  if (isFinite(at.a) && isFinite(at.b) && std::isfinite(at.error)) {
    const auto rough = [&](const Triangle3& t) {
      std::array<Vector3<RoughNumber>, 3> corners;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) corners[i][k] = {t[i][k], at.error};
      return corners;
    };
    if constexpr (std::is_same_v<Pair, PointPair>) {
      const NearestFeatures<RoughNumber> found(Vector3<RoughNumber>{}, rough(at.b));
      if (found.sure()) return found.features();
    }
    else {
      const NearestFeatures<RoughNumber> found(rough(at.a), rough(at.b),
                                               distanceOfTriangles(at.a, at.b, at.error, kAnyLength).pairs);
      if (found.sure()) return found.features();
    }
  }
  const auto longer = nearest<LongNumber>(pair);
  if (longer.sure()) return longer.features();
  by_integers = true;
  return nearest<Dyadic>(pair).features();
}

template <class Pair>
int TriangleDistance::settle(const Pair& pair, const ExactDistance::Sum& reach, Stages& stages) const
{
  const auto sumOf = [&](auto sum) {
    for (const double term : reach)
      if (term != 0.0) sum += decltype(sum)(term);
    return sum;
  };
  bool by_integers = false, sure = true;
  const LongNumber length = sumOf(LongNumber(pair.radius));
  if (shareCorner(pair)) {
    const int side = -length.sign(sure);
    if (sure) return ++stages.doubles, side;
    sure = true;
  }
  if constexpr (std::is_same_v<Pair, TrianglePair>) {
    const LongCorners a = longCorners(a_, pair.a), b = longCorners(b_, pair.b);
    if (const std::optional<LongNumber> gap = gapOfFacing(a, b)) {
      const int side = (*gap - length).sign(sure);
      if (sure) return ++stages.long_numbers, side;
    }
    sure = true;
    if (length.sign(sure) >= 0 && sure && areFacesBeyond(a, b, length * length, LongNumber(1.0)))
      return ++stages.long_numbers, 1;
  }
  sure = true;
  const Features features = nearestFeatures(pair, by_integers);
  const int side = compareRoot(squared<LongNumber>(pair, features), length, sure);
  if (sure) return ++(by_integers ? stages.integers : stages.long_numbers), side;
  ++stages.integers;
  return compareRoot(squared<Dyadic>(pair, features), sumOf(Dyadic(pair.radius)), sure);
}

template <class Pair>
int TriangleDistance::settleOrder(const Pair& first, const TriangleDistance& other, const Pair& second,
                                  Stages& stages) const
{
  if (first.radius == second.radius && shareCorner(first) && other.shareCorner(second)) return ++stages.doubles, 0;
  const Enclosure x = enclose(first.a, first.b), y = other.enclose(second.a, second.b);
  const double slack =
      first.radius == second.radius ? 0.0 : 2 * kFewDoubleRoundings * (x.high + y.high + first.radius + second.radius);
  const double shift = second.radius - first.radius;
  if (x.high + shift + slack < y.low) return ++stages.doubles, -1;
  if (x.low + shift - slack > y.high) return ++stages.doubles, 1;
  if (this == &other && first.a == second.a && first.b == second.b && shift == 0.0) return ++stages.doubles, 0;
  bool by_integers = false, sure = true;
  if (first.radius == second.radius) {
    const std::optional<LongNumber> gap = acrossAxis(first), other_gap = gap ? other.acrossAxis(second) : std::nullopt;
    if (gap && other_gap) {
      const int side = (*gap - *other_gap).sign(sure);
      if (sure) return ++stages.long_numbers, side;
      sure = true;
    }
  }
  const auto compareSquares = [&](const Features& of_first, const Features& of_second) {
    const int side =
        compareFractions(squared<LongNumber>(first, of_first), other.squared<LongNumber>(second, of_second), sure);
    if (sure) return ++(by_integers ? stages.integers : stages.long_numbers), side;
    sure = true, ++stages.integers;
    return compareFractions(squared<Dyadic>(first, of_first), other.squared<Dyadic>(second, of_second), sure);
  };
  const PlaneOverlap faces_first = overlap(first), faces_second = other.overlap(second);
  if (first.radius == second.radius && faces_first != PlaneOverlap::unknown && faces_second != PlaneOverlap::unknown) {
    std::optional<int> as_given;
    if constexpr (std::is_same_v<Pair, TrianglePair>)
      if (this == &other) as_given = comparePlanesAsGiven(first, second);
    if (as_given) ++stages.long_numbers;
    const int side = as_given ? *as_given : compareSquares(kPlanes, kPlanes);
    if (faces_first == PlaneOverlap::over && faces_second == PlaneOverlap::over) return side;
    if (faces_second == PlaneOverlap::over && side >= 0) return 1;
    if (faces_first == PlaneOverlap::over && side <= 0) return -1;
  }
  const Features of_second = other.nearestFeatures(second, by_integers);
  if constexpr (std::is_same_v<Pair, TrianglePair>) {
    const Fraction<LongNumber> known = other.squared<LongNumber>(second, of_second);
    if (first.radius == second.radius &&
        areFacesBeyond(longCorners(a_, first.a), longCorners(b_, first.b), known.numerator, known.denominator))
      return ++stages.long_numbers, 1;
  }
  const Features of_first = nearestFeatures(first, by_integers);
  if (first.radius == second.radius) {
    if (this == &other && first.a == second.a && areOne(of_first, first.b, of_second, second.b))
      return ++stages.doubles, 0;
    return compareSquares(of_first, of_second);
  }
  ++stages.integers;
  return compareShiftedRoots(squared<Dyadic>(first, of_first), Dyadic(second.radius) - Dyadic(first.radius),
                             other.squared<Dyadic>(second, of_second));
}

template <class Pair>
double TriangleDistance::rounded(const Pair& pair, Stages& stages) const
{
  bool by_integers = false;
  if (pair.radius == 0.0) {
    if (const std::optional<LongNumber> gap = acrossAxis(pair)) return ++stages.long_numbers, gap->value();
  }
  const Features features = nearestFeatures(pair, by_integers);
  if (pair.radius == 0.0) {
    const double length = nearestRoot(squared<LongNumber>(pair, features));
    if (!std::isnan(length)) return ++(by_integers ? stages.integers : stages.long_numbers), length;
  }
  ++stages.integers;
  const Fraction<Dyadic> exact = squared<Dyadic>(pair, features);
  const Dyadic radius(pair.radius);
  bool always = true;
  if (compareRoot(exact, radius, always) == 0) return 0.0;
  return nearestDouble(roughRootLess(exact.numerator, exact.denominator, radius),
                       [&](const Dyadic& x) { return compareRoot(exact, radius + x, always); });
}

int TriangleDistance::compareGaps(const PointPair& first, const TriangleDistance& other, const PointPair& second,
                                  Stages* stages) const
{
  Stages none;
  return settleOrder(first, other, second, orNone(stages, none));
}

int TriangleDistance::compareGaps(const TrianglePair& first, const TriangleDistance& other, const TrianglePair& second,
                                  Stages* stages) const
{
  Stages none;
  return settleOrder(first, other, second, orNone(stages, none));
}

double TriangleDistance::distance(const Point3& p, const Triangle3& b, Stages* stages) const
{
  return gap(PointPair{p, b}, stages);
}

double TriangleDistance::distance(const Triangle3& a, const Triangle3& b, Stages* stages) const
{
  return gap(TrianglePair{a, b}, stages);
}

double TriangleDistance::gap(const PointPair& pair, Stages* stages) const
{
  Stages none;
  return rounded(pair, orNone(stages, none));
}

double TriangleDistance::gap(const TrianglePair& pair, Stages* stages) const
{
  Stages none;
  return rounded(pair, orNone(stages, none));
}

// For parallel_planes.cpp and between_nearest.cpp.
template std::array<Dyadic, 3> TriangleDistance::placed<Dyadic>(const Pose&, const Point3&) const;
template bool TriangleDistance::shareCorner(const TrianglePair&) const;
template Features TriangleDistance::nearestFeatures(const PointPair&, bool&) const;
template Features TriangleDistance::nearestFeatures(const TrianglePair&, bool&) const;

} // namespace pcl_bsh
