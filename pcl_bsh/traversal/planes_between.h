// SPDX-License-Identifier: BSD-3-Clause
// What is no nearer than one pair of records, as planes between its nearest places tell: exactly where bounds cannot,
// of triangles that are all as near.
#pragma once

#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/traversal/behind_plane.h>

#include <array>
#include <cstdint>
#include <optional>

namespace pcl_bsh {

/// Two planes through the nearest places of a pair, across the way between them. What is behind both, each on its outer
/// side, is no nearer than the pair. Planes are for searches that decide one pair after the other in vain.
class PlanesBetween {
public:
  PlanesBetween(const RecordDistance& distance, const SphereHierarchy::Storage& a, const SphereHierarchy::Storage& b)
  : distance_(distance),
    storage_a_(a),
    storage_b_(b)
  {
  }

  /// Counts decisions of pairs that brought nothing: they pay for what planes cost.
  void decidedInVain() { ++decisions_; }
  std::uint64_t decisionsInVain() const { return decisions_; }

  /// Whether there were enough of them.
  bool areWorthTheirCost() const { return decisions_ >= kDecisionsBeforePlanes; }

  /// Forgets planes and decisions.
  void clear()
  {
    behind_a_.reset(), behind_b_.reset();
    decisions_ = looked_ = 0;
  }

  /// Between the nearest places of another pair. There may be none. @param allowed what surely reaches beyond its plane
  /// by less counts as behind, and as no nearer @param known_of_b as BehindPlane has it
  void lay(PointPair pair, double allowed = 0.0, std::uint32_t known_of_b = BehindPlane::kNoRecord)
  {
    behind_a_.reset(), behind_b_.reset();
    if (const auto planes = distance_.planesBetween(pair)) {
      behind_a_.emplace(storage_a_, (*planes)[0], allowed, BehindPlane::kNoRecord);
      behind_b_.emplace(storage_b_, (*planes)[1], allowed, known_of_b);
    }
  }

  /// What of two children touches the planes.
  struct Touching {
    BehindPlane::Touching a, b;
  };

  /// If nothing below two children is surely nearer than the pair: what touches a plane, so that it may be as near.
  /// Nothing, too, where not enough decisions have paid for looking.
  std::optional<Touching> touching(const NodeChild& a, const NodeChild& b)
  {
    const std::uint64_t allowed = kLooksForDecision * decisions_;
    if (!behind_a_ || looked_ >= allowed) return std::nullopt;
    std::uint64_t looks = allowed - looked_;
    const auto of_a = behind_a_->touching(a, looks);
    const auto of_b = of_a ? behind_b_->touching(b, looks) : std::nullopt;
    looked_ = allowed - looks;
    if (!of_b) return std::nullopt;
    return Touching{*of_a, *of_b};
  }

private:
  /// Before planes are tried, and how many records each of them allows to be looked at then: a look costs a hundredth
  /// of a decision.
  static constexpr std::uint64_t kDecisionsBeforePlanes = 256;
  static constexpr std::uint64_t kLooksForDecision = 16;

  const RecordDistance& distance_;
  const SphereHierarchy::Storage& storage_a_;
  const SphereHierarchy::Storage& storage_b_;
  std::optional<BehindPlane> behind_a_, behind_b_;
  std::uint64_t decisions_ = 0, looked_ = 0;
};

} // namespace pcl_bsh
