// SPDX-License-Identifier: BSD-3-Clause
// Questions about two sites, neither of which needs to fit into memory, with the answers of one hierarchy over all
// points of each.
//
//   site::Site now = site::readSite("now"), before = site::readSite("before");
//   site::SiteRequest request;
//   request.clearance = 0.05;
//   site::SitePairFlags flags = site::collisionFlags(now, {before}, request, sink);
//
// A tile of the first site is read once. The tiles of the second that come near it are read after one another and cut
// to what is near, so that memory holds a tile of each; a tile that several of the first come near to is read for each
// of them. Ranks, sinks, uncertainties and accuracies are as in collide_site.h; the request's uncertainty is that of
// the first site.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/collide_site.h>

#include <Eigen/Geometry>

#include <optional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// A site as the second of two.
struct PlacedSite {
  const Site& site;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< of its points in the first site's frame
  Uncertainty uncertainty = {};                           ///< of its points, as SiteRequest has that of the first
};

/// Whether anything of two sites collides.
struct SitePairAny {
  Verdict verdict = Verdict::free; ///< as SiteAny has it
  TilesRead tiles, tiles_b;        ///< of both sites; the costs are of the first's tiles
};

/// How much of a site collides with another.
struct SitePairFlags {
  std::uint64_t colliding = 0; ///< points of the first site
  std::uint64_t undecided = 0;
  TilesRead tiles, tiles_b;
};

/// The smallest distance of two sites.
struct SitePairClosest {
  double distance = std::numeric_limits<double>::infinity(); ///< as closestPair() has it
  Interval interval; ///< holds the smallest distance for certain, where there is one and the accuracy is proven
  std::optional<SitePoint> point, point_b; ///< that realise it; of several the smallest first, and for it the smallest
  TilesRead tiles, tiles_b;
};

/// The distances of a site's points to another site.
struct SitePairDistances {
  std::uint64_t measured = 0; ///< points that have a distance
  double greatest = std::numeric_limits<double>::quiet_NaN();
  TilesRead tiles, tiles_b;
};

/// What a site meets of another one that moves along a path.
struct SitePairPassage : SitePassage {
  TilesRead tiles_b;
};

/// Called for each tile of the first site that was read, with its points and the distance of each, NaN where it has
/// none.
using PairDistancesSink =
    std::function<void(const Tile&, const pcl::PCLPointCloud2&, const std::vector<double>& distance)>;

/// Does any point of the site collide with one of b? Ends with the first tile that has one.
/// @throws std::invalid_argument as the query of the same name does; files::FileError for a tile that is not what its
///   site says; Cancelled
SitePairAny anyCollision(const Site& site, const PlacedSite& b, const SiteRequest& request);

/// Which points of the site do? Those of tiles that are not read are free.
SitePairFlags collisionFlags(const Site& site, const PlacedSite& b, const SiteRequest& request,
                             const FlagsSink& sink = nullptr);

/// Which points of b do? The same pairs: the sink gets the tiles of b.
SitePairFlags collisionFlagsOfB(const Site& site, const PlacedSite& b, const SiteRequest& request,
                                const FlagsSink& sink = nullptr);

/// The smallest distance. Tiles come in the order of their lower bounds, and end where these exceed the smallest
/// distance of any rank. The clearance and uncertainties are not used.
SitePairClosest closestPair(const Site& site, const PlacedSite& b, const SiteRequest& request);

/// The distance of each point to b, up to max_distance; those of tiles that are not read are farther. The clearance and
/// uncertainties are not used.
/// @throws std::invalid_argument also for an accuracy that stops early
SitePairDistances pointDistances(const Site& site, const PlacedSite& b, double max_distance, const SiteRequest& request,
                                 const PairDistancesSink& sink = nullptr);

/// The site `model` along its poses, in the first site's frame: flags, distances, first and closest poses of each point
/// of the first site; flags alone where the accuracy stops early. Of tiles of the model those are read that come near a
/// tile of the first on their way.
/// @param model_uncertainty as PlacedSite has it
/// @throws std::invalid_argument also for poses and a tolerance that no tile is asked about, and for clashes where the
///   accuracy stops early
SitePairPassage collideAlong(const Site& site, const Site& model, const Uncertainty& model_uncertainty,
                             const std::vector<Eigen::Isometry3d>& poses, const SiteRequest& request,
                             const PassageSink& sink = nullptr);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
