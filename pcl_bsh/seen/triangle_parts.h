// SPDX-License-Identifier: BSD-3-Clause
// Whether all places of a record are seen: of a point in one ball, of a triangle in balls about parts of it, as small
// as need be.
#pragma once

#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/seen/model_ball.h>

#include <algorithm>

namespace pcl_bsh {

/// A triangle's balls go down to this share of the ball about each of its places, and to this many halvings: what is
/// not seen then counts as unseen.
inline constexpr double kSmallestPart = 0.125;
inline constexpr int kMostHalvings = 14;

/// @param sees (ball: PosedPlace, radius) whether one scanner sees all of it
template <class Sees>
class RecordSight {
public:
  RecordSight(const Placed& model, double clearance, const Sees& sees)
  : model_(model),
    view_(model.hierarchy().view()),
    clearance_(clearance),
    sees_(sees)
  {
  }

  bool operator()(std::uint32_t record) const
  {
    const ModelBall ball(model_, record, clearance_);
    if (sees_(ball.place, ball.radius)) return true;
    if (!view_.triangles) return false;
    least_ = clearance_ + view_.uncertainty + view_.ownUncertainty(record);
    return seesPart(view_.triangles->triangle(record), kMostHalvings);
  }

private:
  /// A part is seen if a ball about it is, or both of its halves are; it is not where one of its places is not.
  bool seesPart(const Triangle3& part, int halvings) const
  {
    Point3 middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = (part[0][k] + part[1][k] + part[2][k]) / 3.0;
    double radius = 0.0;
    for (const Point3& corner : part) radius = std::max(radius, distance(middle, corner));
    radius *= 1.0 + 0x1p-40;
    const PosedPlace place(model_.pose, middle);
    if (sees_(place, least_ + radius * (1.0 + kPoseStretch))) return true;
    if (halvings == 0 || radius <= kSmallestPart * least_ || !sees_(place, least_)) return false;
    std::size_t longest = 0; // the edge from this corner to the next
    for (std::size_t i = 1; i < 3; ++i)
      if (distance(part[i], part[(i + 1) % 3]) > distance(part[longest], part[(longest + 1) % 3])) longest = i;
    const Point3 &a = part[longest], &b = part[(longest + 1) % 3], &c = part[(longest + 2) % 3];
    Point3 half;
    for (std::size_t k = 0; k < 3; ++k) half[k] = 0.5 * a[k] + 0.5 * b[k];
    return seesPart({a, half, c}, halvings - 1) && seesPart({half, b, c}, halvings - 1);
  }

  static double distance(const Point3& p, const Point3& q)
  {
    return (Eigen::Vector3d(p.data()) - Eigen::Vector3d(q.data())).norm();
  }

  const Placed& model_;
  const PointsView& view_;
  const double clearance_;
  const Sees& sees_;
  mutable double least_ = 0.0; ///< of a ball about a place of the record
};

} // namespace pcl_bsh
