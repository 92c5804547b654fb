// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/see_site.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/geometry/ball_about_box.h>
#include <pcl_bsh/question/model_stray.h>
#include <pcl_bsh/seen/looked_at.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/site/answers/inquiry.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pcl_bsh::site {

namespace {

using Poses = std::vector<Eigen::Isometry3d>;
using VerdictsAtPoses = std::vector<std::vector<Verdict>>;

/// Of a record of the model, at a pose.
struct Found {
  std::uint32_t pose, record;
  Verdict verdict;
};

TilesRead collide(const Site& site, const SphereHierarchy& model, const Poses& poses, const SiteRequest& request,
                  VerdictsAtPoses& verdicts)
{
  PathReach reach;
  reach.distance = request.clearance;
  FlagsRequest wanted;
  wanted.clearance = request.clearance;
  wanted.threads = request.threads;
  wanted.flagged = Side::b;
  std::vector<Found> own;
  Inquiry inquiry(site, request);
  const auto find = [&](const Tile&, const pcl::PCLPointCloud2&, const SphereHierarchy& hierarchy) {
    FlagsResult found;
    for (std::uint32_t k = 0; k < poses.size(); ++k) {
      pcl_bsh::collisionFlags({hierarchy}, {model, poses[k]}, wanted, found);
      for (std::uint32_t i = 0; i < found.b.size(); ++i)
        if (found.b[i] != Verdict::free) own.push_back({k, i, found.b[i]});
    }
    return std::vector<double>();
  };
  const TilesRead read =
      inquiry.visitAndAdd(tilesAlong(site, CloudBoxes(model.view()), poses, reach, request.uncertainty), find,
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
double ballAt(const Eigen::Isometry3d& pose, const CornerBox& model, const SiteRequest& request)
{
  return request.clearance + strayOf(request.uncertainty.pose, model, pose);
}

/// The beams of all tiles that count, of each scan.
class Beams {
public:
  Beams(const Site& site, const SiteSight& sight, const SphereHierarchy& model, const Poses& poses,
        const SiteRequest& request)
  : site_(site),
    sight_(sight),
    request_(request)
  {
    const CornerBox bounds(model.view());
    for (const ScanOrigins::Entry& entry : sight.origins.entries) {
      looked_.emplace_back(entry.origin, sight.angle);
      for (const Eigen::Isometry3d& pose : poses) looked_.back().add({model, pose}, ballAt(pose, bounds, request));
    }
    collect();
  }

  SeenSpace space() const
  {
    std::vector<ScanBeams> scans(looked_.size());
    for (std::size_t s = 0; s < scans.size(); ++s) {
      scans[s].origin = sight_.origins.entries[s].origin;
      scans[s].returns = viewOf(ends_[s].empty() ? nullptr : ends_[s].front().data(), ends_[s].size());
      scans[s].returns.uncertainty = uncertainty_;
      scans[s].returns.uncertainties = uncertainties_[s].data();
    }
    SeenOptions options;
    options.angle = sight_.angle;
    options.threads = request_.threads;
    return SeenSpace(scans, options);
  }

  std::uint64_t count() const
  {
    return std::accumulate(ends_.begin(), ends_.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& ends) { return sum + ends.size(); });
  }

  TilesRead read;

private:
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
    Uncertainty of_ends = request_.uncertainty;
    of_ends.pose = {}; // beams and their scanner move together
    TileVisitor visitor(site_, request_.memory);
    visitor.visitAll(tiles, [&](const Tile& tile, const pcl::PCLPointCloud2& cloud) {
      const PointsView view = Inquiry::pointsOf(cloud, site_, tile, of_ends);
      uncertainty = view.uncertainty;
      const std::vector<ScanBeams> scans =
          scansOf(view, recordFields(cloud.fields), (site_.folder / tile.file).string(), sight_.origins);
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
    if (beams <= request_.memory / bytes) return;
    throw InvalidInput(Input::seen, "memory",
                       counted(beams, "beam") + " at least look at the model on its way, which " +
                           std::to_string(request_.memory) + " bytes do not hold",
                       "give some " + std::to_string(bytes) + " bytes for each, or ask about a part of the path");
  }

  const Site& site_;
  const SiteSight& sight_;
  const SiteRequest& request_;
  std::vector<LookedAt> looked_; ///< of each scan
  std::vector<std::vector<Point3>> ends_;
  std::vector<std::vector<float>> uncertainties_;
  double uncertainty_ = 0.0;
};

} // namespace

SiteUnseen unseenAlong(const Site& site, const SiteSight& sight, const SphereHierarchy& model, const Poses& poses,
                       const SiteRequest& request)
{
  if (sight.origins.empty()) scansOf(PointsView{}, {}, site.folder.string(), sight.origins); // refuses that
  requireUncertainty(site, request.uncertainty);
  SiteRequest asked = request;
  asked.answers = nullptr;
  asked.progress = nullptr;
  asked.swept.reset();
  VerdictsAtPoses verdicts(poses.size(), std::vector<Verdict>(model.view().count, Verdict::free));
  SiteUnseen result;
  const Beams beams(site, sight, model, poses, asked);
  result.tiles = collide(site, model, poses, asked, verdicts);
  result.tiles_of_beams = beams.read;
  result.beams = beams.count();
  const SeenSpace space = beams.space();
  for (std::size_t s = 0; s < space.size(); ++s) result.unseen.angles.push_back(space.angle(s));
  const CornerBox bounds(model.view());
  UnseenRequest wanted;
  wanted.threads = request.threads;
  wanted.kinds = wanted.parts = true;
  result.verdicts.assign(model.view().count, Verdict::free);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    wanted.clearance = ballAt(poses[k], bounds, request);
    UnseenResult found = markUnseen(space, {model, poses[k]}, wanted, verdicts[k]);
    result.unseen.addPose(verdicts[k], true, result.verdicts, std::move(found.kinds));
  }
  return result;
}

} // namespace pcl_bsh::site
