// SPDX-License-Identifier: BSD-3-Clause
// Asks a question about a site and an obstacle, which is in memory or another site. The answer is that of one
// hierarchy over all points of each.
//
//   site::Site valley = site::readSite("valley");
//   Question question;
//   question.pose = T_valley_robot;
//   question.clearance = 0.05;
//   question.wanted.closest = question.wanted.flags = true;
//   site::SiteAnswer answer = site::ask(question, valley, robot, {.receiver = receiver}); // robot: a Shape
//   site::SiteAnswer changes = site::ask(question, valley, site::readSite("before"));
//
// Only tiles that can matter are read, one at a time. Their boxes are compared with boxes about parts of the obstacle,
// along its path if it moves. Where the obstacle is a site, each tile of the input is read once. The tiles of the
// obstacle that come near it are read after one another, and cut to the points that are near. So memory holds a tile of
// each. A tile of the obstacle may be read once for each tile of the input that it comes near to.
//
// In an MPI job (mpirun -n 4 ...), all ranks ask the same: the tiles are dealt to them, and each gets the whole answer.
// Receivers are called on the rank that has the tile. An accuracy promises for the site what it promises for one cloud.
// A level, a number of pairs or a time applies to each tile, a number of threads to each process.
//
// Unseen points of an obstacle (`seen`) are those of one SeenSpace over all points of the site. All tiles that have
// beams near the directions of the obstacle are read once. Memory keeps the beams that look at the obstacle on its way.
// It keeps all beams of a scan whose scanner stands inside a ball of the obstacle.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// Stores the answer about each tile as a list of numbers, so that a question that was ended can go on. Only the query
/// understands the numbers.
class TileAnswers {
public:
  virtual ~TileAnswers() = default;

  /// Returns the answer about a tile, or null where the tile has to be asked about. All ranks return equal answers.
  virtual const std::vector<double>* known(std::size_t tile) const = 0;

  /// Called by the rank that has the tile, after the receiver.
  virtual void keep(std::size_t tile, const std::vector<double>& numbers) = 0;
};

class ClashFinder;

/// Called for each tile that was read, with its points and the answer about them: vectors of the answer have an entry
/// per point. A question that needs several visits calls it in each visit, with the answer of that visit. For distances
/// to another site, the answer has the distances alone.
using TileReceiver = std::function<void(const Tile&, const pcl::PCLPointCloud2&, const Answer&)>;

/// The means to answer a question about a site.
struct SiteMeans {
  std::uint64_t memory = std::uint64_t{2} << 30; ///< of each process, for a tile and its hierarchy
  /// Answers of an earlier run about collisions or distances. Tiles with such an answer are not read, and the receiver
  /// is not called. ResultSite::answers() returns some.
  TileAnswers* answers = nullptr;
  ClashFinder* clashes = nullptr; ///< gets the points that collide along the path, or at the one pose
  TileReceiver receiver = nullptr;
  TileReceiver obstacle_receiver = nullptr; ///< with Wanted::obstacle_flags, of the tiles of an obstacle that is a site
};

/// The cost of a tile, in seconds of the clock on the wall.
struct TileCost {
  std::uint32_t tile = 0;  ///< its number among the site's
  std::uint32_t place = 0; ///< in the order in which tiles are dealt to ranks
  double reading = 0.0;
  double asking = 0.0; ///< its hierarchy, the question and the receiver
};

/// The tiles that a question has read of a site, in one visit or in several.
struct TilesRead {
  std::uint64_t tiles = 0;     ///< of the site
  std::uint64_t needed = 0;    ///< tiles that could matter before any was read, in the visit with the most
  std::uint64_t read = 0;      ///< by all ranks
  std::vector<TileCost> costs; ///< of all ranks, by their places, visit by visit

  /// Adds another visit.
  TilesRead& operator+=(const TilesRead& visit);
};

/// A point of the site, and a point of the obstacle. The source of the latter is 0 where the obstacle is in memory.
struct SitePair {
  SitePoint a, b;
};

/// The answer. Vectors about points of a site stay empty: receivers get them. Distances are counted in `distances.a`;
/// `work`, the pair of `any`, `pose_pairs` and `unseen.inside` are not told.
struct SiteAnswer : Answer {
  /// The pair of `closest`. Among equal pairs, it has the smallest (source, record) and, for this point, the smallest
  /// point of the obstacle. Along a path, `closest` is the distance of points that collide or are undecided, and has no
  /// pair.
  std::optional<SitePair> pair;
  std::optional<std::size_t> first_pose; ///< along a path, the first at which anything may collide
  std::uint64_t obstacle_colliding = 0;  ///< points, or triangles, of the obstacle
  std::uint64_t obstacle_undecided = 0;
  TilesRead tiles;
  TilesRead obstacle_tiles;     ///< where the obstacle is a site
  TilesRead beam_tiles;         ///< with `seen`, without costs
  std::uint64_t beams_kept = 0; ///< with `seen`, in memory
};

/// rankHere() returns the number of this process in its MPI job, from 0, and ranks() the number of processes; 0 and 1
/// without mpirun. They start MPI where the process has not done so; MPI ends with the process.
int rankHere();
int ranks();

/// Ends all processes of the MPI job with exit code 1: where one has failed, the others would wait for it.
[[noreturn]] void endAllRanks();

/// The answer of one hierarchy over the site. Progress is reported after each tile by the rank that had it. It is the
/// share of the tiles that may have to be asked about, in the order in which they are dealt to all ranks. The search
/// for any collision ends with the first tile that has one. The search for the smallest distance ends where all tiles
/// left are farther.
/// @throws InvalidInput as ask() and check() do; files::FileError for a tile that is not what the site says, and for a
///   field of uncertainties whose greatest values site.json lacks; Cancelled
SiteAnswer ask(const Question& question, const Site& site, Shape& obstacle, const SiteMeans& means = {});

/// The answer where the obstacle is a site. The question's poses place its frame in that of the first site.
SiteAnswer ask(const Question& question, const Site& site, const Site& obstacle, const SiteMeans& means = {});

/// Refuses the question where ask() would refuse it for any two things.
/// @throws InvalidInput naming the option, also one that sites do not obey (QuestionOption::of_sites), or an answer
///   that they do not have
void check(const Question& question, bool obstacle_is_site);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
