// SPDX-License-Identifier: BSD-3-Clause
// The clashes of a site along a path, as findClashes() would list them of one cloud of all its points. Ids are the
// same, although a clash may lie in many tiles.
//
//   site::ClashFinder finder(valley, 0.25);
//   site::ask(question, valley, wagon, {.clashes = &finder});
//   site::SiteClashes list = finder.finish();
//
// The points of a tile's clashes that come near other tiles are kept until all tiles have been visited. A step of the
// cluster distance from one tile to another joins two clashes.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/site/ask_site.h>

#include <memory>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// The point of a model that is nearest to a colliding point of a site.
struct MetPoint {
  SitePoint point;
  Point3 place = {0, 0, 0}; ///< in the frame of its own site
};

/// The clashes that ClashFinder found.
struct SiteClashes {
  /// The clashes that findClashes() would return. Their records are indices into `points`. Each clash lists at most
  /// ClashFinder::most_points of its points, and the one of its closest pair. The choice does not depend on tiles.
  std::vector<Clash> clashes;
  std::vector<SitePoint> points; ///< some points of all clashes
  std::vector<Point3> places;    ///< where they are
  /// Where the model is a site: its points of the closest pairs. The model_point of each clash is an index into them.
  std::vector<MetPoint> met;
};

/// Gathers the points of a site's tiles that collide along a path, and makes clashes of them.
class ClashFinder {
public:
  static constexpr std::size_t most_points = 500; ///< of a clash that are listed

  /// @param cluster_distance finite, > 0
  /// @throws std::invalid_argument for another one
  ClashFinder(const Site& site, double cluster_distance);
  ~ClashFinder();
  ClashFinder(const ClashFinder&) = delete;
  ClashFinder& operator=(const ClashFinder&) = delete;

  /// For ask(): returns the clashes in a tile as numbers, which may be kept for a finder of the same distance.
  /// @param met where the model is a site, the points that closest_point is an index into; else null
  std::vector<double> numbersOf(const Tile& tile, const pcl::PCLPointCloud2& cloud, const CollidingRecords& found,
                                const std::vector<MetPoint>* met) const;

  /// For ask(): adds the clashes in the numbers from numbers[begin] on, as numbersOf() returns them.
  void add(const std::vector<double>& numbers, std::size_t begin);

  /// All clashes, on all ranks of an MPI job. To be called once, by all of them.
  SiteClashes finish();

private:
  class Joining;
  std::unique_ptr<Joining> joining_;
};

/// Returns the median of the tiles' spacings, each weighted by the points of its tile; 0 for a site without points.
double spacingOf(const Site& site);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
