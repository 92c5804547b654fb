// SPDX-License-Identifier: BSD-3-Clause
// Every public query, with all of its options, against brute force.
#pragma once

#include "changing_cloud.h"
#include "support/question.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/pairs/contacts.h>

#include <string>
#include <vector>

namespace pcl_bsh::fuzz {

/// Throws a Finding when an answer is not what brute force says. Results are kept and used again from question to
/// question, whatever clouds they were of.
class Questions {
public:
  /// Asks one question of each kind that `kinds` has its bit set for.
  void ask(const Placed& a, const Placed& b, double unit, unsigned kinds, test::Random& random);

  static constexpr unsigned kKinds = 9;

  /// 0; the distance of two points, or one of the neighbouring numbers; some units; more than all.
  static double anyClearance(const Placed& a, const Placed& b, double unit, test::Random& random);

  void askAny(const Placed& a, const Placed& b, const test::Question& request);
  void askFlags(const Placed& a, const Placed& b, const test::Question& request);
  void askClosest(const Placed& a, const Placed& b, const test::Question& request);

private:
  void askContacts(const Placed& a, const Placed& b, const test::Question& request, test::Random& random);
  void askNeighbors(const SphereHierarchy& cloud, const PointsView& queries, double unit, test::Random& random);
  void askBoxes(const SphereHierarchy& cloud, double unit, test::Random& random);
  void askClusters(const SphereHierarchy& cloud, double unit, test::Random& random);
  void askAlong(const Placed& a, const Placed& b, double unit, test::Random& random);
  void askSpacing(const SphereHierarchy& cloud);

  FlagsResult flags_;
  Neighbors neighbors_;
  NeighborLists lists_;
  std::vector<std::int32_t> indices_;
};

/// All colliding pairs of points, by (a, b).
std::vector<PointPair> collidingPairs(const Placed& a, const Placed& b, double clearance);

/// Throws a Finding unless these are the `most` nearest of all colliding pairs, in their order.
void requireNearest(const Placed& a, const Placed& b, const std::vector<PointPair>& colliding, std::size_t most,
                    const std::vector<Contact>& contacts);

} // namespace pcl_bsh::fuzz
