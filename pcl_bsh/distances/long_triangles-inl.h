// SPDX-License-Identifier: BSD-3-Clause
// Points against triangles in numbers of twice a double's digits: which of two triangles is nearer, and the distance,
// rounded to the nearest double; or no answer. What does not depend on the point is computed once for each triangle.

#if defined(PCL_BSH_DISTANCES_LONG_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_LONG_TRIANGLES_INL_H_
#undef PCL_BSH_DISTANCES_LONG_TRIANGLES_INL_H_
#else
#define PCL_BSH_DISTANCES_LONG_TRIANGLES_INL_H_
#endif

#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/exact/rounded_length.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/geometry/triangle/vector3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

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

/// x - y, one coordinate. Where neither has a tail, the rounding error of the difference is all of it.
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

/// A vector of length 1 that is known well enough.
struct LongDirection {
  enum State : std::uint8_t { not_asked, unknown, along_axis, known };
  State state = not_asked;
  std::uint8_t axis = 0; ///< that it is along: its coordinate there is 1 or -1
  LongVector unit;

  /// @param v of any length
  void set(const Vector3<LongNumber>& v)
  {
    state = unknown;
    int others = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool zero = v[k].value() == 0.0 && v[k].tail() == 0.0 && v[k].error() == 0.0;
      if (zero)
        ++others;
      else
        axis = static_cast<std::uint8_t>(k);
    }
    const LongNumber square = dot(v, v);
    if (!(square.value() > 0x1p-400 && square.value() < 0x1p400)) return;
    // Newton's step from the root in double, which it takes to within 0.4 t^2 of itself.
    const double root = 1.0 / std::sqrt(square.value());
    const LongNumber t = LongNumber(1.0) - square * (LongNumber(root) * LongNumber(root));
    if (!(std::abs(t.value()) < 0x1p-48)) return;
    const WithError inverse = twoSum(root, 0.5 * root * (t.value() + t.tail()));
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

/// Of products of two long vectors, relative to the absolute sum of the products of their coordinates: what is dropped
/// is v^2 of it, and ten sums and products of low order, of terms that are 5 v of it together, err by v each.
inline constexpr double kLongProductError = 0x1p-99;

/// A triangle of b, placed by its pose.
struct LongTriangle {
  Triangle3 given;
  Vector3<LongNumber> corners[3];
  LongVector stored[3]; ///< the same
  bool usable = false;  ///< whether the following are set
  Point3 normal;
  Point3 edges[3], outward[3]; ///< from corner j to the next one, and in the plane away from the triangle; of length 1
  double lengths[3];           ///< of its edges
  double along[3] = {}, side[3]; ///< what corner j is at, from corner 0, along edge j and outward
  double longest = 0.0,
         doubt = 0; ///< of what is measured along these, as a share of the place's distance and `longest`
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

  /// The direction of edge j; or of the normal.
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

/// In the triangle's plane its inside, strips along its edges and wedges at its corners share all places between them.
/// A part is sure where all that bounds it is farther away than what double arithmetic errs by.
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

/// A part with the corners that it lies between: neighbours share theirs.
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

/// x[i] y[j] - x[j] y[i], but for what both vectors err by.
HWY_INLINE LongCoordinate longMoment(const LongVector& x, const LongVector& y, std::size_t i, std::size_t j)
{
  const WithError p = twoProduct(x.value[i], y.value[j]), q = twoProduct(-x.value[j], y.value[i]);
  const WithError sum = twoSum(p.value, q.value);
  const double low = (sum.error + (p.error + q.error)) + ((x.value[i] * y.tail[j] + x.tail[i] * y.value[j]) -
                                                          (x.value[j] * y.tail[i] + x.tail[j] * y.value[i]));
  const WithError all = twoSum(sum.value, low);
  return {all.value, all.error, kLongProductError * (std::abs(p.value) + std::abs(q.value))};
}

/// The double nearest to the length of one coordinate; NaN where that is in doubt.
HWY_INLINE double roundedHeight(const LongCoordinate& height)
{
  const bool sure = height.error == 0.0 ||
                    (height.value + (height.tail + height.error) == height.value &&
                     height.value + (height.tail - height.error) == height.value && std::abs(height.value) > 0x1p-400);
  return sure ? std::abs(height.value) : std::numeric_limits<double>::quiet_NaN();
}

/// The distance of a point from the part of the triangle that is nearest, rounded to the nearest double; NaN where that
/// is in doubt.
HWY_INLINE double longDistance(LongTriangle& triangle, const NearPart& part, const LongVector& place)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (part.kind == NearPart::not_sure) return none;
  const LongVector& from = triangle.stored[part.kind == NearPart::face ? 0 : part.j];
  if (part.kind == NearPart::face && triangle.face().state == LongDirection::along_axis)
    return roundedHeight(lessLong(place, from, triangle.face().axis));
  const LongVector w = lessLong(place, from);
  if (part.kind == NearPart::corner) return roundedLength({w[0], w[1], w[2]}, 0.0, 0.0);
  const double size = std::abs(w.value[0]) + std::abs(w.value[1]) + std::abs(w.value[2]);
  if (!(size > 0x1p-300 && size < 0x1p300)) return none;
  if (part.kind == NearPart::edge) {
    const LongDirection& edge = triangle.edge(part.j);
    const LongVector& u = edge.unit;
    if (edge.state == LongDirection::along_axis) {
      const std::size_t y = (edge.axis + 1u) % 3, z = (edge.axis + 2u) % 3;
      return roundedLength({w[y], w[z], LongCoordinate()}, 0.0, 0.0);
    }
    if (edge.state != LongDirection::known) return none;
    std::array<LongCoordinate, 3> moment = {longMoment(w, u, 1, 2), longMoment(w, u, 2, 0), longMoment(w, u, 0, 1)};
    const double error = (2.0 * w.error + u.error * size) * (1.0 + kDoubleMargin) + 0x1p-960;
    for (LongCoordinate& c : moment) c.error += error;
    return roundedLength(moment, 0.0, 0.0);
  }
  const LongDirection& face = triangle.face();
  if (face.state != LongDirection::known) return none;
  const LongVector& n = face.unit;
  WithError sum = twoProduct(n.value[0], w.value[0]);
  double low = sum.error + (n.value[0] * w.tail[0] + n.tail[0] * w.value[0]);
  for (std::size_t k = 1; k < 3; ++k) {
    const WithError p = twoProduct(n.value[k], w.value[k]), s = twoSum(sum.value, p.value);
    sum.value = s.value;
    low += (s.error + p.error) + (n.value[k] * w.tail[k] + n.tail[k] * w.value[k]);
  }
  const WithError all = twoSum(sum.value, low);
  return roundedHeight({all.value, all.error,
                        (2.0 * w.error + (n.error + kLongProductError) * size) * (1.0 + kDoubleMargin) + 0x1p-960});
}

/// Triangles of one cloud at one pose that were asked for of late.
class LongTriangles {
public:
  /// Before a walk.
  void forget() { records_.assign(kSlots, kNoRecord); }

  /// Valid until the next call.
  LongTriangle& of(const TrianglesView& view, const Eigen::Isometry3d& pose, std::uint32_t record)
  {
    const std::uint32_t slot = record * 0x9e3779b1u >> (32 - kSlotBits);
    if (triangles_.empty()) triangles_.resize(kSlots);
    if (records_[slot] != record) {
      triangles_[slot].set(view.triangle(record), pose);
      records_[slot] = record;
    }
    return triangles_[slot];
  }

  std::size_t bytes() const noexcept
  {
    return triangles_.capacity() * sizeof(LongTriangle) + records_.capacity() * sizeof(std::uint32_t);
  }

private:
  static constexpr std::uint32_t kSlotBits = 9, kSlots = 1u << kSlotBits, kNoRecord = 0xffffffffu;

  std::vector<LongTriangle> triangles_;
  std::vector<std::uint32_t> records_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
