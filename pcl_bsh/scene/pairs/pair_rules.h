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
    const Object &first = objects_[a], &second = objects_[b];
    PairRule rule{tested_ && !(first.fixed && second.fixed), clearance_};
    if (!group_pairs_.empty()) {
      const auto found = group_pairs_.find({std::min(first.group, second.group), std::max(first.group, second.group)});
      if (found != group_pairs_.end()) override(rule, found->second);
    }
    if (!pairs_.empty()) {
      const auto found = pairs_.find(pairKey(a, b));
      if (found != pairs_.end()) override(rule, found->second);
    }
    return *rule.tested ? rule.clearance : std::nullopt;
  }

  /// No pair has a larger clearance.
  double largestClearance() const { return largest_; }

private:
  struct Object {
    std::size_t group;
    bool fixed;
  };

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
