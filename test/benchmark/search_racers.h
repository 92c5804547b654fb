// SPDX-License-Identifier: BSD-3-Clause
// Everyone who finds the neighbours of points, behind one face.
#pragma once

#include "workload/points.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::bench {

/// The sum of many answers: enough to see that two racers gave equal ones.
struct SearchAnswer {
  std::uint64_t found = 0;
  std::optional<double> squared_distances = 0.0; ///< their sum; nothing where they need not be those of the nearest
};

/// Each query gives indices and squared distances, nearest first, into vectors kept from query to query. (The octree
/// does not sort.)
class SearchRacer {
public:
  virtual ~SearchRacer() = default;

  /// Brings the cloud, borrowed, into the library's own type; not timed.
  virtual void adopt(const Points& cloud) = 0;

  /// Prepares for a radius where the library has a resolution to choose; not timed. @return whether it has.
  virtual bool tune(float) { return false; }

  virtual void build() = 0;
  virtual void release() = 0;

  /// Up to `most` (0: all) within the radius. Nothing when the library has no such search.
  virtual std::optional<SearchAnswer> radius(const Points& queries, float radius, unsigned most) const = 0;
  virtual std::optional<SearchAnswer> nearest(const Points& queries, unsigned k) const = 0;

  /// How many of the balls hold a point; each query stops at the first where the library can.
  virtual std::optional<SearchAnswer> probes(const Points& centers, const std::vector<float>& radii) const = 0;

  /// The last answer with what was left to add up once the clock had stopped.
  virtual SearchAnswer completed(SearchAnswer answer) const { return answer; }
};

/// `name` is one of kSearchRacers.
///   pcl_bsh        pcl_bsh::search::BoundingSphereSearch, query by query
///   pcl_bsh_batch  the same, all queries of a task at once, on one thread, into vectors kept from batch to batch;
///                  pcl_bsh_batch2: on two
///   pcl_kdtree     pcl::search::KdTree; pcl_octree: pcl::search::Octree
///   nanoflann      k-d tree, leaves of ten
///   grid           uniform grid, its edge the radius; for probes the edge that was fastest of several
/// @throws std::invalid_argument for another name.
std::unique_ptr<SearchRacer> makeSearchRacer(const std::string& name);

inline const std::vector<std::string> kSearchRacers = {
    "pcl_bsh", "pcl_bsh_batch", "pcl_bsh_batch2", "pcl_kdtree", "pcl_octree", "nanoflann", "grid"};

} // namespace pcl_bsh::bench
