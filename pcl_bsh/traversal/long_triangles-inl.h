// SPDX-License-Identifier: BSD-3-Clause
// Compares points with triangles in numbers of twice a double's digits. Tells which of two triangles is nearer, or at
// which of two poses one triangle is, and rounds the distance to the nearest double; or gives no answer. Values that do
// not depend on the point are computed once for each triangle.

#if defined(PCL_BSH_TRAVERSAL_LONG_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_LONG_TRIANGLES_INL_H_
#undef PCL_BSH_TRAVERSAL_LONG_TRIANGLES_INL_H_
#else
#define PCL_BSH_TRAVERSAL_LONG_TRIANGLES_INL_H_
#endif

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/traversal/long_triangle-inl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// x[i] y[j] - x[j] y[i]. The error leaves out the errors of both vectors.
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

using LongSpan = std::array<LongCoordinate, 3>;

HWY_INLINE LongSpan spanOf(const LongCoordinate& x, const LongCoordinate& y = {}, const LongCoordinate& z = {})
{
  LongSpan span;
  span[0] = x, span[1] = y, span[2] = z;
  return span;
}

/// Sets `span` to a vector as long as the distance of a point from the nearest part of the triangle. Returns false
/// where that is in doubt. Coordinates that are known to be 0 come last, for faces and for edges along an axis.
HWY_INLINE bool longSpan(LongTriangle& triangle, const NearPart& part, const LongVector& place, LongSpan& span)
{
  if (part.kind == NearPart::not_sure) return false;
  const LongVector& from = triangle.stored[part.kind == NearPart::face ? 0 : part.j];
  if (part.kind == NearPart::face && triangle.face().state == LongDirection::along_axis) {
    span = spanOf(lessLong(place, from, triangle.face().axis));
    return true;
  }
  const LongVector w = lessLong(place, from);
  if (part.kind == NearPart::corner) {
    span = spanOf(w[0], w[1], w[2]);
    return true;
  }
  const double size = std::abs(w.value[0]) + std::abs(w.value[1]) + std::abs(w.value[2]);
  if (!(size > 0x1p-300 && size < 0x1p300)) return false;
  if (part.kind == NearPart::edge) {
    const LongDirection& edge = triangle.edge(part.j);
    const LongVector& u = edge.unit;
    if (edge.state == LongDirection::along_axis) {
      span = spanOf(w[(edge.axis + 1u) % 3], w[(edge.axis + 2u) % 3]);
      return true;
    }
    if (edge.state != LongDirection::known) return false;
    span = spanOf(longMoment(w, u, 1, 2), longMoment(w, u, 2, 0), longMoment(w, u, 0, 1));
    const double error = (2.0 * w.error + u.error * size) * (1.0 + kDoubleMargin) + 0x1p-960;
    for (LongCoordinate& c : span) c.error += error;
    return true;
  }
  const LongDirection& face = triangle.face();
  if (face.state != LongDirection::known) return false;
  const LongVector& n = face.unit;
  WithError sum = twoProduct(n.value[0], w.value[0]);
  double low = sum.error + (n.value[0] * w.tail[0] + n.tail[0] * w.value[0]);
  for (std::size_t k = 1; k < 3; ++k) {
    const WithError p = twoProduct(n.value[k], w.value[k]), s = twoSum(sum.value, p.value);
    sum.value = s.value;
    low += (s.error + p.error) + (n.value[k] * w.tail[k] + n.tail[k] * w.value[k]);
  }
  const WithError all = twoSum(sum.value, low);
  span = spanOf({all.value, all.error,
                 (2.0 * w.error + (n.error + kLongProductError) * size) * (1.0 + kDoubleMargin) + 0x1p-960});
  return true;
}

/// The distance, rounded to the nearest double; NaN where that is in doubt.
HWY_INLINE double longDistance(LongTriangle& triangle, const NearPart& part, const LongVector& place)
{
  LongSpan span;
  if (!longSpan(triangle, part, place, span)) return std::numeric_limits<double>::quiet_NaN();
  return part.kind == NearPart::face ? roundedHeight(span[0]) : roundedLength(span, 0.0, 0.0);
}

/// Whether both triangles lie in one plane across an axis.
inline bool areLevel(LongTriangle& x, LongTriangle& y)
{
  const LongDirection &of_x = x.face(), &of_y = y.face();
  if (of_x.state != LongDirection::along_axis || of_y.state != LongDirection::along_axis || of_x.axis != of_y.axis)
    return false;
  const LongNumber &at_x = x.corners[0][of_x.axis], &at_y = y.corners[0][of_x.axis];
  return at_x.value() == at_y.value() && at_x.tail() == at_y.tail() && at_x.error() == 0.0 && at_y.error() == 0.0;
}

/// Returns true where a point's distances from two triangles at two poses are surely equal. Either both parts are faces
/// in one plane across an axis. Or both are one part, which the poses turn alike and shift only along axes that it lies
/// along.
inline bool areSameParts(LongTriangle& x, const NearPart& part_x, const Eigen::Isometry3d& pose_x, LongTriangle& y,
                         const NearPart& part_y, const Eigen::Isometry3d& pose_y)
{
  const bool of_face = part_x.kind == NearPart::face;
  if (of_face && part_y.kind == NearPart::face && areLevel(x, y)) return true;
  if (of_face ? part_y.kind != NearPart::face || x.given != y.given
              : !SharedPart(part_x, x).isSameAs(SharedPart(part_y, y)))
    return false;
  if (pose_x.linear() != pose_y.linear()) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (pose_x.translation()[row] == pose_y.translation()[row]) continue;
    if (part_x.kind == NearPart::corner) return false;
    if (of_face ? !x.face().isAcross(k)
                : x.edge(part_x.j).state != LongDirection::along_axis || x.edge(part_x.j).axis != k)
      return false;
  }
  return true;
}

/// Returns the sign of the point's distance from x less that from y; nothing where it is in doubt.
/// @param part_x, part_y nearest to the point
inline std::optional<int> longOrder(LongTriangle& x, const NearPart& part_x, LongTriangle& y, const NearPart& part_y,
                                    const LongVector& place)
{
  if (part_x.low > part_y.high) return 1;
  if (part_x.high < part_y.low) return -1;
  LongSpan span_x, span_y;
  if (!longSpan(x, part_x, place, span_x) || !longSpan(y, part_y, place, span_y)) return std::nullopt;
  const auto square = [](const LongSpan& span) {
    LongNumber sum;
    for (const LongCoordinate& c : span) {
      const LongNumber number(c.value, c.tail, c.error);
      sum += number * number;
    }
    return sum;
  };
  bool sure = true;
  const int sign = (square(span_x) - square(span_y)).sign(sure);
  return sure ? std::optional<int>(sign) : std::nullopt;
}

/// A cache of one cloud's placed triangles, at some poses.
class LongTriangles {
public:
  /// Call before a walk: empties the cache.
  void forget() { keys_.assign(kSlots, kNone); }

  /// Returns a placed triangle. It is valid until a call for another triangle, or for another pose.
  /// @param k the number of the pose, out of those asked about
  LongTriangle& of(const TrianglesView& view, const Eigen::Isometry3d& pose, std::uint32_t record, std::uint32_t k = 0)
  {
    const std::uint64_t key = std::uint64_t{k} << 32 | record;
    const std::uint32_t slot = slotOf(record, k);
    if (triangles_.empty()) triangles_.resize(kSlots);
    if (keys_[slot] != key) {
      triangles_[slot].set(view.triangle(record), pose);
      keys_[slot] = key;
    }
    return triangles_[slot];
  }

  /// Whether a triangle at a pose stays valid when another one is asked for.
  static bool areApart(std::uint32_t record, std::uint32_t k, std::uint32_t other, std::uint32_t other_k)
  {
    return slotOf(record, k) != slotOf(other, other_k);
  }

  std::size_t bytes() const noexcept
  {
    return triangles_.capacity() * sizeof(LongTriangle) + keys_.capacity() * sizeof(std::uint64_t);
  }

private:
  static constexpr std::uint32_t kSlotBits = 9, kSlots = 1u << kSlotBits;
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  static std::uint32_t slotOf(std::uint32_t record, std::uint32_t k)
  {
    return (record * 0x9e3779b1u >> (32 - kSlotBits)) ^ (k & (kSlots - 1));
  }

  std::vector<LongTriangle> triangles_;
  std::vector<std::uint64_t> keys_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
