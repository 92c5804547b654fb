// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/collide.h>

namespace pcl_bsh::test {

/// A question that a test asks of several queries: the request of each.
struct Question {
  double clearance = 0.0;
  Flagged flagged = Flagged::a;
  unsigned threads = 1;
  Accuracy accuracy;

  operator AnyRequest() const { return {clearance, {accuracy, threads}}; }
  operator FlagsRequest() const { return {clearance, flagged, {accuracy, threads}}; }
  operator DistanceRequest() const { return {accuracy, threads}; }
};

} // namespace pcl_bsh::test
