// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/record_distance.h>

#include <pcl_bsh/hierarchy/triangles_view.h>

namespace pcl_bsh {

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

int RecordDistance::compareTriangles(PointPair records, double clearance) const
{
  return withTriangles(records, [&](const auto& pair) { return triangles_->compare(pair, {clearance}); });
}

int RecordDistance::compareTriangles(PointPair records, const Sum& reach) const
{
  return withTriangles(records, [&](auto pair) {
    pair.radius = 0.0; // `reach` has it
    return triangles_->compare(pair, reach);
  });
}

RecordDistance::Enclosure RecordDistance::encloseTriangles(PointPair records) const
{
  return withTriangles(records, [&](const auto& pair) { return triangles_->enclose(pair.a, pair.b); });
}

int RecordDistance::compareTriangleGaps(const Pair& first, const RecordDistance& other, const Pair& second) const
{
  return withTriangles(first.records, [&](const auto& x) {
    return other.withTriangles(second.records, [&](const auto& y) -> int {
      if constexpr (std::is_same_v<decltype(x), decltype(y)>)
        return triangles_->compareGaps(x, *other.triangles_, y);
      else
        return 0; // not of the same clouds
    });
  });
}

double RecordDistance::gapOfTriangles(PointPair records) const
{
  return withTriangles(records, [&](const auto& pair) { return triangles_->gap(pair); });
}

} // namespace pcl_bsh
