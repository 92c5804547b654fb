// SPDX-License-Identifier: BSD-3-Clause
// Questions about a site and a cloud in memory, or another site, with the answers of one hierarchy over all points of
// each.
//
//   site::Site valley = site::readSite("valley");
//   SphereHierarchy robot(viewOf(robot_xyz, n));
//   site::SiteRequest request;
//   request.clearance = 0.05;
//   site::SiteClosest nearest = site::closestPair(valley, Placed(robot, T_valley_robot), request);
//   site::SiteFlags changes = site::collisionFlags(valley, site::PlacedSite{before}, request, sink);
//
// Only tiles that can matter are read, one at a time. Which, their boxes tell: compared with boxes about parts of the
// cloud, along its path if it moves. Of two sites a tile of the first is read once. The tiles of the second that come
// near it are read after one another and cut to what is near, so that memory holds a tile of each; a tile that several
// of the first come near to is read for each of them.
//
// In an MPI job (mpirun -n 4 ...), all ranks call the same function with the same input: the tiles are dealt to them,
// and each gets the whole answer. Sinks are called on the rank that has the tile. Where points have uncertainties,
// verdicts are as those of the queries: those of a cloud are of its view, a site's are asked for. What an accuracy
// promises of one cloud holds of the site; those that stop early do so in each tile.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/search/uncertainty.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// A site as the second of two.
struct PlacedSite {
  const Site& site;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< of its points in the first site's frame
  Uncertainty uncertainty = {};                           ///< of its points, as SiteRequest has that of the first
};

/// What a question has found of tiles, by their numbers, so that it can be asked again after it was ended: numbers that
/// only the query understands.
class TileAnswers {
public:
  virtual ~TileAnswers() = default;

  /// Null where the tile has to be asked about. The same on all ranks.
  virtual const std::vector<double>* known(std::size_t tile) const = 0;

  /// Called by the rank that has the tile, after the sink.
  virtual void keep(std::size_t tile, const std::vector<double>& numbers) = 0;
};

class ClashFinder;

/// What is asked about a site, and with which means. A level, a number of pairs or a time is that of each tile; threads
/// are those of each process. Progress is reported after each tile by the rank that had it: the share of the tiles that
/// may have to be asked about, in the order in which they are dealt to all ranks.
struct SiteRequest : Effort {
  double clearance = 0.0;      ///< finite, >= 0; inclusive
  std::optional<double> swept; ///< of collideAlong(): the motion between poses too, to this tolerance, as there
  Point3 pivot = {0, 0, 0};    ///< of that motion, as there
  Uncertainty uncertainty;     ///< of the site's points: for verdicts, as in PointsView. A field is one of the site's
  bool pose_summaries = false; ///< of collideAlong(): what collides at each pose, as there
  ClashFinder* clashes = nullptr;                ///< of collideAlong(): gets what collides; needs distances
  std::uint64_t memory = std::uint64_t{2} << 30; ///< of each process, for a tile and its hierarchy
  /// Of flags, distances and paths: tiles that are known are not read, and their sinks not called. ResultSite has some.
  TileAnswers* answers = nullptr;

  /// b in memory, a mesh, as a shape that counts with what its faces enclose, and they must close: what is inside
  /// collides, its distance is negative. Its hierarchy is that of b. Null: b is its surface alone.
  Shape* solid = nullptr;
};

/// What a tile has cost, in seconds of the clock on the wall.
struct TileCost {
  std::uint32_t tile = 0;  ///< its number among the site's
  std::uint32_t place = 0; ///< in the order in which tiles are dealt to ranks
  double reading = 0.0;
  double asking = 0.0; ///< its hierarchy, the question and the sink
};

/// What a question has read.
struct TilesRead {
  std::uint64_t tiles = 0;     ///< of the site
  std::uint64_t needed = 0;    ///< those that could matter before any was read
  std::uint64_t read = 0;      ///< by all ranks
  std::vector<TileCost> costs; ///< of all ranks, by their places
};

/// A point of a site that another one meets.
struct MetPoint {
  SitePoint point;
  Point3 place = {0, 0, 0}; ///< in its own site
};

/// Whether anything of a site collides.
struct SiteAny {
  Verdict verdict = Verdict::free; ///< undecided only where points are uncertain, or the accuracy stops early
  TilesRead tiles, tiles_b;        ///< of the site, and of b where it is one; the costs are of the first's tiles
};

/// How much of a site collides.
struct SiteFlags {
  std::uint64_t colliding = 0; ///< points of the site
  std::uint64_t undecided = 0;
  std::vector<Verdict> b; ///< one per record of b's view, where asked for: as FlagsResult has them
  std::uint64_t colliding_b = 0;
  std::uint64_t undecided_b = 0;
  TilesRead tiles, tiles_b;
};

/// The smallest distance of a site to another cloud.
struct SiteClosest {
  double distance = std::numeric_limits<double>::infinity(); ///< as closestPair() has it
  Interval interval; ///< holds the smallest distance for certain, where there is one
  /// That realise it; of several the smallest (source, record), and for it the smallest record of b.
  std::optional<SitePoint> point;
  std::uint32_t b = 0;
  std::optional<SitePoint> point_b; ///< that of b, where it is a site
  TilesRead tiles, tiles_b;
};

/// The distances of a site's points to another cloud.
struct SiteDistances {
  std::uint64_t measured = 0;  ///< points that have a distance
  std::uint64_t undecided = 0; ///< that may have one, where the accuracy stops early
  double greatest = std::numeric_limits<double>::quiet_NaN();
  TilesRead tiles, tiles_b;
};

/// What another cloud meets in a site along its path.
struct SitePassage {
  std::uint64_t colliding = 0; ///< points of the site that collide at any pose
  std::uint64_t undecided = 0; ///< that may, where points are uncertain or the accuracy stops early
  /// The smallest distance of points that collide or are undecided, and the first pose at which any may; NaN and -1:
  /// none does.
  float distance = std::numeric_limits<float>::quiet_NaN();
  std::int32_t first_pose = -1;
  std::optional<FirstContact> first_contact;   ///< of swept motion, where anything may collide
  std::optional<FirstContact> certain_contact; ///< the same of what collides for certain, where points are uncertain
  std::vector<PoseSummary> poses;              ///< one per pose, where asked for
  TilesRead tiles, tiles_b;
};

/// Called for each tile that was read, with its points and what was found of them: vectors have an entry per point. Of
/// distances to another site, the distances alone.
using FlagsSink = std::function<void(const Tile&, const pcl::PCLPointCloud2&, const FlagsResult&)>;
using DistancesSink = std::function<void(const Tile&, const pcl::PCLPointCloud2&, const PointDistances&)>;
using PassageSink = std::function<void(const Tile&, const pcl::PCLPointCloud2&, const TrajectoryResult&)>;

/// The number of this process among those of an MPI job, from 0, and how many there are; 0 and 1 without mpirun. MPI is
/// begun where the process has not done so, and ends with it.
int rankHere();
int ranks();

/// Ends all processes of the MPI job with exit code 1: where one has failed, the others would wait for it.
[[noreturn]] void endAllRanks();

/// Does any point of the site collide with b? Ends with the first tile that has one.
/// @throws std::invalid_argument as the query of the same name does; files::FileError for a tile that is not what the
///   site says; Cancelled
SiteAny anyCollision(const Site& site, const Placed& b, const SiteRequest& request);
SiteAny anyCollision(const Site& site, const PlacedSite& b, const SiteRequest& request);

/// Which points do? Those of tiles that are not read are free.
SiteFlags collisionFlags(const Site& site, const Placed& b, Side flagged, const SiteRequest& request,
                         const FlagsSink& sink = nullptr);
SiteFlags collisionFlags(const Site& site, const PlacedSite& b, const SiteRequest& request,
                         const FlagsSink& sink = nullptr);

/// Which points of b do? The same pairs: the counts are of b, and the sink gets its tiles.
SiteFlags collisionFlagsOfB(const Site& site, const PlacedSite& b, const SiteRequest& request,
                            const FlagsSink& sink = nullptr);

/// The smallest distance. Tiles come in the order of their lower bounds, and end where these exceed the smallest
/// distance of any rank. The clearance and uncertainties are not used.
SiteClosest closestPair(const Site& site, const Placed& b, const SiteRequest& request);
SiteClosest closestPair(const Site& site, const PlacedSite& b, const SiteRequest& request);

/// The distance of each point to b, up to max_distance; those of tiles that are not read are farther. The clearance and
/// uncertainties are not used.
/// @throws std::invalid_argument also for an accuracy that stops early, where b is a site
SiteDistances pointDistances(const Site& site, const Placed& b, double max_distance, const SiteRequest& request,
                             const DistancesSink& sink = nullptr);
SiteDistances pointDistances(const Site& site, const PlacedSite& b, double max_distance, const SiteRequest& request,
                             const DistancesSink& sink = nullptr);

/// The model along its poses, in the site's frame: flags, distances, first and closest poses of each point; flags alone
/// where the accuracy stops early.
/// @throws std::invalid_argument also for poses and a tolerance that no tile is asked about, and for clashes where the
///   accuracy stops early
SitePassage collideAlong(const Site& site, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                         const SiteRequest& request, const PassageSink& sink = nullptr);

/// The same of a site as the model. Of its tiles those are read that come near a tile of the first on their way.
/// @param model_uncertainty as PlacedSite has it
SitePassage collideAlong(const Site& site, const Site& model, const Uncertainty& model_uncertainty,
                         const std::vector<Eigen::Isometry3d>& poses, const SiteRequest& request,
                         const PassageSink& sink = nullptr);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
