// SPDX-License-Identifier: BSD-3-Clause
// The part of a question about a site that finds the unseen records of obstacles.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/geometry/ball_about_box.h>
#include <pcl_bsh/question/model_shift.h>
#include <pcl_bsh/seen/looked_at.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/site/answers/tile_query.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pcl_bsh::site {

namespace {

using Poses = std::vector<Eigen::Isometry3d>;
using Parts = std::vector<const QuestionPart*>;
using VerdictsAtPoses = std::vector<std::vector<Verdict>>;

/// The verdict of a record of an obstacle at a pose.
struct Found {
  std::uint32_t obstacle, pose, record;
  Verdict verdict;
};

/// Returns the verdicts of an obstacle's records against a tile at each pose, except those that are free.
std::vector<Found> collide(const QuestionPart& part, std::uint32_t obstacle, const SphereHierarchy& tile,
                           unsigned threads)
{
  const FlagsRequest wanted(part.clearance(), Flagged::b, threads);
  const Poses poses = part.question.poses();
  std::vector<Found> some;
  FlagsResult found;
  for (std::uint32_t k = 0; k < poses.size(); ++k) {
    collisionFlags({tile}, {part.model(), poses[k]}, wanted, found);
    for (std::uint32_t i = 0; i < found.b.size(); ++i)
      if (found.b[i] != Verdict::free) some.push_back({obstacle, k, i, found.b[i]});
  }
  return some;
}

/// @param verdicts of each obstacle
TilesRead collide(const Parts& parts, std::vector<VerdictsAtPoses>& verdicts)
{
  const QuestionPart& first = *parts.front();
  const PlacedSite site = first.input();
  std::vector<std::vector<std::uint32_t>> near(site.site.tiles.size()); // obstacles of each tile
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    PathReach reach;
    reach.distance = parts[i]->clearance();
    const CloudBoxes boxes(parts[i]->model().view());
    for (const std::uint32_t tile : tilesAlong(site.site, boxes, parts[i]->question.poses(), reach, site.uncertainty))
      near[tile].push_back(i);
  }
  std::vector<std::uint32_t> needed;
  for (std::uint32_t t = 0; t < near.size(); ++t)
    if (!near[t].empty()) needed.push_back(t);
  std::vector<Found> own;
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2&, const SphereHierarchy& hierarchy) {
    const std::vector<std::uint32_t>& some = near[static_cast<std::size_t>(&tile - site.site.tiles.data())];
    const unsigned threads = threadCount(first.question.threads);
    std::vector<std::vector<Found>> of_each(some.size());
    parallelFor(some.size(), threads, [&](std::size_t i) {
      of_each[i] = collide(*parts[some[i]], some[i], hierarchy, some.size() > 1 ? 1 : threads);
    });
    for (const std::vector<Found>& found : of_each) own.insert(own.end(), found.begin(), found.end());
    return std::vector<double>();
  };
  TileQuery tile_query(first, site);
  const TilesRead read = tile_query.visitAndAdd(needed, find, [](const std::vector<double>&) {});
  for (const Found& found : gatheredFromAllRanks(own)) {
    Verdict& verdict = verdicts[found.obstacle][found.pose][found.record];
    verdict = graver(verdict, found.verdict);
  }
  return read;
}

struct KeptBeam {
  Point3 end;
  float uncertainty; ///< of its own
  std::uint32_t scan;
};

/// Radius of the balls about a model's points: more where the site's pose is uncertain.
double ballAt(const Eigen::Isometry3d& pose, const CornerBox& model, const QuestionPart& part)
{
  return part.clearance() + shiftOf(part.question.input_pose_uncertainty, model, pose);
}

/// The beams of all tiles that count for any obstacle, of each scan.
class Beams {
public:
  explicit Beams(const Parts& parts) : part_(*parts.front()), site_(part_.site), origins_(part_.question.origin)
  {
    for (const ScanOrigins::Entry& entry : origins_.entries) looked_.emplace_back(entry.origin, angle());
    for (const QuestionPart* const part : parts) {
      const CornerBox bounds(part->model().view());
      for (const Eigen::Isometry3d& pose : part->question.poses())
        for (LookedAt& looked : looked_) looked.add({part->model(), pose}, ballAt(pose, bounds, *part));
    }
    collect();
  }

  SeenSpace space() const
  {
    std::vector<ScanBeams> scans(looked_.size());
    for (std::size_t s = 0; s < scans.size(); ++s) {
      scans[s].origin = origins_.entries[s].origin;
      scans[s].returns = viewOf(ends_[s].empty() ? nullptr : ends_[s].front().data(), ends_[s].size());
      scans[s].returns.uncertainty = uncertainty_;
      scans[s].returns.uncertainties = uncertainties_[s].data();
    }
    SeenOptions options;
    options.angle = angle();
    options.threads = part_.question.threads;
    return SeenSpace(scans, options);
  }

  std::uint64_t count() const
  {
    return std::accumulate(ends_.begin(), ends_.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& ends) { return sum + ends.size(); });
  }

  TilesRead read;

private:
  double angle() const { return part_.question.seen_angle.value_or(0.0); } ///< must be given: it is not measured here

  void collect()
  {
    std::vector<std::uint32_t> near, others;
    for (std::uint32_t i = 0; i < site_.tiles.size(); ++i)
      if (site_.tiles[i].bounds) (isNear(*site_.tiles[i].bounds) ? near : others).push_back(i);
    read.tiles = site_.tiles.size();
    visit(near);
    const bool lacks = std::any_of(ends_.begin(), ends_.end(), [](const auto& ends) { return ends.size() < 2; });
    if (lacks) visit(others); // a scan of one beam sees nothing
  }

  bool isNear(const Bounds& box) const
  {
    const BoxBall ball = ballAboutBox(box.low, box.high);
    return std::any_of(looked_.begin(), looked_.end(),
                       [&](const LookedAt& looked) { return looked.holdsSome(ball.center, ball.radius); });
  }

  void visit(const std::vector<std::uint32_t>& tiles)
  {
    std::vector<KeptBeam> own;
    double uncertainty = 0.0;
    Uncertainty of_ends = part_.question.uncertaintyOfInput();
    of_ends.pose = {}; // beams and their scanner move together
    TileVisitor visitor(site_, part_.means.memory);
    visitor.visitAll(tiles, [&](const Tile& tile, const pcl::PCLPointCloud2& cloud) {
      const PointsView view = TileQuery::pointsOf(cloud, site_, tile, of_ends);
      uncertainty = view.uncertainty;
      const std::vector<ScanBeams> scans =
          scansOf(view, recordFields(cloud.fields), (site_.folder / tile.file).string(), origins_);
      for (std::uint32_t s = 0; s < scans.size(); ++s) keep(scans[s], s, own);
      requireMemory(own.size());
    });
    uncertainty_ = std::max(uncertainty_, -leastOfAllRanks(-uncertainty));
    ends_.resize(looked_.size());
    uncertainties_.resize(looked_.size());
    for (const KeptBeam& beam : gatheredFromAllRanks(own)) {
      ends_[beam.scan].push_back(beam.end);
      uncertainties_[beam.scan].push_back(beam.uncertainty);
    }
    requireMemory(count());
    read.needed += tiles.size();
    read.read += sumOfAllRanks(visitor.read());
  }

  /// Keeps the beams that look at an obstacle, and two others of each tile, so that the scan has two.
  void keep(const ScanBeams& scan, std::uint32_t number, std::vector<KeptBeam>& kept) const
  {
    int others = 0;
    for (std::size_t i = 0; i < scan.returns.size(); ++i) {
      const std::uint32_t record = scan.returns.record(i);
      const Point3 end = scan.returns.point(record);
      if (!isFinite(end) || end == scan.origin) continue;
      if (!looked_[number].holds(end) && others++ >= 2) continue;
      kept.push_back({end, static_cast<float>(scan.returns.ownUncertainty(record)), number});
    }
  }

  void requireMemory(std::uint64_t beams) const
  {
    constexpr std::uint64_t bytes = 2 * sizeof(KeptBeam); // with what SeenSpace holds
    if (beams <= part_.means.memory / bytes) return;
    throw InvalidInput(Input::points, "memory",
                       counted(beams, "beam") + " at least look at the model on its way, which " +
                           std::to_string(part_.means.memory) + " bytes do not hold",
                       "give some " + std::to_string(bytes) + " bytes for each, or ask about a part of the path");
  }

  const QuestionPart& part_; ///< of any obstacle: all are asked about the same scans
  const Site& site_;
  const ScanOrigins& origins_;
  std::vector<LookedAt> looked_; ///< of each scan
  std::vector<std::vector<Point3>> ends_;
  std::vector<std::vector<float>> uncertainties_;
  double uncertainty_ = 0.0;
};

} // namespace

void lookAround(const std::vector<const QuestionPart*>& parts, const std::vector<Answer*>& each, SiteAnswer& all)
{
  if (parts.empty()) return;
  const Question& first = parts.front()->question;
  const Site& site = parts.front()->site;
  if (first.origin.empty()) scansOf(PointsView{}, {}, site.folder.string(), first.origin); // throws: no origin is given
  requireUncertainty(site, first.uncertaintyOfInput());
  std::vector<VerdictsAtPoses> verdicts;
  for (const QuestionPart* const part : parts)
    verdicts.emplace_back(part->question.poses().size(),
                          std::vector<Verdict>(part->model().view().count, Verdict::free));
  const Beams beams(parts);
  all.tiles += collide(parts, verdicts);
  all.beam_tiles = beams.read;
  all.beams_kept = beams.count();
  const SeenSpace space = beams.space();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const QuestionPart& part = *parts[i];
    Answer& answer = *each[i];
    for (std::size_t s = 0; s < space.size(); ++s) answer.unseen.angles.push_back(space.angle(s));
    const CornerBox bounds(part.model().view());
    const bool places = part.question.wanted.unseen_places;
    UnseenRequest wanted;
    wanted.threads = part.question.threads;
    wanted.kinds = true;
    wanted.parts = places;
    answer.obstacle_flags.assign(part.model().view().count, Verdict::free);
    const Poses poses = part.question.poses();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      wanted.clearance = ballAt(poses[k], bounds, part);
      UnseenResult found = markUnseen(space, {part.model(), poses[k]}, wanted, verdicts[i][k]);
      answer.unseen.addPose(verdicts[i][k], places, answer.obstacle_flags, std::move(found.kinds));
    }
  }
}

} // namespace pcl_bsh::site
