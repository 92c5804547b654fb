// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/record_distance.h>

#include <pcl_bsh/geometry/exact/exact_plane.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <type_traits>
#include <utility>

namespace pcl_bsh {
namespace {

const TriangleDistance::PointPair& keeping(const TriangleDistance::PointPair& pair, TriangleDistance::Known&)
{
  return pair;
}
TriangleDistance::TrianglePair keeping(TriangleDistance::TrianglePair pair, TriangleDistance::Known& known)
{
  pair.known = &known;
  return pair;
}

} // namespace

/// Calls visit() with the records as TriangleDistance takes them: two triangles, or a point and a triangle.
template <class Visit>
auto RecordDistance::withTriangles(PointPair records, const Visit& visit) const
{
  if (!a_->triangles)
    return visit(
        TriangleDistance::PointPair{a_->point(records.a), b_->triangles->triangle(records.b), a_->radius(records.a)});
  if (!b_->triangles)
    return visit(
        TriangleDistance::PointPair{b_->point(records.b), a_->triangles->triangle(records.a), b_->radius(records.b)});
  return visit(TriangleDistance::TrianglePair{a_->triangles->triangle(records.a), b_->triangles->triangle(records.b)});
}

/// The distance that withTriangles() measures.
const TriangleDistance& RecordDistance::distanceOfPair() const
{
  return to_b_ ? *to_b_ : *to_a_;
}

int RecordDistance::compareTriangles(PointPair records, double clearance) const
{
  return withTriangles(records, [&](const auto& pair) { return distanceOfPair().compare(pair, {clearance}); });
}

int RecordDistance::compareTriangles(PointPair records, const Sum& reach) const
{
  return withTriangles(records, [&](auto pair) {
    pair.radius = 0.0; // `reach` has it
    return distanceOfPair().compare(pair, reach);
  });
}

RecordDistance::Enclosure RecordDistance::encloseTriangles(PointPair records, double reach) const
{
  return withTriangles(records, [&](const auto& pair) {
    if constexpr (std::is_same_v<decltype(pair), const TriangleDistance::TrianglePair&>)
      return distanceOfPair().enclose(pair.a, pair.b, reach);
    else
      return distanceOfPair().enclose(pair.a, pair.b);
  });
}

int RecordDistance::compareTriangleGaps(const Pair& first, const RecordDistance& other, const Pair& second) const
{
  return withTriangles(first.records, [&](const auto& x) {
    return other.withTriangles(second.records, [&](const auto& y) -> int {
      if constexpr (std::is_same_v<decltype(x), decltype(y)>)
        return distanceOfPair().compareGaps(keeping(x, first.known), other.distanceOfPair(), keeping(y, second.known));
      else
        return 0; // not of the same clouds
    });
  });
}

double RecordDistance::gapOfTriangles(PointPair records) const
{
  return withTriangles(records, [&](const auto& pair) { return distanceOfPair().gap(pair); });
}

Eigen::Vector3d RecordDistance::between(PointPair records) const
{
  if (!ofTriangles()) {
    const Point3 z = points_.approximate(a_->point(records.a), b_->point(records.b)).vector;
    return {z[0], z[1], z[2]};
  }
  const Point3 z = withTriangles(records, [&](const auto& pair) { return distanceOfPair().between(pair); });
  return (b_->triangles ? 1.0 : -1.0) * Eigen::Vector3d(z[0], z[1], z[2]);
}

std::optional<std::array<ExactPlane, 2>> RecordDistance::planesBetween(PointPair records) const
{
  if (!ofTriangles() || a_->areBalls() || b_->areBalls()) return std::nullopt;
  auto planes = withTriangles(records, [&](const auto& pair) { return distanceOfPair().planesBetween(pair); });
  if (planes && !b_->triangles) std::swap((*planes)[0], (*planes)[1]); // the point came first
  return planes;
}

} // namespace pcl_bsh
