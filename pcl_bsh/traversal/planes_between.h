// SPDX-License-Identifier: BSD-3-Clause
// Proves records no nearer than one pair of records, by planes between the nearest places of the pair. The planes are
// exact, so they decide where bounds cannot: between triangles that are all as near.
#pragma once

#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/traversal/behind_plane.h>
#include <pcl_bsh/traversal/plane_policy.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pcl_bsh {

/// Two planes through the nearest places of a pair, across the way between them. A record of a behind the first plane
/// and a record of b behind the second are no nearer than the pair. Planes are for searches that decide one pair after
/// the other in vain.
class PlanesBetween {
public:
  /// @param before decisions in vain before planes are worth their cost
  PlanesBetween(const RecordDistance& distance, const SphereHierarchy::Storage& a, const SphereHierarchy::Storage& b,
                std::uint64_t before)
  : policy(before),
    distance_(distance),
    storage_a_(a),
    storage_b_(b)
  {
  }

  /// Forgets planes and decisions.
  void clear()
  {
    behind_a_.reset(), behind_b_.reset();
    policy.forget();
    looked_ = 0;
  }

  /// Lays planes between the nearest places of a pair. There may be no such planes.
  /// @param less a length: records count as beyond the planes when they are surely farther apart than the pair's
  ///   distance minus this length
  /// @param known_of_b as BehindPlane takes it
  void lay(PointPair pair, double less = 0.0, std::uint32_t known_of_b = BehindPlane::kNoRecord)
  {
    behind_a_.reset(), behind_b_.reset();
    const auto planes = distance_.planesBetween(pair);
    if (!planes) return;
    behind_a_.emplace(storage_a_, (*planes)[0], BehindPlane::kNoRecord);
    behind_b_.emplace(storage_b_, (*planes)[1], known_of_b);
    const int more = (*planes)[1].exponent() - (*planes)[0].exponent();
    unit_of_b_ = std::ldexp(1.0, more);
    constexpr double off = 1e-5; // poses stretch the normal by less
    less_ = less > 0x1p-400 ? (1.0 - off) * less * (*planes)[0].length() : 0.0;
  }

  /// The records of two children that touch the planes; no record where the children are surely farther apart than the
  /// planes.
  struct Touching {
    BehindPlane::Touching a, b;
  };

  /// If the planes prove all below two children no nearer than the pair, returns the records that touch a plane; these
  /// may be as near as the pair. Returns nothing otherwise, and where too few decisions have paid for looking.
  std::optional<Touching> touching(const NodeChild& a, const NodeChild& b)
  {
    const std::uint64_t allowed = kLooksForDecision * policy.decisionsInVain();
    if (!behind_a_ || looked_ >= allowed) return std::nullopt;
    std::uint64_t looks = allowed - looked_;
    const std::optional<Touching> found = touching(a, b, looks);
    looked_ = allowed - looks;
    return found;
  }

  /// Looks at no more than `looks` records, and subtracts those it looks at. A record beyond its plane may be paired
  /// with one that is at least as far behind the other plane, because heights are added.
  /// @pre areLaid()
  std::optional<Touching> touching(const NodeChild& a, const NodeChild& b, std::uint64_t& looks)
  {
    const auto height_a = behind_a_->heightAtMost(a, looks);
    const auto height_b = height_a ? behind_b_->heightAtMost(b, looks) : std::nullopt;
    if (height_a && height_b && isBeyond(*height_a, *height_b)) return Touching();
    if (less_ != 0.0 || !height_b) return std::nullopt;
    if (isBeyond(behind_a_->height(a), behind_b_->height(b))) return Touching();
    const auto of_a = behind_a_->touching(a);
    const auto of_b = of_a ? behind_b_->touching(b) : std::nullopt;
    return of_b ? std::optional(Touching{*of_a, *of_b}) : std::nullopt;
  }

  /// Whether there are planes.
  bool areLaid() const { return behind_a_.has_value(); }

  /// Whether the planes prove two records to be no nearer than the pair.
  bool areBehind(PointPair pair) const
  {
    return areBeyond(pair) || (areLaid() && behind_a_->sideOf(pair.a) <= 0 && behind_b_->sideOf(pair.b) <= 0);
  }

  /// Whether two records are surely farther apart than the planes.
  bool areBeyond(PointPair pair) const
  {
    return behind_a_ && (isBeyond(behind_a_->heightAtMost(pair.a), behind_b_->heightAtMost(pair.b)) ||
                         (less_ == 0.0 && isBeyond(behind_a_->height(pair.a), behind_b_->height(pair.b))));
  }

  PlanePolicy policy;

private:
  bool isBeyond(double height_a, double height_b) const
  {
    const double scaled = unit_of_b_ * height_b;
    return height_a + scaled + kFewDoubleRoundings * (std::abs(height_a) + std::abs(scaled)) < less_;
  }

  bool isBeyond(const std::optional<LongNumber>& height_a, const std::optional<LongNumber>& height_b) const
  {
    bool sure = true;
    return height_a && height_b && (*height_a + LongNumber(unit_of_b_) * *height_b).sign(sure) < 0;
  }

  /// Records that may be looked at for each decision. A look costs a hundredth of a decision.
  static constexpr std::uint64_t kLooksForDecision = 16;

  const RecordDistance& distance_;
  const SphereHierarchy::Storage& storage_a_;
  const SphereHierarchy::Storage& storage_b_;
  std::optional<BehindPlane> behind_a_, behind_b_;
  double unit_of_b_ = 1.0; ///< of heights over b's plane, in the unit of a's
  double less_ = 0.0;      ///< in the unit of a's plane
  std::uint64_t looked_ = 0;
};

} // namespace pcl_bsh
