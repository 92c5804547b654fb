// SPDX-License-Identifier: BSD-3-Clause
// A placed triangle in numbers of twice a double's digits, and the part of it that is nearest to a point. It keeps
// values that do not depend on the points it is compared with.

#if defined(PCL_BSH_TRAVERSAL_LONG_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_LONG_TRIANGLE_INL_H_
#undef PCL_BSH_TRAVERSAL_LONG_TRIANGLE_INL_H_
#else
#define PCL_BSH_TRAVERSAL_LONG_TRIANGLE_INL_H_
#endif

#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/exact/rounded_length.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/geometry/triangle/vector3.h>
#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A vector, value + tail, each coordinate within `error`.
struct LongVector {
  double value[3], tail[3];
  double error;
  bool plain; ///< without tails, and exact

  LongVector() = default;
  explicit LongVector(const Point3& p) : value{p[0], p[1], p[2]}, tail{0.0, 0.0, 0.0}, error(0.0), plain(true) {}
  explicit LongVector(const Vector3<LongNumber>& from) : error(0.0), plain(true)
  {
    for (std::size_t k = 0; k < 3; ++k) {
      value[k] = from[k].value();
      tail[k] = from[k].tail();
      error = std::max(error, from[k].error());
      plain = plain && tail[k] == 0.0;
    }
    plain = plain && error == 0.0;
  }
  LongCoordinate operator[](std::size_t k) const { return {value[k], tail[k], error}; }
};

inline Vector3<LongNumber> placedLong(const Eigen::Isometry3d& pose, const Point3& p)
{
  return placedBy<LongNumber>(
      [&pose](std::size_t row, std::size_t column) {
        return pose.matrix()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
      },
      p);
}

/// x - y, one coordinate. Where both are plain, the difference of the values and its rounding error are exact.
HWY_INLINE LongCoordinate lessLong(const LongVector& x, const LongVector& y, std::size_t k)
{
  const WithError between = twoSum(x.value[k], -y.value[k]);
  if (x.plain && y.plain) return {between.value, between.error, 0.0};
  const WithError sum = twoSum(between.value, between.error + (x.tail[k] - y.tail[k]));
  const double tails = std::abs(x.tail[k]) + std::abs(y.tail[k]);
  const double rounded = tails > 0.0 ? tails + std::abs(between.error) : 0.0;
  return {sum.value, sum.error, (x.error + y.error + 4 * kDoubleUnit * rounded) * (1.0 + kDoubleMargin)};
}
HWY_INLINE LongVector lessLong(const LongVector& x, const LongVector& y)
{
  LongVector z;
  z.error = 0.0;
  z.plain = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const LongCoordinate c = lessLong(x, y, k);
    z.value[k] = c.value, z.tail[k] = c.tail;
    z.error = std::max(z.error, c.error);
  }
  return z;
}

/// A vector of length 1, if it is known well enough.
struct LongDirection {
  enum State : std::uint8_t { not_asked, unknown, along_axis, known };
  State state = not_asked;
  std::uint8_t axis = 0;  ///< if along_axis: the coordinate there is 1 or -1
  std::uint8_t zeros = 0; ///< bits of the axes along which it surely has no part
  LongVector unit;

  bool isAcross(std::size_t k) const { return (zeros >> k & 1u) != 0; }

  /// @param v of any length
  void set(const Vector3<LongNumber>& v)
  {
    state = unknown;
    zeros = 0;
    int others = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool zero = v[k].isZero();
      zeros |= static_cast<std::uint8_t>((zero ? 1u : 0u) << k);
      if (zero)
        ++others;
      else
        axis = static_cast<std::uint8_t>(k);
    }
    const LongNumber square = dot(v, v);
    if (!(square.value() > 0x1p-400 && square.value() < 0x1p400)) return;
    // Newton's step from the root in double errs by at most 0.4 t^2 of the root. The tail of t is 2^-101 at most.
    const double root = 1.0 / std::sqrt(square.value());
    const LongNumber t = LongNumber(1.0) - square * (LongNumber(root) * LongNumber(root));
    if (!(std::abs(t.value()) < 0x1p-48)) return;
    const WithError inverse = twoSum(root, 0.5 * root * t.value());
    const LongNumber factor(inverse.value, inverse.error, root * (0x1p-95 + t.error()));
    unit = LongVector(Vector3<LongNumber>{v[0] * factor, v[1] * factor, v[2] * factor});
    if (!(unit.error < kMostError)) return;
    state = known;
    if (others != 2) return;
    bool sure = true;
    const int sign = v[axis].sign(sure);
    if (!sure || sign == 0) return;
    for (std::size_t k = 0; k < 3; ++k) unit.value[k] = k == axis ? sign : 0.0, unit.tail[k] = 0.0;
    unit.error = 0.0;
    state = along_axis;
  }

  static constexpr double kMostError = 0x1p-65; ///< with a greater one few lengths are known
};

/// Error of a sum of products of two long vectors, relative to the absolute sum of the products of their coordinates.
/// Dropped terms are v^2 of it. Ten sums and products of low order err by v each, of terms that are 5 v of it together.
inline constexpr double kLongProductError = 0x1p-99;

/// A triangle of b, placed by its pose.
struct LongTriangle {
  Triangle3 given;
  Vector3<LongNumber> corners[3];
  LongVector stored[3]; ///< the corners again
  bool usable = false;  ///< whether the following are set
  Point3 normal;
  Point3 edges[3], outward[3]; ///< from corner j to the next one, and in the plane away from the triangle; of length 1
  double lengths[3];           ///< of its edges
  double along[3] = {}, side[3]; ///< coordinates of corner j from corner 0, along edge j and outward
  double longest = 0.0,
         doubt = 0; ///< error of coordinates along these, relative to the place's distance plus `longest`
  LongDirection long_normal, long_edges[3];

  void set(const Triangle3& triangle, const Eigen::Isometry3d& pose)
  {
    given = triangle;
    for (std::size_t j = 0; j < 3; ++j) {
      corners[j] = placedLong(pose, triangle[j]);
      stored[j] = LongVector(corners[j]);
    }
    long_normal.state = LongDirection::not_asked;
    for (LongDirection& edge : long_edges) edge.state = LongDirection::not_asked;
    usable = false;
    longest = 0.0;
    Point3 from_first[3], ways[3];
    for (std::size_t j = 0; j < 3; ++j) from_first[j] = differenceOf(j, 0);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < 3; ++j) {
      ways[j] = differenceOf((j + 1) % 3, j);
      lengths[j] = std::sqrt(pcl_bsh::dot(ways[j], ways[j]));
      longest = std::max(longest, lengths[j]);
      least = std::min(least, lengths[j]);
    }
    const Point3 across = pcl_bsh::cross(ways[0], ways[1]);
    const double area = std::sqrt(pcl_bsh::dot(across, across));
    const double error = std::max({stored[0].error, stored[1].error, stored[2].error});
    if (!(least > 0x1p-200 && longest < 0x1p200 && area > 0x1p-20 * longest * longest && error < 0x1p-60 * least))
      return;
    // A corner's difference errs by v, products and their difference by 3 v of |way| |way|, of which the area is a
    // part.
    doubt = 0x1p-46 + 0x1p-48 * (longest * longest / area);
    normal = (1.0 / area) * across;
    for (std::size_t j = 0; j < 3; ++j) {
      edges[j] = (1.0 / lengths[j]) * ways[j];
      outward[j] = pcl_bsh::cross(edges[j], normal);
      along[j] = pcl_bsh::dot(edges[j], from_first[j]);
      side[j] = pcl_bsh::dot(outward[j], from_first[j]);
    }
    usable = true;
  }

  /// The directions of edge j, and of the normal. Computed when first asked for.
  const LongDirection& edge(std::size_t j)
  {
    if (long_edges[j].state == LongDirection::not_asked) long_edges[j].set(corners[(j + 1) % 3] - corners[j]);
    return long_edges[j];
  }
  const LongDirection& face()
  {
    if (long_normal.state == LongDirection::not_asked)
      long_normal.set(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return long_normal;
  }

private:
  Point3 differenceOf(std::size_t i, std::size_t j) const
  {
    Point3 z;
    for (std::size_t k = 0; k < 3; ++k)
      z[k] = (stored[i].value[k] - stored[j].value[k]) + (stored[i].tail[k] - stored[j].tail[k]);
    return z;
  }
};

/// The part of a triangle that is nearest to a point, where doubles are sure of it, and the distance.
struct NearPart {
  enum Kind : std::uint8_t { not_sure, face, edge, corner };
  Kind kind = not_sure;
  std::uint8_t j = 0; ///< of the edge, which begins at corner j, or of the corner
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// Returns the part nearest to a place. The triangle's inside, strips along its edges and wedges at its corners divide
/// its plane. A part is sure where all of its borders are farther from the place than double arithmetic errs.
/// @param place of the point
HWY_INLINE NearPart nearPartOf(const LongTriangle& triangle, const LongVector& place)
{
  NearPart part;
  if (!triangle.usable) return part;
  const LongVector& first = triangle.stored[0];
  Point3 w;
  for (std::size_t k = 0; k < 3; ++k) w[k] = (place.value[k] - first.value[k]) + (place.tail[k] - first.tail[k]);
  const double size = triangle.longest + std::abs(w[0]) + std::abs(w[1]) + std::abs(w[2]);
  const double doubt = triangle.doubt * size + 4.0 * (place.error + first.error);
  double sides[3];
  for (std::size_t j = 0; j < 3; ++j) sides[j] = pcl_bsh::dot(triangle.outward[j], w) - triangle.side[j];
  const double height = pcl_bsh::dot(triangle.normal, w);
  double length = 0.0;
  if (sides[0] < -doubt && sides[1] < -doubt && sides[2] < -doubt) {
    part.kind = NearPart::face;
    length = std::abs(height);
  }
  else {
    double along[3];
    for (std::size_t j = 0; j < 3; ++j) along[j] = pcl_bsh::dot(triangle.edges[j], w) - triangle.along[j];
    for (std::uint8_t j = 0; j < 3 && part.kind == NearPart::not_sure; ++j) {
      const std::size_t before = (j + 2u) % 3;
      part.j = j;
      if (sides[j] > doubt && along[j] > doubt && along[j] < triangle.lengths[j] - doubt) {
        part.kind = NearPart::edge;
        length = std::sqrt(height * height + sides[j] * sides[j]);
      }
      else if (along[j] < -doubt && along[before] > triangle.lengths[before] + doubt) {
        part.kind = NearPart::corner;
        length = std::sqrt(height * height + sides[j] * sides[j] + along[j] * along[j]);
      }
    }
  }
  if (part.kind == NearPart::not_sure || !(length < 0x1p200)) return {};
  part.low = length - 4.0 * doubt;
  part.high = length + 4.0 * doubt;
  return part;
}

/// A part with the corners that it lies between. Neighbours that share the part have equal corners.
struct SharedPart : NearPart {
  Point3 from = {}, to = {};

  SharedPart() = default;
  SharedPart(const NearPart& part, const LongTriangle& triangle)
  : NearPart(part),
    from(triangle.given[part.j]),
    to(part.kind == edge ? triangle.given[(part.j + 1u) % 3] : from)
  {
  }

  /// Whether both are one corner or one edge.
  bool isSameAs(const SharedPart& other) const
  {
    if (kind != other.kind || kind == not_sure || kind == face) return false;
    return (from == other.from && to == other.to) || (from == other.to && to == other.from);
  }
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
