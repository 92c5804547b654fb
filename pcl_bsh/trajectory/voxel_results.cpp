// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/voxel_results.h>

#include <pcl_bsh/simd/bits.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

/// Calls visit() for the leaves' points whose bits are set, with the range of places in the voxel that share the
/// point's result: more than one where points coincide.
template <class NodeVisit>
void eachPoint(const Voxel& voxel, const std::vector<std::uint16_t>& bits_of, const NodeVisit& visit)
{
  for (std::uint32_t n = 0; n < voxel.nodes.size(); ++n) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) continue;
      for (const std::uint32_t bit : Bits(bits_of[n * kNodeChildren + lane])) {
        const std::uint32_t i = node.begin[lane] + bit;
        visit(i, node.isCoincident(lane) ? node.begin[lane + 1] : i + 1);
      }
    }
  }
}

} // namespace

void VoxelResults::begin(const Voxel& voxel)
{
  hit.assign(voxel.nodes.size() * kNodeChildren, 0);
  settled.assign(voxel.nodes.size() * kNodeChildren, 0);
  undecided.assign(voxel.nodes.size() * kNodeChildren, 0);
  if (query_.first && !query_.witness) first.assign(voxel.count, std::numeric_limits<double>::infinity());
  if (query_.closest) best.assign(voxel.count, NearestPoint{});
}

void VoxelResults::beginPoses(std::uint32_t first_pose, std::uint32_t last_pose)
{
  first_pose_ = first_pose;
  nearest_at_pose_.resize(last_pose + 1 - first_pose);
  pose_bounds_.assign(nearest_at_pose_.size(), PoseBound{});
  pose_counts_.assign(nearest_at_pose_.size(), 0);
}

void VoxelResults::finish(const Voxel& voxel)
{
  const TrajectoryRequest& request = query_.request;
  TrajectoryResult& result = query_.result;
  std::size_t colliding = 0;
  double first_contact = std::numeric_limits<double>::infinity();
  eachPoint(voxel, hit, [&](std::uint32_t i, std::uint32_t end) {
    float distance = 0.0f;
    if (query_.first) first_contact = std::min(first_contact, first[i]);
    if (request.distances) distance = distanceOf(voxel.records()[i], best[i]);
    for (std::uint32_t p = i; p < end; ++p) {
      const std::uint32_t record = voxel.records()[p];
      ++colliding;
      if (request.flags) result.flags[record] = Verdict::colliding;
      if (request.first_poses) result.first_pose[record] = givenPose(first[i]);
      if (request.distances) result.distance[record] = distance;
      if (request.closest_poses) result.closest_pose[record] = givenPose(best[i].time);
      if (query_.closest) result.closest_point[record] = best[i].record;
    }
  });
  const std::lock_guard<std::mutex> lock(query_.mutex);
  result.colliding += colliding;
  query_.earliest = std::min(query_.earliest, first_contact);
  if (request.pose_summaries) mergePoses();
}

bool VoxelResults::decide(const Voxel& voxel, bool unsure)
{
  const auto mark = [this](std::uint32_t begin, std::uint32_t end, Verdict verdict) {
    std::fill(verdicts_.begin() + begin, verdicts_.begin() + end, verdict);
  };
  verdicts_.assign(voxel.count, unsure ? Verdict::undecided : Verdict::free);
  for (std::uint32_t n = 0; n < voxel.nodes.size(); ++n) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t lane = 0; lane < node.count; ++lane)
      if (!node.isLeaf(lane) && undecided[n * kNodeChildren + lane] != 0)
        mark(node.begin[lane], node.begin[lane + 1], Verdict::undecided);
  }
  eachPoint(voxel, undecided, [&](std::uint32_t begin, std::uint32_t end) { mark(begin, end, Verdict::undecided); });
  eachPoint(voxel, hit, [&](std::uint32_t begin, std::uint32_t end) { mark(begin, end, Verdict::colliding); });

  bool left = false;
  for (std::uint32_t p = 0; p < voxel.count; ++p) {
    Verdict& flag = query_.result.flags[voxel.records()[p]];
    if (flag != Verdict::undecided) continue; // as an earlier pass found
    flag = verdicts_[p];
    left = left || verdicts_[p] == Verdict::undecided;
  }
  return left;
}

void VoxelResults::mergePoses() const
{
  for (std::size_t i = 0; i < pose_counts_.size(); ++i) {
    const auto k = first_pose_ + static_cast<std::uint32_t>(i);
    query_.pose_counts[k] += pose_counts_[i];
    NearestAtPose& nearest = query_.nearest_at_pose[k];
    if (nearest_at_pose_[i].found &&
        (!nearest.found || exactAt(k).compareGaps(nearest_at_pose_[i].pair, nearest.pair) < 0))
      nearest = nearest_at_pose_[i];
  }
}

RecordDistance VoxelResults::exactAt(std::uint32_t k) const
{
  return {query_.scan.hierarchy().view(), query_.scan.pose, query_.model.view(), query_.poseAt(k)};
}

bool VoxelResults::collide(PointPair at, std::uint32_t k)
{
  ++work.exact_decisions;
  return query_.of_pairs.holds(exactAt(k), at);
}

bool VoxelResults::meet(PointPair pair, std::uint32_t k)
{
  ++work.exact_decisions;
  return exactAt(k).compare(pair, 0.0) <= 0;
}

void VoxelResults::consider(NearestPoint& nearest, PointPair pair, std::uint32_t k)
{
  ++work.exact_decisions;
  const int order =
      nearest.record == kNothing
          ? -1
          : exactAt(k).compareGaps(pair, exactAt(static_cast<std::uint32_t>(nearest.time)), {pair.a, nearest.record});
  take(nearest, pair, k, order);
}

void VoxelResults::considerPose(PointPair pair, std::uint32_t k)
{
  NearestAtPose& nearest = nearest_at_pose_[k - first_pose_];
  ++work.exact_decisions;
  if (nearest.found && exactAt(k).compareGaps(pair, nearest.pair) >= 0) return;
  nearest = {pair, true};
}

void VoxelResults::lowerPoseLimit(std::uint32_t k, float limit, float reach)
{
  PoseBound& bound = pose_bounds_[k - first_pose_];
  bound.limit = std::min(bound.limit, limit);
  bound.reach = std::min(bound.reach, reach);
}

std::int32_t VoxelResults::givenPose(double time) const
{
  return static_cast<std::int32_t>(query_.path.poses[static_cast<std::size_t>(time)].given);
}

float VoxelResults::distanceOf(std::uint32_t record, const NearestPoint& nearest) const
{
  if (query_.path.is_swept) return roundToFloat(nearest.gap);
  const RecordDistance distance = exactAt(static_cast<std::uint32_t>(nearest.time));
  const RecordDistance::Pair pair = distance.pair({record, nearest.record});
  if (distance.ofTriangles() && pair.radius_p == 0.0 && pair.radius_q == 0.0) { // doubles mostly know the float
    const RecordDistance::Enclosure at = distance.enclose(pair);
    if (const float high = roundToFloat(at.high); high == roundToFloat(at.low)) return high;
  }
  return roundToFloat(distance.gap(pair));
}

} // namespace pcl_bsh
