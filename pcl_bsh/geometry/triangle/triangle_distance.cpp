// SPDX-License-Identifier: BSD-3-Clause
// Stages, each used only where it is sure of itself: an enclosure in double, the nearest features in numbers of twice
// the digits that know their error, and the same in integers of any length.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl_bsh/geometry/exact/exact_plane.h>
#include <pcl_bsh/geometry/exact/nearest_double.h>
#include <pcl_bsh/geometry/exact/rough_root_less.h>
#include <pcl_bsh/geometry/exact/rounded_length.h>
#include <pcl_bsh/geometry/triangle/double_distance.h>
#include <pcl_bsh/geometry/triangle/facing.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>
#include <pcl_bsh/geometry/triangle/ordinary_length.h>

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

/// Sign of the root of a fraction less a length. @param squared >= 0
template <class Number>
int compareRoot(const Fraction<Number>& squared, const Number& length, bool& sure)
{
  if (signOf(length, sure) < 0) return 1;
  return signOf(squared.numerator - squared.denominator * (length * length), sure);
}

/// Its root, rounded to the nearest double; NaN where that is in doubt.
///
/// The quotient q of the values is corrected by what is left of the numerator, n - q d, as LongNumber has it, over d.
/// The correction is rounded by v twice, and taken over d's value, which is v of d off: 4 v of the correction; what n
/// - q d errs by stays as it is.
double nearestRoot(const Fraction<LongNumber>& squared)
{
  const LongNumber &n = squared.numerator, &d = squared.denominator;
  if (n.value() == 0.0 && n.tail() == 0.0 && n.error() == 0.0) return 0.0;
  const double quotient = n.value() / d.value();
  if (!(quotient > 0x1p-800 && quotient < 0x1p800 && d.value() > 0x1p-400 && d.value() < 0x1p400))
    return std::numeric_limits<double>::quiet_NaN();
  const LongNumber left = n - LongNumber(quotient) * d;
  const double correction = (left.value() + left.tail()) / d.value();
  const double error = 2.0 * left.error() / d.value() + 8 * kDoubleUnit * std::abs(correction);
  return roundedRoot(quotient, correction, error);
}

/// Sign of sqrt(x) + shift - sqrt(y).
int compareShiftedRoots(const Fraction<Dyadic>& x, const Dyadic& shift, const Fraction<Dyadic>& y)
{
  bool always = true;
  if (shift.sign() == 0) return compareFractions(x, y, always);
  if (shift.sign() < 0) return -compareShiftedRoots(y, -shift, x);
  // Both sides are >= 0, so their squares compare alike, here times both denominators.
  const Dyadic both = x.denominator * y.denominator, square = shift * shift;
  const Dyadic rational = x.numerator * y.denominator + square * both - y.numerator * x.denominator;
  const Dyadic irrational_squared = Dyadic(4.0) * square * x.numerator * y.denominator * both;
  return rational.sign() >= 0 ? (rational + irrational_squared).sign()
                              : (irrational_squared - rational * rational).sign();
}

/// Whether both features lie on one corner or one edge of the second triangles: those of a mesh share theirs.
bool areOne(const Features& x, const Triangle3& of_x, const Features& y, const Triangle3& of_y)
{
  if (x.kind != y.kind || x.i != y.i) return false;
  if (x.kind == Features::corners || x.kind == Features::edge_corner) return of_x[x.j] == of_y[y.j];
  if (x.kind != Features::corner_edge && x.kind != Features::edges) return false;
  const Point3 &from_x = of_x[x.j], &to_x = of_x[(x.j + 1) % 3u], &from_y = of_y[y.j], &to_y = of_y[(y.j + 1) % 3u];
  return (from_x == from_y && to_x == to_y) || (from_x == to_y && to_x == from_y);
}

/// The distance of parallel planes: of a corner from the first face, which has a normal.
constexpr Features kPlanes = {Features::face_corner, 0, 0};

Vector3<LongNumber> asGiven(const Point3& p)
{
  return {LongNumber(p[0]), LongNumber(p[1]), LongNumber(p[2])};
}
LongCorners asGiven(const Triangle3& t)
{
  return {asGiven(t[0]), asGiven(t[1]), asGiven(t[2])};
}

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

TriangleDistance::Seen TriangleDistance::seen(const Point3& a, const Triangle3& b) const
{
  Seen seen{{}, {}, 0.0};
  for (std::size_t j = 0; j < 3; ++j) {
    const ExactDistance::Difference z = points_.approximate(a, b[j]);
    seen.b[j] = {-z.vector[0], -z.vector[1], -z.vector[2]};
    seen.error = std::max(seen.error, z.error);
  }
  return seen;
}

/// The corners of b by way of the first of a.
TriangleDistance::Seen TriangleDistance::seen(const Triangle3& a, const Triangle3& b) const
{
  Seen seen{{}, {}, 0.0};
  double error_a = 0.0, error_b = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactDistance::Difference z = points_.approximate(a[i], b[0]);
    seen.a[i] = z.vector;
    error_a = std::max(error_a, z.error);
  }
  for (std::size_t j = 1; j < 3; ++j) {
    const ExactDistance::Difference z = points_.approximate(a[0], b[j]);
    seen.b[j] = seen.a[0] - z.vector;
    double largest = 0.0;
    for (const double x : seen.b[j]) largest = std::max(largest, std::abs(x));
    error_b = std::max(error_b, error_a + z.error + 2 * kDoubleUnit * largest);
  }
  seen.error = (error_a + error_b) * (1.0 + kDoubleMargin);
  return seen;
}

TriangleDistance::Enclosure TriangleDistance::enclose(const Point3& p, const Triangle3& b) const
{
  const Seen at = seen(p, b);
  if (!isFinite(at.b) || !std::isfinite(at.error)) return {-kAnyLength, kAnyLength};
  return distanceOfOrigin(flatten<double>(at.b, at.error));
}

TriangleDistance::Enclosure TriangleDistance::enclose(const Triangle3& a, const Triangle3& b, double reach) const
{
  const Seen at = seen(a, b);
  return distanceOfTriangles(at.a, at.b, at.error, reach).distance;
}

/// In double, of a distance that is compared with a sum: eight additions at most, rounded relative to what they add up.
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

/// The distance of triangles across one axis, where it is known by the planes of both: of what features are nearest,
/// long numbers cannot be sure where many are.
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
Facing TriangleDistance::facing(const Pair& pair) const
{
  if constexpr (std::is_same_v<Pair, PointPair>) {
    return Facing::unknown;
  }
  else {
    if (pair.known == nullptr) return findFacing(pair);
    if (!pair.known->facing) pair.known->facing = findFacing(pair);
    return *pair.known->facing;
  }
}

Facing TriangleDistance::findFacing(const TrianglePair& pair) const
{
  if (shareCorner(pair)) return Facing::unknown;
  std::optional<bool> parallel = areParallelAsGiven(pair);
  const LongCorners a = longCorners(a_, pair.a), b = longCorners(b_, pair.b);
  if (!parallel) parallel = areParallel(a, b);
  if (parallel == false) return Facing::unknown;
  const Facing facing = facingOf(a, b);
  if (parallel || facing == Facing::unknown) return facing;
  const auto corners = [this](const Pose& pose, const Triangle3& t) -> std::array<Vector3<Dyadic>, 3> {
    return {placed<Dyadic>(pose, t[0]), placed<Dyadic>(pose, t[1]), placed<Dyadic>(pose, t[2])};
  };
  return *areParallel(corners(a_, pair.a), corners(b_, pair.b)) ? facing : Facing::unknown;
}

/// Whether planes are parallel, in the given coordinates: those of one pose have short numbers there. Nothing where
/// that is not known.
std::optional<bool> TriangleDistance::areParallelAsGiven(const TrianglePair& pair) const
{
  if (a_ != b_) return std::nullopt;
  return areParallel(asGiven(pair.a), asGiven(pair.b));
}

/// Sign of the distance of the planes of the first pair less that of the second, which are all parallel. Compares
/// pairs of one pose in the given coordinates: the pose stretches all gaps alike. Nothing where that is not known.
std::optional<int> TriangleDistance::comparePlanesAsGiven(const TrianglePair& first, const TrianglePair& second) const
{
  if (a_ != b_) return std::nullopt;
  const LongCorners a = asGiven(first.a), other = asGiven(second.a);
  if (areParallel(a, other) != true) return std::nullopt;
  const Vector3<LongNumber> normal = cross(a[1] - a[0], a[2] - a[0]);
  const Vector3<LongNumber> way = asGiven(first.b[0]) - a[0], other_way = asGiven(second.b[0]) - other[0];
  bool sure = true;
  const int up = dot(normal, way).sign(sure), other_up = dot(normal, other_way).sign(sure);
  if (up == 0) return sure ? std::optional(other_up == 0 ? 0 : -1) : std::nullopt;
  const Vector3<LongNumber> more = up == other_up ? way - other_way : way + other_way;
  const int side = up * dot(normal, more).sign(sure);
  return sure ? std::optional(side) : std::nullopt;
}

/// Whether both have a corner at one place for certain: of a mesh against itself nearly all that meet do.
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
    const Features found = findFeatures(pair, facing(pair), by_integers);
    if (known != nullptr) *known = {known->facing, found.kind, found.i, found.j, true};
    return found;
  }
  else {
    return findFeatures(pair, Facing::unknown, by_integers);
  }
}

template <class Pair>
Features TriangleDistance::findFeatures(const Pair& pair, Facing facing, bool& by_integers) const
{
  if (shareCorner(pair)) return {Features::meeting, 0, 0};
  if (facing == Facing::over) return kPlanes;
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
  const Facing faces_first = facing(first), faces_second = other.facing(second);
  if (first.radius == second.radius && faces_first != Facing::unknown && faces_second != Facing::unknown) {
    std::optional<int> as_given;
    if constexpr (std::is_same_v<Pair, TrianglePair>)
      if (this == &other) as_given = comparePlanesAsGiven(first, second);
    if (as_given) ++stages.long_numbers;
    const int side = as_given ? *as_given : compareSquares(kPlanes, kPlanes);
    if (faces_first == Facing::over && faces_second == Facing::over) return side;
    if (faces_second == Facing::over && side >= 0) return 1;
    if (faces_first == Facing::over && side <= 0) return -1;
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

namespace {

const Point3& cornerOf(const Point3& point, std::size_t)
{
  return point;
}
const Point3& cornerOf(const Triangle3& triangle, std::size_t i)
{
  return triangle[i % 3];
}

/// Across the nearest parts of two that do not meet. @param edge_a, edge_b the sides, called with their first corner's
/// number @param between a place on the one and one on the other
template <class EdgeA, class EdgeB>
Vector3<Dyadic> normalAcross(const Features& features, const EdgeA& edge_a, const EdgeB& edge_b,
                             const Vector3<Dyadic>& between)
{
  const auto across = [&](const Vector3<Dyadic>& edge) {
    return dot(edge, edge) * between - dot(between, edge) * edge;
  };
  switch (features.kind) {
  case Features::meeting:
  case Features::corners:
    return between;
  case Features::corner_edge:
    return across(edge_b(features.j));
  case Features::edge_corner:
    return across(edge_a(features.i));
  case Features::edges:
    return cross(edge_a(features.i), edge_b(features.j));
  case Features::corner_face:
    return cross(edge_b(0), edge_b(1));
  case Features::face_corner:
    break;
  }
  return cross(edge_a(0), edge_a(1));
}

/// Its direction, rounded: the largest part is in [1, 2).
Point3 ofLengthOne(const Vector3<Dyadic>& v)
{
  const Dyadic::Scaled parts[3] = {v[0].scaled(), v[1].scaled(), v[2].scaled()};
  const int largest = std::max({parts[0].exponent, parts[1].exponent, parts[2].exponent});
  const auto part = [&](std::size_t k) { return std::ldexp(parts[k].mantissa, parts[k].exponent - largest); };
  return {part(0), part(1), part(2)};
}

} // namespace

template <class Pair>
Point3 TriangleDistance::betweenNearest(const Pair& pair) const
{
  bool by_integers = false;
  const Features features = nearestFeatures(pair, by_integers);
  const Seen at = seen(pair.a, pair.b);
  const std::size_t i = features.i, j = features.j, next_i = (i + 1) % 3, next_j = (j + 1) % 3;
  const auto across = [](const Point3& from, const Point3& way) { // from a line through 0
    const Point3 edge = ofOrdinaryLength(way);
    return from - (dot(from, edge) / dot(edge, edge)) * edge;
  };
  const auto along = [&](const Point3& from, const Point3& u, const Point3& v) { // from a plane through 0
    const Point3 way_u = ofOrdinaryLength(u), way_v = ofOrdinaryLength(v);
    Point3 normal = cross(way_u, way_v);
    constexpr double needle = 0x1p-40; // of the sine, squared: rounding may turn the normal by its root
    if (!(dot(normal, normal) > needle * dot(way_u, way_u) * dot(way_v, way_v)))
      normal = ofLengthOne(normalAcross(
          features,
          [&](std::size_t k) {
            return placed<Dyadic>(a_, cornerOf(pair.a, k + 1)) - placed<Dyadic>(a_, cornerOf(pair.a, k));
          },
          [&](std::size_t k) { return placed<Dyadic>(b_, pair.b[(k + 1) % 3]) - placed<Dyadic>(b_, pair.b[k]); },
          Vector3<Dyadic>()));
    return (dot(from, normal) / dot(normal, normal)) * normal;
  };
  switch (features.kind) {
  case Features::meeting:
    return {0.0, 0.0, 0.0};
  case Features::corners:
    return at.a[i] - at.b[j];
  case Features::corner_edge:
    return across(at.a[i] - at.b[j], at.b[next_j] - at.b[j]);
  case Features::edge_corner:
    return -1.0 * across(at.b[j] - at.a[i], at.a[next_i] - at.a[i]);
  case Features::edges:
    return along(at.a[i] - at.b[j], at.a[next_i] - at.a[i], at.b[next_j] - at.b[j]);
  case Features::corner_face:
    return along(at.a[i] - at.b[0], at.b[1] - at.b[0], at.b[2] - at.b[0]);
  case Features::face_corner:
    break;
  }
  return -1.0 * along(at.b[j] - at.a[0], at.a[1] - at.a[0], at.a[2] - at.a[0]);
}

template <class Pair>
std::optional<std::array<ExactPlane, 2>> TriangleDistance::planesOfNearest(const Pair& pair) const
{
  using Vector = Vector3<Dyadic>;
  bool by_integers = false;
  const Features features = nearestFeatures(pair, by_integers);
  if (features.kind == Features::meeting) return std::nullopt;
  const auto given_a = [&pair](std::size_t i) { return cornerOf(pair.a, i); };
  const auto edge_a = [&](std::size_t i) {
    return placed<Dyadic>(a_, given_a(i + 1)) - placed<Dyadic>(a_, given_a(i));
  };
  const auto edge_b = [&](std::size_t j) {
    return placed<Dyadic>(b_, pair.b[(j + 1) % 3]) - placed<Dyadic>(b_, pair.b[j]);
  };
  const std::size_t i = features.i, j = features.j;
  const Vector between = placed<Dyadic>(b_, pair.b[j]) - placed<Dyadic>(a_, given_a(i)); // from one plane to the other
  const Vector normal = normalAcross(features, edge_a, edge_b, between);
  const int side = dot(normal, between).sign();
  if (side == 0) return std::nullopt;
  const auto plane = [&normal](const Pose& pose, const Point3& through, double towards) {
    Vector turned; // back
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t k = 0; k < 3; ++k) turned[k] += Dyadic(towards * pose[row][k]) * normal[row];
    return ExactPlane(through, turned);
  };
  return std::array<ExactPlane, 2>{plane(a_, given_a(i), side), plane(b_, pair.b[j], -side)};
}

Point3 TriangleDistance::between(const PointPair& pair) const
{
  return betweenNearest(pair);
}

Point3 TriangleDistance::between(const TrianglePair& pair) const
{
  return betweenNearest(pair);
}

std::optional<std::array<ExactPlane, 2>> TriangleDistance::planesBetween(const PointPair& pair) const
{
  return planesOfNearest(pair);
}

std::optional<std::array<ExactPlane, 2>> TriangleDistance::planesBetween(const TrianglePair& pair) const
{
  return planesOfNearest(pair);
}

} // namespace pcl_bsh
