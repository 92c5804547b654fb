// SPDX-License-Identifier: BSD-3-Clause
// Which pairs of objects are tested, and at which clearance.
#pragma once

#include <pcl_bsh/scene/scene.h>

#include <algorithm>
#include <map>
#include <unordered_map>

namespace pcl_bsh {

/// A pair of objects as one number; the smaller id leads.
inline std::uint64_t pairKey(ObjectId a, ObjectId b)
{
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

class PairRules {
public:
  PairRules(double clearance, bool test_pairs) : clearance_(clearance), tested_(test_pairs), largest_(clearance) {}

  void addObject(const std::string& group, bool fixed)
  {
    objects_.push_back({groups_.emplace(group, groups_.size()).first->second, fixed});
  }

  void set(ObjectId a, ObjectId b, const PairRule& rule) { merge(pairs_[pairKey(a, b)], rule); }

  void setGroups(const std::string& a, const std::string& b, const PairRule& rule)
  {
    const std::size_t i = groups_.emplace(a, groups_.size()).first->second;
    const std::size_t j = groups_.emplace(b, groups_.size()).first->second;
    merge(group_pairs_[{std::min(i, j), std::max(i, j)}], rule);
  }

  /// None: the pair is not tested.
  std::optional<double> clearanceOf(ObjectId a, ObjectId b) const
  {
    PairRule rule = ofKinds(a, b);
    if (!pairs_.empty()) {
      const auto found = pairs_.find(pairKey(a, b));
      if (found != pairs_.end()) override(rule, found->second);
    }
    return *rule.tested ? rule.clearance : std::nullopt;
  }

  /// Whether any two objects are tested: by what holds for all of their kind, and by rules about the two.
  bool testsAny() const
  {
    for (const auto& [key, rule] : pairs_)
      if (clearanceOf(static_cast<ObjectId>(key >> 32), static_cast<ObjectId>(key & 0xffffffffu))) return true;
    using Kind = std::pair<std::size_t, bool>; // group, where groups have rules; fixed
    struct Members {
      ObjectId first = 0;
      std::uint64_t count = 0;
    };
    const auto kindOf = [&](ObjectId id) {
      return Kind(group_pairs_.empty() ? 0 : objects_[id].group, objects_[id].fixed);
    };
    const auto ordered = [](const Kind& a, const Kind& b) { return std::pair(std::min(a, b), std::max(a, b)); };
    std::map<Kind, Members> kinds;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      Members& members = kinds[kindOf(static_cast<ObjectId>(i))];
      if (members.count++ == 0) members.first = static_cast<ObjectId>(i);
    }
    std::map<std::pair<Kind, Kind>, std::uint64_t> ruled_out; // by a rule about the two
    for (const auto& [key, rule] : pairs_) {
      const auto a = static_cast<ObjectId>(key >> 32), b = static_cast<ObjectId>(key & 0xffffffffu);
      if (a != b) ++ruled_out[ordered(kindOf(a), kindOf(b))];
    }
    for (auto a = kinds.begin(); a != kinds.end(); ++a)
      for (auto b = a; b != kinds.end(); ++b) {
        const std::uint64_t pairs =
            a == b ? a->second.count * (a->second.count - 1) / 2 : a->second.count * b->second.count;
        const auto out = ruled_out.find(ordered(a->first, b->first));
        if (pairs > (out == ruled_out.end() ? 0 : out->second) && *ofKinds(a->second.first, b->second.first).tested)
          return true;
      }
    return false;
  }

  /// No pair has a larger clearance.
  double largestClearance() const { return largest_; }

private:
  struct Object {
    std::size_t group;
    bool fixed;
  };

  /// The rule of two objects, without the rules about the two.
  PairRule ofKinds(ObjectId a, ObjectId b) const
  {
    const Object &first = objects_[a], &second = objects_[b];
    PairRule rule{tested_ && !(first.fixed && second.fixed), clearance_};
    if (!group_pairs_.empty()) {
      const auto found = group_pairs_.find({std::min(first.group, second.group), std::max(first.group, second.group)});
      if (found != group_pairs_.end()) override(rule, found->second);
    }
    return rule;
  }

  static void override(PairRule& rule, const PairRule& by)
  {
    if (by.tested) rule.tested = by.tested;
    if (by.clearance) rule.clearance = by.clearance;
  }

  void merge(PairRule& rule, const PairRule& by)
  {
    override(rule, by);
    if (by.clearance) largest_ = std::max(largest_, *by.clearance);
  }

  double clearance_;
  bool tested_;
  double largest_;
  std::vector<Object> objects_;
  std::map<std::string, std::size_t> groups_;
  std::map<std::pair<std::size_t, std::size_t>, PairRule> group_pairs_;
  std::unordered_map<std::uint64_t, PairRule> pairs_;
};

} // namespace pcl_bsh
