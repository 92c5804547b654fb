// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

/// Every query of two clouds calls one of these before anything else, whatever it computes.
/// @throws InvalidInput naming the value: a clearance or an accuracy that is negative or not finite; a pose that is not
///   finite, whose last row is not 0 0 0 1, that mirrors, or whose rotation R has |R'R - I| > 1e-6 (Frobenius norm).
inline void check(const Placed& a, const Placed& b, const AnyRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPoses(a.pose, b.pose);
}

inline void check(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  checkMaxDistance(request.max_distance);
  checkAccuracy(request.accuracy);
  checkPoses(a.pose, b.pose);
}

inline void check(const Placed& a, const Placed& b, const ContactsRequest& request)
{
  checkClearance(request.clearance);
  checkExact(request);
  checkPoses(a.pose, b.pose);
}

} // namespace pcl_bsh
