// SPDX-License-Identifier: BSD-3-Clause
// Points of a site that may be nearest to something: the nearest of each tile, of which exact arithmetic chooses.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/site/collide_site.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::site {

struct Candidate {
  Point3 place;
  SitePoint point;
  double distance;
};

/// The name of a tile's point.
SitePoint nameOf(const pcl::PCLPointCloud2& cloud, std::uint32_t i);

/// Those of all ranks that have a distance, in the order of their names.
struct Candidates {
  Candidates(const std::vector<Candidate>& own, double distance);

  SphereHierarchy hierarchy() const;

  std::vector<Point3> places;
  std::vector<SitePoint> points;
};

} // namespace pcl_bsh::site
