// SPDX-License-Identifier: BSD-3-Clause
// A scene's answer about the motion since its last query, against the motion itself. This class keeps where everything
// stood, and replays the motion by brute force over points and instants.
#pragma once

#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/scene/scene.h>

#include "watched_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace pcl_bsh::test {

/// The points of a part at one instant.
struct StandingPart {
  StandingPart(const PointsView& points, const Eigen::Isometry3d& pose) : view(&points), world(pose)
  {
    for (std::size_t i = 0; i < view->size(); ++i) {
      const Point3 p = view->point(view->record(i));
      places.push_back(world * Eigen::Vector3d(p[0], p[1], p[2]));
    }
  }

  const PointsView* view;
  Eigen::Isometry3d world;
  std::vector<Eigen::Vector3d> places;
};

/// Follows a scene. Tell it of everything that is done, and of each result.
class SweptTwin {
public:
  explicit SweptTwin(pcl_bsh::Scene& scene) : scene_(scene) {}

  void setRule(ObjectId a, ObjectId b, const PairRule& rule)
  {
    scene_.setRule(a, b, rule);
    rules_.emplace_back(a, b, rule);
  }

  void setGroupRule(const PairRule& rule) ///< of the group "some" with itself
  {
    scene_.setGroupRule("some", "some", rule);
    group_rules_.push_back(rule);
  }

  void pointsChanged(const SphereHierarchy* hierarchy) ///< also where another scene has done so
  {
    for (ObjectId id = 0; id < past_.size(); ++id)
      for (const ScenePart& part : scene_[id].parts)
        if (part.hierarchy.get() == hierarchy) past_[id].reshaped = past_[id].seen;
  }

  void pointsChanged(ObjectId id)
  {
    scene_.pointsChanged(id);
    if (id < past_.size()) past_[id].reshaped = past_[id].seen;
  }

  /// Queries, or steps, and compares. @return what is wrong, empty if nothing is
  std::string query() { return check(scene_, std::nullopt); }
  std::string step(double dt) { return check(scene_, dt); }

  std::size_t contacts = 0, certain_contacts = 0, own_legs = 0, added = 0, reshaped = 0, detoured = 0;

private:
  struct Past {
    bool seen = false;
    Eigen::Isometry3d pose; ///< at the last query, or where it was put
    std::vector<Eigen::Isometry3d> parts;
    bool reshaped = false;
  };
  using PartKey = std::pair<ObjectId, std::uint32_t>;

  std::optional<double> clearanceOf(ObjectId a, ObjectId b) const
  {
    bool tested = scene_.options().test_pairs && !(scene_[a].fixed && scene_[b].fixed);
    double clearance = scene_.options().clearance;
    const auto apply = [&](const PairRule& rule) {
      tested = rule.tested.value_or(tested);
      clearance = rule.clearance.value_or(clearance);
    };
    if (scene_[a].group == "some" && scene_[b].group == "some")
      for (const PairRule& rule : group_rules_) apply(rule);
    for (const auto& [c, d, rule] : rules_)
      if (std::minmax(a, b) == std::minmax(c, d)) apply(rule);
    return tested ? std::optional(clearance) : std::nullopt;
  }

  void remember(ObjectId id)
  {
    past_[id].pose = scene_[id].pose;
    past_[id].parts.clear();
    for (const ScenePart& part : scene_[id].parts) past_[id].parts.push_back(part.pose);
  }

  bool isPartMoved(ObjectId id, std::uint32_t part) const
  {
    return past_[id].parts[part].matrix() != scene_[id].parts[part].pose.matrix();
  }

  bool isMoved(ObjectId id) const
  {
    bool moved = past_[id].pose.matrix() != scene_[id].pose.matrix();
    for (std::uint32_t i = 0; i < scene_[id].parts.size(); ++i) moved = moved || isPartMoved(id, i);
    return moved;
  }

  std::string check(pcl_bsh::Scene& scene, std::optional<double> dt)
  {
    past_.resize(scene.size());
    std::vector<bool> jumped;
    std::vector<Eigen::Isometry3d> before;
    for (ObjectId id = 0; id < scene.size(); ++id) {
      if (!past_[id].seen) remember(id);
      jumped.push_back(isMoved(id));
      before.push_back(scene[id].pose);
    }
    const double time = scene.time();
    const SceneResult result = dt ? scene.step(*dt) : scene.query();
    std::string wrong = wrongMarks(result, dt.has_value(), jumped, before);
    if (wrong.empty()) wrong = wrongMotions(result, dt.value_or(0.0), jumped);
    if (wrong.empty()) wrong = wrongAnswers(result);
    for (ObjectId id = 0; id < scene.size(); ++id) {
      remember(id);
      past_[id].seen = true;
      past_[id].reshaped = false;
    }
    queried_ = true;
    if (!wrong.empty()) wrong += " (from " + std::to_string(time) + " s)";
    return wrong;
  }

  std::string wrongMarks(const SceneResult& result, bool of_step, const std::vector<bool>& jumped,
                         const std::vector<Eigen::Isometry3d>& before)
  {
    std::vector<UnsweptObject> marks(past_.size());
    for (const UnsweptObject& mark : result.unswept) marks[mark.object] = mark;
    for (ObjectId id = 0; id < past_.size(); ++id) {
      const bool is_added = !past_[id].seen && queried_ && !of_step;
      bool is_detoured = of_step && jumped[id] && before[id].matrix() != scene_[id].pose.matrix();
      for (const Outcome& outcome : result.outcomes)
        if (outcome.object == id) is_detoured = outcome.legs.size() > (jumped[id] ? 0 : 1);
      if (marks[id].added != is_added || marks[id].reshaped != past_[id].reshaped || marks[id].detoured != is_detoured)
        return "object " + std::to_string(id) + " is marked wrongly";
      added += is_added;
      reshaped += past_[id].reshaped;
      detoured += is_detoured;
    }
    return {};
  }

  /// Sets the legs that are replayed, after they have been held against where everything stood.
  std::string wrongMotions(const SceneResult& result, double dt, const std::vector<bool>& jumped)
  {
    legs_.clear();
    part_legs_.clear();
    for (const SweptMotion& motion : result.swept_motions) {
      if (motion.part)
        part_legs_[{motion.object, *motion.part}] = motion.leg;
      else
        legs_[motion.object] = motion.leg;
    }
    for (ObjectId id = 0; id < past_.size(); ++id) {
      const std::string name = "object " + std::to_string(id);
      const auto whole = legs_.find(id);
      if (whole == legs_.end()) {
        if (isMoved(id)) return name + " has moved, and has no leg";
      }
      else {
        const Leg& leg = whole->second;
        if (leg.from.matrix() != past_[id].pose.matrix()) return name + " does not begin where it stood";
        if (leg.to.matrix() != scene_[id].pose.matrix()) return name + " does not end where it stands";
        if (!poseOn(leg, 1.0).isApprox(leg.to, 1e-9)) return name + " does not turn to where it stands";
        const auto* velocity = std::get_if<VelocityMotion>(&scene_[id].motion);
        if (velocity && dt > 0.0 && !jumped[id] && result.outcomes.empty() &&
            !leg.turn.isApprox(dt * velocity->angular, 1e-6))
          return name + " does not turn as its motion does";
      }
      for (std::uint32_t i = 0; i < scene_[id].parts.size(); ++i) {
        const auto own = part_legs_.find({id, i});
        if ((own != part_legs_.end()) != isPartMoved(id, i)) return name + ": a part's own leg";
        if (own == part_legs_.end()) continue;
        ++own_legs;
        const Leg& leg = own->second;
        if (!leg.from.isApprox(past_[id].pose * past_[id].parts[i], 1e-12) ||
            !leg.to.isApprox(scene_.worldPose(id, i), 1e-12) || !poseOn(leg, 1.0).isApprox(leg.to, 1e-9))
          return name + ": a part's own leg leads elsewhere";
      }
    }
    return {};
  }

  Eigen::Isometry3d worldAt(ObjectId id, std::uint32_t part, double s) const
  {
    const auto own = part_legs_.find({id, part});
    if (s >= 1.0) return scene_.worldPose(id, part);
    if (own != part_legs_.end()) return poseOn(own->second, s);
    const auto whole = legs_.find(id);
    if (whole == legs_.end()) return scene_.worldPose(id, part);
    return poseOn(whole->second, s) * scene_[id].parts[part].pose;
  }

  std::map<PartKey, StandingPart> standingAt(double s) const
  {
    std::map<PartKey, StandingPart> standing;
    for (ObjectId id = 0; id < past_.size(); ++id)
      for (std::uint32_t i = 0; i < scene_[id].parts.size(); ++i)
        standing.emplace(PartKey{id, i}, StandingPart(scene_[id].parts[i].hierarchy->view(), worldAt(id, i, s)));
    return standing;
  }

  static const PartFirstContact* contactOf(const std::vector<PartFirstContact>& list, ObjectId a, ObjectId b)
  {
    for (const PartFirstContact& contact : list)
      if (contact.a == a && contact.b == b) return &contact;
    return nullptr;
  }

  std::string wrongAnswers(const SceneResult& result)
  {
    flags_.clear();
    for (const FlaggedPart& part : result.swept) flags_[{part.object, part.part}] = part.flags;
    near_.clear();
    std::map<PartKey, StandingPart> before;
    for (int i = 0; i <= kInstants; ++i) {
      const double s = static_cast<double>(i) / kInstants;
      std::map<PartKey, StandingPart> now = standingAt(s);
      for (const auto& [a, standing_a] : now)
        for (const auto& [b, standing_b] : now) {
          if (a.first >= b.first) continue;
          const std::optional<double> clearance = clearanceOf(a.first, b.first);
          if (!clearance) continue;
          double step = 0.0; // of two points towards each other, since the instant before
          if (!before.empty()) step = stepOf(before.at(a), standing_a) + stepOf(before.at(b), standing_b);
          const std::string wrong = wrongAt(result, s, *clearance, step, a, standing_a, b, standing_b);
          if (!wrong.empty()) return wrong + " at " + std::to_string(s);
        }
      before = std::move(now);
    }
    for (const auto& [key, flags] : flags_)
      for (std::size_t r = 0; r < flags.size(); ++r)
        if (flags[r] != Verdict::free && !near_[key].count(static_cast<std::uint32_t>(r)))
          return "point " + std::to_string(r) + " of object " + std::to_string(key.first) + " is swept, but never near";
    for (const bool certain : {false, true})
      for (const PartFirstContact& contact : certain ? result.certain_contact : result.first_contact) {
        const std::string wrong = wrongContact(result, contact, certain);
        if (!wrong.empty()) return wrong;
      }
    contacts += result.first_contact.size();
    certain_contacts += result.certain_contact.size();
    return {};
  }

  static double stepOf(const StandingPart& before, const StandingPart& now)
  {
    double most = 0.0;
    for (std::size_t i = 0; i < now.places.size(); ++i)
      most = std::max(most, (now.places[i] - before.places[i]).norm());
    return most;
  }

  /// All pairs of points of two parts at an instant.
  std::string wrongAt(const SceneResult& result, double s, double clearance, double step, const PartKey& a,
                      const StandingPart& at_a, const PartKey& b, const StandingPart& at_b)
  {
    const PointsView &view_a = *at_a.view, &view_b = *at_b.view;
    const bool uncertain = view_a.isUncertain() || view_b.isUncertain();
    const PairReach possible(view_a, view_b, clearance, uncertain ? MeantPlaces::possible : MeantPlaces::measured),
        surely(view_a, view_b, clearance, uncertain ? MeantPlaces::certain : MeantPlaces::measured);
    const RecordDistance exact(view_a, at_a.world, view_b, at_b.world);
    const auto told = [&](const std::vector<PartFirstContact>& list) {
      const PartFirstContact* contact = contactOf(list, a.first, b.first);
      return contact && contact->fraction <= s;
    };
    const auto flagOfPoint = [&](const PartKey& key, std::uint32_t record) {
      const auto found = flags_.find(key);
      return found == flags_.end() ? Verdict::free : found->second[record];
    };
    const std::string names = "objects " + std::to_string(a.first) + " and " + std::to_string(b.first);
    for (std::size_t i = 0; i < at_a.places.size(); ++i)
      for (std::size_t j = 0; j < at_b.places.size(); ++j) {
        const PointPair pair{view_a.record(i), view_b.record(j)};
        const double distance = (at_a.places[i] - at_b.places[j]).norm(), reach = possible.around(pair).second;
        if (distance <= reach + step + 1.01 * scene_.options().tolerance) {
          near_[a][pair.a] = true;
          near_[b][pair.b] = true;
        }
        if (distance > reach + 1e-9 || !possible.holds(exact, pair)) continue;
        if (!told(result.first_contact)) return names + " meet before they are said to";
        if (flagOfPoint(a, pair.a) == Verdict::free || flagOfPoint(b, pair.b) == Verdict::free)
          return names + " meet: a point is not flagged";
        if (!surely.holds(exact, pair)) continue;
        if (!told(result.certain_contact)) return names + " surely meet before they are said to";
        if (flagOfPoint(a, pair.a) != Verdict::colliding || flagOfPoint(b, pair.b) != Verdict::colliding)
          return names + " surely meet: an open flag";
      }
    return {};
  }

  /// The fault of a contact: it must be of tested objects, named once, at points that are within the tolerance then.
  std::string wrongContact(const SceneResult& result, const PartFirstContact& contact, bool certain) const
  {
    const std::string names = "the contact of " + std::to_string(contact.a) + " and " + std::to_string(contact.b);
    const std::optional<double> clearance = clearanceOf(contact.a, contact.b);
    if (!clearance) return names + " is not asked for";
    if (contactOf(certain ? result.certain_contact : result.first_contact, contact.a, contact.b) != &contact)
      return names + " is named twice";
    const PartFirstContact* first = contactOf(result.first_contact, contact.a, contact.b);
    if (!first || first->fraction > contact.fraction) return names + " is certain before it is possible";
    const PointsView &view_a = scene_[contact.a].parts[contact.part_a].hierarchy->view(),
                     &view_b = scene_[contact.b].parts[contact.part_b].hierarchy->view();
    const bool uncertain = view_a.isUncertain() || view_b.isUncertain();
    const PairReach reach(view_a, view_b, *clearance,
                          !uncertain ? MeantPlaces::measured
                          : certain  ? MeantPlaces::certain
                                     : MeantPlaces::possible);
    const auto place = [&](ObjectId id, std::uint32_t part, const PointsView& view, std::uint32_t record) {
      const Point3 p = view.point(record);
      return Eigen::Vector3d(worldAt(id, part, contact.fraction) * Eigen::Vector3d(p[0], p[1], p[2]));
    };
    const double distance = (place(contact.a, contact.part_a, view_a, contact.pair.a) -
                             place(contact.b, contact.part_b, view_b, contact.pair.b))
                                .norm();
    if (distance > reach.around(contact.pair).second + 1.01 * scene_.options().tolerance)
      return names + " is farther than the tolerance";
    return {};
  }

  static constexpr int kInstants = 40;

  pcl_bsh::Scene& scene_;
  bool queried_ = false;
  std::vector<Past> past_;
  std::vector<std::tuple<ObjectId, ObjectId, PairRule>> rules_;
  std::vector<PairRule> group_rules_;
  std::map<ObjectId, Leg> legs_;
  std::map<PartKey, Leg> part_legs_;
  std::map<PartKey, std::vector<Verdict>> flags_;
  std::map<PartKey, std::map<std::uint32_t, bool>> near_;
};

} // namespace pcl_bsh::test
