// SPDX-License-Identifier: BSD-3-Clause
// The pairs of points themselves: where two posed clouds collide, how deep, and which way is out.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <limits>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Options of nearestContacts() and pairsWithin(). Both are exact, and take one thread.
struct ContactsRequest : Effort {
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  ContactsRequest() = default;
  /** Sets all. */ ContactsRequest(double within, std::size_t at_most = kAll, Effort effort = {})
  : Effort(std::move(effort)),
    clearance(within),
    most(at_most)
  {
  }

  double clearance = 0.0;  ///< finite, >= 0; inclusive
  std::size_t most = kAll; ///< pairs in the result; they may be as many as a x b
};

/// A colliding pair of points, or of triangles; or one of a manifold (manifold/contact_manifold.h).
struct Contact {
  PointPair pair;
  double distance = 0.0; ///< |T_a p - T_b q| less both radii, rounded to the nearest double; of a manifold: the gap
  /// From b's nearest place to a's, unit length, in the world; 0 where they meet. In a manifold it is the surface's.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d place_a = Eigen::Vector3d::Zero(); ///< nearest to each other, in the world, within rounding; of
  Eigen::Vector3d place_b = Eigen::Vector3d::Zero(); ///< balls on their surfaces
  double residual = 0.0;                             ///< of a manifold: of the plane that gave the normal
  std::uint32_t id = 0;                              ///< of a manifold: lives while the contact does; otherwise 0
  std::uint32_t patch = 0;                           ///< of a manifold: which of its patches, from 0
};

/// Result of nearestContacts().
struct ContactsResult {
  std::vector<Contact> contacts; ///< by distance before rounding, then by (a, b)
  bool complete = true;          ///< no colliding pair was left out
  Work work;
};

/// The `request.most` nearest of the colliding pairs, or all of them when they are fewer; of pairs at the same
/// distance, the smallest (a, b) first.
/// @throws std::invalid_argument when the clearance or a pose is not what its declaration asks for; an
///   accuracy other than exact. Cancelled.
ContactsResult nearestContacts(const Placed& a, const Placed& b, const ContactsRequest& request);

/// Writes into a result whose memory is used again.
void nearestContacts(const Placed& a, const Placed& b, const ContactsRequest& request, ContactsResult& result);

/// Pairs of points within the clearance, in no particular order, for callers that visit all of them.
struct PairsWithin {
  std::vector<PointPair> pairs;
  bool complete = true; ///< false: there are more than `request.most`, and `pairs` holds any of them
  Work work;
};
/// Throws as nearestContacts() does.
PairsWithin pairsWithin(const Placed& a, const Placed& b, const ContactsRequest& request);

/// Writes into a result whose memory is used again.
void pairsWithin(const Placed& a, const Placed& b, const ContactsRequest& request, PairsWithin& result);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
