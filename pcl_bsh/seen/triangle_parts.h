// SPDX-License-Identifier: BSD-3-Clause
// Whether all places of a record are seen: a point by one ball, a triangle by balls about its parts, as small as need
// be. Also tells where a triangle is not seen.
#pragma once

#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/seen/model_ball.h>
#include <pcl_bsh/seen/unseen_points.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// A triangle is halved down to balls of this share of the ball about each of its places, and this many times at most:
/// a part that is not seen then counts as unseen.
inline constexpr double kSmallestPart = 0.125;
inline constexpr int kMostHalvings = 14;

/// The unseen part of a triangle is told in parts with no more halvings than this, or as small as the ball about a
/// place. Parts of one piece, which is a triangle after kPieceHalvings halvings, share two boxes: one of its shadow,
/// one of its skin.
inline constexpr int kPartHalvings = 10;
inline constexpr int kPieceHalvings = 6;

/// @param sees (ball: PosedPlace, radius) whether one scanner sees all of it
template <class Sees>
class RecordSeen {
public:
  RecordSeen(const Placed& model, double clearance, const Sees& sees)
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

  /// Whether a record that is not seen is in shadow: a point, or the middle of an unseen part of a triangle.
  /// @param shadow at(PosedPlace) tells that of a place. all(PosedPlace, radius) and none(PosedPlace, radius) may tell
  ///   it of all places of a ball; where they do not know, they are false
  /// @param parts null: not wanted; else gets where a triangle is unseen, unless that is all of it, and of one kind
  /// @param frame of the boxes: T_frame_model
  template <class Shadow>
  bool isInShadow(std::uint32_t record, const Shadow& shadow, std::vector<UnseenPart>* parts,
                  const Eigen::Isometry3d& frame) const
  {
    if (!view_.triangles) return shadow.at(ModelBall(model_, record, clearance_).place);
    least_ = clearance_ + view_.uncertainty + view_.ownUncertainty(record);
    Division<Shadow> division{shadow, parts, frame, record, {}, false};
    divide(view_.triangles->triangle(record), 0, division);
    return division.has_shadow;
  }

private:
  /// Parts a triangle into shadow and skin.
  template <class Shadow>
  struct Division {
    const Shadow& shadow;
    std::vector<UnseenPart>* parts;
    const Eigen::Isometry3d& frame;
    std::uint32_t record;
    std::array<std::optional<UnseenPart>, 2> piece;
    bool has_shadow;

    void add(const Triangle3& part, int halvings, bool in_shadow)
    {
      has_shadow = has_shadow || in_shadow;
      if (!parts || halvings == 0) return;
      std::optional<UnseenPart>& box = piece[in_shadow ? 1 : 0];
      for (const Point3& corner : part) {
        const Eigen::Vector3d at = frame * Eigen::Vector3d(corner.data());
        const Point3 place = {at.x() + 0.0, at.y() + 0.0, at.z() + 0.0};
        if (!box) box = UnseenPart{record, in_shadow, place, place};
        for (std::size_t k = 0; k < 3; ++k) {
          box->low[k] = std::min(box->low[k], place[k]);
          box->high[k] = std::max(box->high[k], place[k]);
        }
      }
      if (halvings < kPieceHalvings) end();
    }

    void end()
    {
      for (std::optional<UnseenPart>& box : piece) {
        if (box) parts->push_back(*box);
        box.reset();
      }
    }
  };

  template <class Shadow>
  void divide(const Triangle3& part, int halvings, Division<Shadow>& division) const
  {
    if (!division.parts && division.has_shadow) return;
    const auto [middle, radius] = ballOf(part);
    const PosedPlace place(model_.pose, middle);
    const double places = radius * (1.0 + kPoseStretch);
    if (sees_(place, least_ + places)) return;
    if (halvings == kPartHalvings || radius <= least_) {
      if (!seesPart(part, kMostHalvings - halvings)) division.add(part, halvings, division.shadow.at(place));
      return;
    }
    if (division.shadow.all(place, places)) return division.add(part, halvings, true);
    if (!division.parts && division.shadow.none(place, places)) return;
    for (const Triangle3& half : halvesOf(part)) divide(half, halvings + 1, division);
    if (division.parts && halvings == kPieceHalvings) division.end();
  }

  struct PartBall {
    Point3 middle;
    double radius;
  };

  static PartBall ballOf(const Triangle3& part)
  {
    PartBall ball{{}, 0.0};
    for (std::size_t k = 0; k < 3; ++k) ball.middle[k] = (part[0][k] + part[1][k] + part[2][k]) / 3.0;
    for (const Point3& corner : part) ball.radius = std::max(ball.radius, distance(ball.middle, corner));
    ball.radius *= 1.0 + 0x1p-40;
    return ball;
  }

  /// Cut at the middle of its longest edge.
  static std::array<Triangle3, 2> halvesOf(const Triangle3& part)
  {
    std::size_t longest = 0; // the edge from this corner to the next
    for (std::size_t i = 1; i < 3; ++i)
      if (distance(part[i], part[(i + 1) % 3]) > distance(part[longest], part[(longest + 1) % 3])) longest = i;
    const Point3 &a = part[longest], &b = part[(longest + 1) % 3], &c = part[(longest + 2) % 3];
    Point3 half;
    for (std::size_t k = 0; k < 3; ++k) half[k] = 0.5 * a[k] + 0.5 * b[k];
    return {Triangle3{a, half, c}, Triangle3{half, b, c}};
  }

  /// A part is seen if a ball about it is, or both of its halves are; it is not where one of its places is not.
  bool seesPart(const Triangle3& part, int halvings) const
  {
    const auto [middle, radius] = ballOf(part);
    const PosedPlace place(model_.pose, middle);
    if (sees_(place, least_ + radius * (1.0 + kPoseStretch))) return true;
    if (halvings == 0 || radius <= kSmallestPart * least_ || !sees_(place, least_)) return false;
    const std::array<Triangle3, 2> halves = halvesOf(part);
    return seesPart(halves[0], halvings - 1) && seesPart(halves[1], halvings - 1);
  }

  static double distance(const Point3& p, const Point3& q)
  {
    return (Eigen::Vector3d(p.data()) - Eigen::Vector3d(q.data())).norm();
  }

  const Placed& model_;
  const PointsView& view_;
  const double clearance_;
  const Sees& sees_;
  mutable double least_ = 0.0; ///< radius of the ball about a place of the record
};

} // namespace pcl_bsh
