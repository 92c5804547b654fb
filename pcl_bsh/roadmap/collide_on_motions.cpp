// SPDX-License-Identifier: BSD-3-Clause
// Many motions as a whole: what collides at a pose, then the motions that are left, as poses of their middles.
#include <pcl_bsh/roadmap/collide_on_motions.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/roadmap/batches.h>
#include <pcl_bsh/roadmap/motions_query.h>
#include <pcl_bsh/trajectory/leaf/closest_approach.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double kAtPoses = 0.25; ///< of the progress

TrajectoryRequest requestOfOne(const MotionsRequest& asked)
{
  TrajectoryRequest request;
  request.clearance = asked.clearance;
  request.swept = asked.swept;
  request.pivot = asked.pivot;
  request.flags = false;
  return request;
}

bool comesFirst(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other)
{
  const double *const a = one.matrix().data(), *const b = other.matrix().data();
  return !std::lexicographical_compare(b, b + 16, a, a + 16);
}

/// A point of the world, seen by a body at a pose.
Eigen::Vector3d seen(const Eigen::Isometry3d& pose, const Eigen::Vector3d& world)
{
  return pose.linear().transpose() * (world - pose.translation());
}

/// About where motions have their middles: enough to order them.
struct RoughMiddles {
  std::size_t size() const { return open.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const
  {
    const PoseMotion& motion = motions[open[i]];
    Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
    middle.matrix().topRows<3>() =
        0.5 * (poses[motion.from].matrix().topRows<3>() + poses[motion.to].matrix().topRows<3>());
    return middle;
  }

  const PoseList& poses;
  const std::vector<PoseMotion>& motions;
  const std::vector<std::uint32_t>& open;
};

/// Those of a batch, of points that are where `places` says.
class MotionsOfBatch final : public MotionsAbout {
public:
  MotionsOfBatch(const MotionsQuery& query, Places places) : query_(query), places_(places)
  {
    tolerance = query.request.swept;
  }

  /// Appends a motion. @return the pose of its middle
  Eigen::Isometry3d add(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const BodyBall& body)
  {
    const RigidMotion& motion = motions_.emplace_back(motionBetween(from, to, query_.request.pivot));
    const Eigen::Isometry3d middle = motion.at(0.5);
    extents.push_back(extentAround(middle, motion, body));
    return middle;
  }

  /// At the instant that a straight line between the motion's ends suggests.
  bool collide(std::size_t i, const PointPair& pair, Work& work) const override
  {
    const RigidMotion& motion = motions_[i];
    const Point3 p = query_.scan.hierarchy().view().point(pair.a), q = query_.model.view().point(pair.b);
    const Eigen::Vector3d world = query_.scan.pose * Eigen::Vector3d(p[0], p[1], p[2]);
    const Eigen::Vector3d start = seen(motion.from(), world), way = seen(motion.to(), world) - start;
    const Approach approach = closestApproach({start[0] - q[0], start[1] - q[1], start[2] - q[2]},
                                              {way[0], way[1], way[2]}, std::numeric_limits<double>::infinity());
    const Placed model{query_.model, motion.at(approach.at)};
    return PointPairs(query_.scan, model, query_.request.clearance, places_).collide(pair, work);
  }

  /// As a swept path that ends at the first witness.
  std::optional<PointPair> find(std::size_t i, Work& work) const override
  {
    const std::function<bool(double)> none;
    Progress own(none);
    TrajectoryResult counted;
    const std::vector<Eigen::Isometry3d> ends = {motions_[i].from(), motions_[i].to()};
    const TrajectoryQuery path(query_.scan, query_.model, query_.boxes, ends, query_.swept, counted, own, places_,
                               Wanted::witness);
    const StopRule never(Accuracy::exact());
    const std::vector<NearVoxel> near_voxels = path.nearVoxels(never, own);
    std::optional<PointPair> witness;
    for (std::span<const NearVoxel> left = near_voxels; !left.empty() && !witness;) {
      const VoxelResult found = walkVoxel(path, never, takeVoxel(left));
      counted.work += found.work;
      witness = found.witness;
    }
    work += counted.work;
    return witness;
  }

private:
  const MotionsQuery& query_;
  const Places places_;
  std::vector<RigidMotion> motions_;
};

} // namespace

MotionsQuery::MotionsQuery(const Placed& scan_at, const SphereHierarchy& model_of, const MotionsRequest& asked)
: scan(scan_at),
  model(model_of),
  request(asked),
  boxes(model_of.storage(), Travel(), // of motions in all directions
        divisionFor(scan_at.hierarchy().storage().size, scan_at.hierarchy().storage().largest_radius)),
  swept(requestOfOne(asked))
{
}

RigidMotion motionBetween(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other, const Point3& pivot)
{
  const bool forward = comesFirst(one, other);
  const Eigen::Isometry3d &from = forward ? one : other, &to = forward ? other : one;
  return RigidMotion(from, to, {pivot[0], pivot[1], pivot[2]}, shorterTurn(from.linear(), to.linear()));
}

/// Half of the pivot's way, and half of the turn about it. Rounding: a few v of all that is added.
double extentAround(const Eigen::Isometry3d& middle, const RigidMotion& motion, const BodyBall& body)
{
  const double away = (body.center - motion.pivot()).norm() + body.radius;
  const double bound = 0.5 * motion.shift().norm() + motion.turningReach(away, 0.5);
  const double added = body.center.lpNorm<1>() + motion.pivot().lpNorm<1>() + motion.worldPivot().lpNorm<1>() +
                       motion.shift().lpNorm<1>() + middle.translation().lpNorm<1>() + body.radius;
  const double safe = bound * (1.0 + 0x1p-40) + added * 0x1p-45;
  return std::isfinite(safe) ? safe : std::numeric_limits<double>::infinity();
}

namespace {

/// @param memory of an earlier result
AnyOnMotions answer(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                    const std::vector<PoseMotion>& motions, const MotionsRequest& request, AnyOnMotions&& memory)
{
  check(scan, poses, motions, request);
  const DefaultFloatEnvironment environment;
  AnyOnMotions result;
  result.flags.swap(memory.flags);
  result.flags.assign(motions.size(), Verdict::free);
  if (scan.hierarchy().empty() || model.empty() || motions.empty()) return result;
  const MotionsQuery query(scan, model, request);
  result.work.volumes_built += countChildren(query.boxes.storage.top);

  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> used, place(poses.size(), kUnused); // poses that motions name; of a pose among them
  for (const PoseMotion& motion : motions) place[motion.from] = place[motion.to] = 0;
  for (std::size_t k = 0; k < place.size(); ++k) {
    if (place[k] == kUnused) continue;
    place[k] = static_cast<std::uint32_t>(used.size());
    used.push_back(static_cast<std::uint32_t>(k));
  }
  checkSwept(query, poses, used, motions);

  AnyRequest at_poses;
  at_poses.clearance = request.clearance;
  at_poses.threads = request.threads;
  at_poses.progress = [&](double done) { return !request.progress || request.progress(kAtPoses * done); };
  const AnyAtPoses found = anyCollisionAtPoses(scan, model, SomePoses{poses, used}, at_poses);
  result.work += found.work;
  for (std::size_t m = 0; m < motions.size(); ++m)
    result.flags[m] = graver(found.flags[place[motions[m].from]], found.flags[place[motions[m].to]]);

  const BodyBall body(model);
  result.work += giveVerdicts(
      areUncertain(scan, {model}), request.progress, kAtPoses, result.flags,
      [&](const std::vector<std::uint32_t>& open, Places places, Progress& progress, const auto& mark) {
        const std::vector<std::uint32_t> order =
            orderOf(RoughMiddles{poses, motions, open}, body, threadCount(request.threads));
        return forEachBatch(order.size(), request.threads, progress, [&](std::size_t begin, std::size_t end) {
          MotionsOfBatch about(query, places);
          PoseBatch middles{scan, model, body, {}, &about};
          for (std::size_t k = begin; k < end; ++k) {
            const PoseMotion& motion = motions[open[order[k]]];
            middles.poses.push_back(about.add(poses[motion.from], poses[motion.to], body));
          }
          bool collide[kBatchPoses] = {};
          const Work work = anyOfBatch(middles, at_poses, places, collide);
          for (std::size_t k = begin; k < end; ++k)
            if (collide[k - begin]) mark(order[k]);
          return work;
        });
      });
  result.colliding = countOf(result.flags, Verdict::colliding);
  result.undecided = countOf(result.flags, Verdict::undecided);
  return result;
}

} // namespace

AnyOnMotions anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                                   const std::vector<PoseMotion>& motions, const MotionsRequest& request)
{
  return answer(scan, model, poses, motions, request, {});
}

void anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                           const std::vector<PoseMotion>& motions, const MotionsRequest& request, AnyOnMotions& result)
{
  result = answer(scan, model, poses, motions, request, std::exchange(result, {}));
}

} // namespace pcl_bsh
