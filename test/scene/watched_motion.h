// SPDX-License-Identifier: BSD-3-Clause
// Motions replayed by brute force: an object is put where it was at many instants of its way, and compared point by
// point with everything it may not touch. Legs are interpolated here by their definition, not by the library.
#pragma once

#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/scene/scene.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh::test {

/// Where a leg has its object: the centre on a straight line, the rotation at constant speed.
inline Eigen::Isometry3d poseOn(const Leg& leg, double s)
{
  Eigen::Isometry3d pose = leg.from;
  const double angle = leg.turn.norm();
  if (angle > 0.0)
    pose.linear() = Eigen::AngleAxisd(s * angle, leg.turn / angle).toRotationMatrix() * leg.from.linear();
  const Eigen::Vector3d begin = leg.from * leg.center, end = leg.to * leg.center;
  pose.translation() = begin + s * (end - begin) - pose.linear() * leg.center;
  return pose;
}

/// All points of an object, or its triangles' balls, under one pose, and the box around them.
class StandingPoints {
public:
  StandingPoints(const SceneObject& object, const Eigen::Isometry3d& pose)
  {
    for (const ScenePart& part : object.parts) {
      const PointsView& view = part.hierarchy->view();
      parts_.push_back({pose * part.pose, &view, points_.size()});
      for (std::size_t i = 0; i < view.size(); ++i) {
        const Point3 p = view.point(view.record(i));
        points_.push_back(parts_.back().pose * Eigen::Vector3d(p[0], p[1], p[2]));
        radii_.push_back(view.radius(view.record(i)) + view.uncertainty + view.ownUncertainty(view.record(i)));
        if (!points_.back().allFinite()) continue;
        low_ = low_.cwiseMin(points_.back());
        high_ = high_.cwiseMax(points_.back());
        largest_radius_ = std::max(largest_radius_, radii_.back());
      }
    }
  }

  /// Whether a pair of points collides, or may where they are uncertain, in exact arithmetic. @param near set to the
  /// smallest gap less the clearance
  bool collides(const StandingPoints& other, double clearance, double& near) const
  {
    const double reach = clearance + largest_radius_ + other.largest_radius_ + 1e-3;
    if (!((low_.array() - reach <= other.high_.array()).all() && (other.low_.array() - reach <= high_.array()).all()))
      return false;
    const double rounding = 1e-12 * (1.0 + low_.cwiseAbs().maxCoeff() + high_.cwiseAbs().maxCoeff());
    for (const Part& a : parts_)
      for (std::size_t i = 0; i < a.view->size(); ++i) {
        const Eigen::Vector3d& p = points_[a.first + i];
        if (!((p - other.low_).array() >= -reach).all() || !((other.high_ - p).array() >= -reach).all()) continue;
        for (const Part& b : other.parts_)
          for (std::size_t j = 0; j < b.view->size(); ++j) {
            const double gap =
                (p - other.points_[b.first + j]).norm() - radii_[a.first + i] - other.radii_[b.first + j] - clearance;
            const bool of_triangles = a.view->triangles || b.view->triangles;
            if (!of_triangles) near = std::min(near, gap);
            if (!(gap <= rounding)) continue;
            const bool uncertain = a.view->isUncertain() || b.view->isUncertain();
            const PairReach of_pairs(*a.view, *b.view, clearance,
                                     uncertain ? MeantPlaces::possible : MeantPlaces::measured);
            if (of_pairs.holds(RecordDistance(*a.view, a.pose, *b.view, b.pose),
                               {a.view->record(i), b.view->record(j)}))
              return true;
          }
      }
    return false;
  }

private:
  struct Part {
    Eigen::Isometry3d pose;
    const PointsView* view;
    std::size_t first;
  };

  std::vector<Part> parts_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radii_; ///< and uncertainties
  double largest_radius_ = 0.0;
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
};

/// Watches the steps of a scene. Made before a step, asked after it.
class WatchedMotion {
public:
  /// @param clearance_of the clearance of two objects, or none if they are not tested
  template <class ClearanceOf>
  WatchedMotion(const pcl_bsh::Scene& scene, const ClearanceOf& clearance_of) : scene_(scene)
  {
    const auto count = static_cast<ObjectId>(scene.size());
    clearances_.resize(count, std::vector<std::optional<double>>(count));
    for (ObjectId a = 0; a < count; ++a) {
      before_.push_back(scene[a].pose);
      for (ObjectId b = 0; b < count; ++b)
        if (a != b) clearances_[a][b] = clearance_of(std::min(a, b), std::max(a, b));
    }
  }

  explicit WatchedMotion(const pcl_bsh::Scene& scene)
  : WatchedMotion(scene, [&scene](ObjectId a, ObjectId b) {
      return scene[a].fixed && scene[b].fixed ? std::nullopt : std::optional(scene.options().clearance);
    })
  {
  }

  /// Replays the paths that a response claims. They begin where the object stood, end where it stands, have no gap, and
  /// collide at none of so many instants in all. Each object is among the others as they stood at its turn.
  /// @return what is wrong, empty if nothing is
  std::string replayResponses(const SceneResult& result, int instants)
  {
    std::vector<Eigen::Isometry3d> now = before_;
    std::vector<bool> moved(now.size(), false);
    for (const Outcome& outcome : result.outcomes) {
      const ObjectId id = outcome.object;
      moved[id] = true;
      const std::string name = "object " + std::to_string(id);
      std::vector<std::pair<ObjectId, StandingPoints>> others;
      for (ObjectId other = 0; other < now.size(); ++other)
        if (clearances_[id][other]) others.emplace_back(other, StandingPoints(scene_[other], now[other]));
      const int each = outcome.legs.empty() ? 0 : std::max(3, instants / static_cast<int>(outcome.legs.size()));
      for (std::size_t k = 0; k < outcome.legs.size(); ++k) {
        const Leg& leg = outcome.legs[k];
        const std::string where = name + ", leg " + std::to_string(k) + " of " + std::to_string(outcome.legs.size());
        if (leg.from.matrix() != now[id].matrix()) return where + " does not begin where the object is";
        if (!poseOn(leg, 1.0).isApprox(leg.to, 1e-9)) return where + " does not lead to its end";
        for (int i = 0; i <= each; ++i) {
          const double s = static_cast<double>(i) / each;
          const Eigen::Isometry3d pose = i == each ? leg.to : poseOn(leg, s);
          if (!leg.at(s).isApprox(pose, 1e-9)) return where + " at " + std::to_string(s) + ": Leg::at() is elsewhere";
          if (outcome.stuck) continue; // it collided before
          const StandingPoints standing(scene_[id], pose);
          for (const auto& [other, points] : others) {
            ++comparisons;
            if (standing.collides(points, *clearances_[id][other], nearest))
              return where + " at " + std::to_string(s) + " collides with object " + std::to_string(other);
          }
        }
        now[id] = leg.to;
      }
      if (now[id].matrix() != after(id).matrix()) return name + " is not where its legs lead";
    }
    for (ObjectId id = 0; id < now.size(); ++id)
      if (!moved[id] && before_[id].matrix() != after(id).matrix()) return "object " + std::to_string(id) + " jumped";
    return {};
  }

  /// The first contacts that a step claims: no pair collides at any of so many instants before, and the two points
  /// named are within clearance + tolerance at it.
  std::string replayFirstContacts(const SceneResult& result, int instants)
  {
    const auto count = static_cast<ObjectId>(before_.size());
    const auto poseAt = [&](ObjectId id, double s) {
      for (const SweptMotion& way : result.swept_motions)
        if (way.object == id && !way.part) return s >= 1.0 ? way.leg.to : s <= 0.0 ? way.leg.from : poseOn(way.leg, s);
      return after(id);
    };
    for (const SweptMotion& way : result.swept_motions)
      if (!poseOn(way.leg, 1.0).isApprox(way.leg.to, 1e-9) || way.leg.to.matrix() != after(way.object).matrix())
        return "the way of object " + std::to_string(way.object) + " does not lead to where it is";
    for (int i = 0; i < instants; ++i) {
      const double s = static_cast<double>(i) / instants;
      std::vector<StandingPoints> standing;
      for (ObjectId id = 0; id < count; ++id) standing.emplace_back(scene_[id], poseAt(id, s));
      for (ObjectId a = 0; a < count; ++a)
        for (ObjectId b = a + 1; b < count; ++b) {
          if (!clearances_[a][b] || fractionOf(result, a, b) <= s) continue;
          ++comparisons;
          if (standing[a].collides(standing[b], *clearances_[a][b], nearest))
            return "objects " + std::to_string(a) + " and " + std::to_string(b) + " collide at " + std::to_string(s) +
                   ", before " + std::to_string(fractionOf(result, a, b));
        }
    }
    const auto extent = [&](ObjectId id, std::uint32_t part, std::uint32_t record) {
      const PointsView& view = scene_[id].parts[part].hierarchy->view();
      return view.ownRadius(record) + view.uncertainty + view.ownUncertainty(record);
    };
    for (const PartFirstContact& contact : result.first_contact) {
      const ScenePart &a = scene_[contact.a].parts[contact.part_a], &b = scene_[contact.b].parts[contact.part_b];
      const RecordDistance distance(a.hierarchy->view(), poseAt(contact.a, contact.fraction) * a.pose,
                                    b.hierarchy->view(), poseAt(contact.b, contact.fraction) * b.pose);
      const double gap = distance.enclose(distance.pair(contact.pair)).high -
                         extent(contact.a, contact.part_a, contact.pair.a) -
                         extent(contact.b, contact.part_b, contact.pair.b);
      if (gap > *clearances_[contact.a][contact.b] + scene_.options().tolerance)
        return "objects " + std::to_string(contact.a) + " and " + std::to_string(contact.b) + " are " +
               std::to_string(gap) + " apart at their contact";
    }
    return {};
  }

  std::size_t comparisons = 0;                              ///< of two objects at an instant
  double nearest = std::numeric_limits<double>::infinity(); ///< gap less clearance over all instants

private:
  const Eigen::Isometry3d& after(ObjectId id) const { return scene_[id].pose; }

  static double fractionOf(const SceneResult& result, ObjectId a, ObjectId b)
  {
    for (const PartFirstContact& contact : result.first_contact)
      if (contact.a == a && contact.b == b) return contact.fraction;
    return std::numeric_limits<double>::infinity();
  }

  const pcl_bsh::Scene& scene_;
  std::vector<Eigen::Isometry3d> before_;
  std::vector<std::vector<std::optional<double>>> clearances_;
};

} // namespace pcl_bsh::test
