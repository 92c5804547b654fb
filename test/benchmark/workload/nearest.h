// SPDX-License-Identifier: BSD-3-Clause
// Distance from a point to the nearest of a cloud, in double: measures spacings and settles disputes.
#pragma once

#include "points.h"

#include <memory>

namespace pcl_bsh::bench {

class NearestDistance {
public:
  explicit NearestDistance(const Points& points); ///< borrowed
  ~NearestDistance();

  /// Distance to the nearest point; infinity without points.
  double to(const Point& query) const;

  /// Distance to the nearest point that is not a duplicate of the query; infinity when none of sixteen is.
  double toOther(const Point& query) const;

private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

} // namespace pcl_bsh::bench
