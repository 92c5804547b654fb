// SPDX-License-Identifier: BSD-3-Clause
// The part of a question about a site that finds the unseen records of the obstacle.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
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
using VerdictsAtPoses = std::vector<std::vector<Verdict>>;

/// The verdict of a record of the model at a pose.
struct Found {
  std::uint32_t pose, record;
  Verdict verdict;
};

TilesRead collide(const QuestionPart& part, const Poses& poses, VerdictsAtPoses& verdicts)
{
  const SphereHierarchy& model = part.model();
  PathReach reach;
  reach.distance = part.clearance();
  const FlagsRequest wanted(part.clearance(), Flagged::b, part.question.threads);
  std::vector<Found> own;
  const PlacedSite site = part.input();
  TileQuery tile_query(part, site);
  const auto find = [&](const Tile&, const pcl::PCLPointCloud2&, const SphereHierarchy& hierarchy) {
    FlagsResult found;
    for (std::uint32_t k = 0; k < poses.size(); ++k) {
      collisionFlags({hierarchy}, {model, poses[k]}, wanted, found);
      for (std::uint32_t i = 0; i < found.b.size(); ++i)
        if (found.b[i] != Verdict::free) own.push_back({k, i, found.b[i]});
    }
    return std::vector<double>();
  };
  const TilesRead read =
      tile_query.visitAndAdd(tilesAlong(site.site, CloudBoxes(model.view()), poses, reach, site.uncertainty), find,
                             [](const std::vector<double>&) {});
  for (const Found& found : gatheredFromAllRanks(own)) {
    Verdict& verdict = verdicts[found.pose][found.record];
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

/// The beams of all tiles that count, of each scan.
class Beams {
public:
  Beams(const QuestionPart& part, const Poses& poses) : part_(part), site_(part.site), origins_(part.question.origin)
  {
    const SphereHierarchy& model = part.model();
    const CornerBox bounds(model.view());
    for (const ScanOrigins::Entry& entry : origins_.entries) {
      looked_.emplace_back(entry.origin, angle());
      for (const Eigen::Isometry3d& pose : poses) looked_.back().add({model, pose}, ballAt(pose, bounds, part));
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
  double angle() const { return part_.question.seen_angle.value_or(0.0); } ///< which is not measured here

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

  /// Two of each tile whatever they say, so that there are two.
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

  const QuestionPart& part_;
  const Site& site_;
  const ScanOrigins& origins_;
  std::vector<LookedAt> looked_; ///< of each scan
  std::vector<std::vector<Point3>> ends_;
  std::vector<std::vector<float>> uncertainties_;
  double uncertainty_ = 0.0;
};

} // namespace

void lookAround(const QuestionPart& part, SiteAnswer& answer)
{
  const Question& question = part.question;
  const SphereHierarchy& model = part.model();
  const Poses poses = question.poses();
  if (question.origin.empty()) scansOf(PointsView{}, {}, part.site.folder.string(), question.origin); // refuses that
  requireUncertainty(part.site, question.uncertaintyOfInput());
  VerdictsAtPoses verdicts(poses.size(), std::vector<Verdict>(model.view().count, Verdict::free));
  const Beams beams(part, poses);
  answer.tiles += collide(part, poses, verdicts);
  answer.beam_tiles = beams.read;
  answer.beams_kept = beams.count();
  const SeenSpace space = beams.space();
  for (std::size_t s = 0; s < space.size(); ++s) answer.unseen.angles.push_back(space.angle(s));
  const CornerBox bounds(model.view());
  UnseenRequest wanted;
  wanted.threads = question.threads;
  wanted.kinds = true;
  wanted.parts = question.wanted.unseen_places;
  answer.obstacle_flags.assign(model.view().count, Verdict::free);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    wanted.clearance = ballAt(poses[k], bounds, part);
    UnseenResult found = markUnseen(space, {model, poses[k]}, wanted, verdicts[k]);
    answer.unseen.addPose(verdicts[k], question.wanted.unseen_places, answer.obstacle_flags, std::move(found.kinds));
  }
}

} // namespace pcl_bsh::site
