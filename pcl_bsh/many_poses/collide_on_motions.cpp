// SPDX-License-Identifier: BSD-3-Clause
// Many motions: first collisions at their poses, then the motions that are left, one after the other.
#include <pcl_bsh/many_poses/collide_on_motions.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/many_poses/batches.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/motions_query.h>
#include <pcl_bsh/pairs/any_at_places.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/leaf/closest_approach.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
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

/// Tells of each motion in turn whether points collide, for the places of uncertain points that `places` means.
class MotionSearch {
public:
  MotionSearch(const MotionsQuery& query, MeantPlaces places) : query_(query), places_(places) {}

  /// A pair that collides at an instant, decided exactly, collides on the motion, too. A motion without one at the
  /// instants that are tried needs its own search.
  bool collides(const RigidMotion& motion, Work& work)
  {
    if (witness_ && collideNearest(motion, *witness_, work)) return true;
    const Placed middle{query_.model, motion.at(0.5)};
    const double extent = extentAround(middle.pose, motion, query_.body);
    const double beyond = (query_.request.clearance + query_.request.swept + extent) * (1.0 + kFewDoubleRoundings);
    if (std::isfinite(beyond) && !find(middle, beyond, work)) return false;
    std::optional<PointPair> witness = find(middle, query_.request.clearance, work);
    if (!witness) witness = sweep(motion, work);
    if (witness) witness_ = witness;
    return witness.has_value();
  }

private:
  /// Whether a pair collides at the instant at which a straight line between the motion's ends brings it nearest.
  bool collideNearest(const RigidMotion& motion, const PointPair& pair, Work& work) const
  {
    const Point3 p = query_.scan.hierarchy().view().point(pair.a), q = query_.model.view().point(pair.b);
    const Eigen::Vector3d world = query_.scan.pose * Eigen::Vector3d(p[0], p[1], p[2]);
    const Eigen::Vector3d start = seen(motion.from(), world), way = seen(motion.to(), world) - start;
    const Approach approach = closestApproach({start[0] - q[0], start[1] - q[1], start[2] - q[2]},
                                              {way[0], way[1], way[2]}, std::numeric_limits<double>::infinity());
    const Placed model{query_.model, motion.at(approach.at)};
    return PointPairs(query_.scan, model, query_.request.clearance, places_).collide(pair, work);
  }

  std::optional<PointPair> find(const Placed& model, double clearance, Work& work) const
  {
    const AnyResult found = anyCollisionAt(query_.scan, model, {clearance}, places_);
    work += found.work;
    return found.pair;
  }

  /// Walks the motion as a swept path, up to the first witness. Returns a witness if and only if the path has one.
  std::optional<PointPair> sweep(const RigidMotion& motion, Work& work) const
  {
    const std::function<bool(double)> none;
    Progress own(none);
    TrajectoryResult counted;
    const std::vector<Eigen::Isometry3d> ends = {motion.from(), motion.to()};
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

  const MotionsQuery& query_;
  const MeantPlaces places_;
  std::optional<PointPair> witness_; ///< of the last that collided
};

/// Poses that motions name, in a list without the others.
struct SomePoses {
  std::size_t size() const { return indices.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const { return list[indices[i]]; }

  const PoseList& list;
  const std::vector<std::uint32_t>& indices;
};

} // namespace

BodyBall::BodyBall(const SphereHierarchy& body)
{
  const SphereHierarchy::Storage& storage = body.storage();
  const LocalFrame& frame = storage.frame;
  const Node& root = storage.top[0];
  center = Eigen::Vector3d(frame.origin[0], frame.origin[1], frame.origin[2]);
  double reach = 0.0;
  for (std::uint32_t i = 0; i < root.count; ++i) {
    const Eigen::Vector3d at(root.x[i], root.y[i], root.z[i]);
    reach = std::max(reach, at.norm() + static_cast<double>(root.r[i]));
  }
  radius = reach * frame.unit * (1.0 + 8 * kFewDoubleRoundings);
}

MotionsQuery::MotionsQuery(const Placed& scan_at, const SphereHierarchy& model_of, const MotionsRequest& asked)
: scan(scan_at),
  model(model_of),
  request(asked),
  body(model_of),
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

  const std::function<bool(double)> left = [&](double done) {
    return !request.progress || request.progress(kAtPoses + (1.0 - kAtPoses) * done);
  };
  Progress progress(left);
  const bool uncertain = areUncertain(scan, {model});
  result.work += forEachInBatches(motions.size(), request.threads, progress, [&] {
    return [&, possible = MotionSearch(query, possiblePlaces(scan, {model})),
            certain = MotionSearch(query, MeantPlaces::certain)](std::size_t m, Work& work) mutable {
      Verdict& flag = result.flags[m];
      if (flag == Verdict::colliding) return;
      const RigidMotion motion = motionBetween(poses[motions[m].from], poses[motions[m].to], request.pivot);
      if (flag == Verdict::free && possible.collides(motion, work))
        flag = uncertain ? Verdict::undecided : Verdict::colliding;
      if (flag == Verdict::undecided && certain.collides(motion, work)) flag = Verdict::colliding;
    };
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
