// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/obstacle_query.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/filters/parted_records.h>
#include <pcl_bsh/filters/surface_distances.h>
#include <pcl_bsh/surface/triangle_answers.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh {

ObstacleQuery& ObstacleQuery::operator=(const ObstacleQuery& other)
{
  return *this = ObstacleQuery(other); // moving allocates nothing
}

void ObstacleQuery::setInputUncertainty(const Uncertainty& uncertainty)
{
  checkUncertainty("input cloud", uncertainty);
  Uncertainty copy = uncertainty;
  input_uncertainty_ = std::move(copy);
}

const float* ObstacleQuery::obstacleSpacings()
{
  if (!density_guard_ || obstacle_.surface()) return nullptr;
  if (!(std::isfinite(widest_gap_) && widest_gap_ >= 0.0)) {
    throw InvalidInput(Input::density, "widest gap", plainText(widest_gap_), "give a finite length >= 0")
        .withValue(widest_gap_);
  }
  return obstacle_.spacings(widest_gap_, threads_).data();
}

TrajectoryResult ObstacleQuery::run(const PointsView& input, const SurfaceCover* surface, TrajectoryRequest& request)
{
  if (density_guard_) {
    throw InvalidInput(Input::density, "density guard", "knows flags at one pose, neither paths nor distances",
                       "call setPose(), or setDensityGuard(false)");
  }
  if (trajectory_ && trajectory_->empty()) {
    throw std::invalid_argument("trajectory has no pose: give one at least, or call setPose()");
  }
  const SphereHierarchy& obstacle = obstacle_.hierarchy(threads_);
  const SphereHierarchy hierarchy = hierarchyOf(input);

  request.clearance = clearance_;
  request.threads = threads_;
  request.accuracy = accuracy_;
  if (swept_ != 0.0) request.swept = swept_;
  request.progress = progress_;
  const std::vector<Eigen::Isometry3d> poses = trajectory_ ? *trajectory_ : std::vector{pose_};
  TrajectoryResult result = collideAlong({hierarchy}, obstacle, poses, request);
  warnOf(hierarchy, surface, obstacle, poses, clearance_);
  if (obstacle_.surface()) tellOfSurface(result);
  if (surface) result = ofTriangles(*surface, std::move(result));
  work_ = result.work;
  undecided_ = result.undecided;
  sparse_ = 0;
  return result;
}

TrajectoryResult ObstacleQuery::alongTrajectory(const PointsView& input, const SurfaceCover* surface)
{
  TrajectoryRequest request;
  request.distances = request.first_poses = request.closest_poses = true;
  request.pose_summaries = swept_ == 0.0;
  return run(input, surface, request);
}

std::vector<std::uint8_t> ObstacleQuery::collisionFlags(const PointsView& input, const SurfaceCover* surface)
{
  if (trajectory_) {
    TrajectoryRequest request;
    return run(input, surface, request).flags;
  }
  const SphereHierarchy& obstacle = obstacle_.hierarchy(threads_);
  const SphereHierarchy hierarchy = hierarchyOf(input);

  FlagsRequest request;
  request.clearance = clearance_;
  request.flagged = Side::a;
  request.threads = threads_;
  request.accuracy = accuracy_;
  if (surface && density_guard_) {
    throw InvalidInput(Input::density, "density guard", "is about points, and the input is a surface",
                       "call setDensityGuard(false)");
  }
  request.spacings_of_b = obstacleSpacings();
  FlagsResult result = pcl_bsh::collisionFlags({hierarchy}, {obstacle, pose_}, request);
  warnOf(hierarchy, surface, obstacle, {pose_}, clearance_);
  work_ = result.work;
  undecided_ = result.undecided_a + result.sparse_a;
  sparse_ = result.sparse_a;
  if (!surface) return std::move(result.a);
  std::vector<std::uint8_t> flags = triangleVerdicts(*surface, result.a);
  undecided_ = static_cast<std::size_t>(std::count(flags.begin(), flags.end(), flagOf(Verdict::undecided)));
  return flags;
}

void ObstacleQuery::select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed)
{
  const std::vector<std::uint8_t> collides = collisionFlags(input);
  const auto keeps = [&](std::uint32_t record) {
    const bool flagged = collides[record] != 0;
    return negative ? flagged : !flagged && isFinite(input.point(record));
  };
  partRecords(input, keeps, kept, removed);
}

} // namespace pcl_bsh
