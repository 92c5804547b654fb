// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/obstacle_query.h>

#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/geometry/plain_text.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <pcl/console/print.h>

#include <cmath>
#include <cstring>
#include <utility>

namespace pcl_bsh {
namespace {

/// One step of a checksum: for each word a bijection of the sum, so that no change of one word goes unnoticed.
std::uint64_t mixed(std::uint64_t sum, std::uint64_t word)
{
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15; // odd
  sum = (sum ^ word) * golden;
  return sum ^ sum >> 32; // products carry upward only: a sign that flips twice would cancel out
}

template <typename Bits>
std::uint64_t checksumOf(const PointsView& view)
{
  std::uint64_t sum = view.count;
  const auto [x, y, z] = view.offset;
  const auto* record = static_cast<const unsigned char*>(view.data);
  for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
    const auto bits = [record](std::size_t offset) {
      Bits word;
      std::memcpy(&word, record + offset, sizeof word);
      return std::uint64_t{word};
    };
    if constexpr (sizeof(Bits) == 4) {
      sum = mixed(sum, bits(y) << 32 | bits(x));
    }
    else {
      sum = mixed(mixed(sum, bits(x)), bits(y));
    }
    sum = mixed(sum, bits(z));
  }
  return sum;
}

/// Of all coordinates, their order and the points' own uncertainties. Bytes between them may change.
std::uint64_t checksumOf(const PointsView& view)
{
  std::uint64_t sum =
      view.scalar == Scalar::float32 ? checksumOf<std::uint32_t>(view) : checksumOf<std::uint64_t>(view);
  for (std::size_t i = 0; view.uncertainties && i < view.count; ++i) {
    std::uint32_t word;
    std::memcpy(&word, view.uncertainties + i, sizeof word);
    sum = mixed(sum, word);
  }
  return sum;
}

} // namespace

ObstacleQuery& ObstacleQuery::operator=(const ObstacleQuery& other)
{
  return *this = ObstacleQuery(other); // moving allocates nothing
}

void ObstacleQuery::setObstacle(std::function<PointsView()> view, Fields fields)
{
  view(); // a cloud that cannot be read is refused here, not at the first use
  obstacle_ = std::move(view);
  obstacle_fields_ = std::move(fields);
  hierarchy_.reset();
  spacings_.reset();
}

void ObstacleQuery::setInputUncertainty(const Uncertainty& uncertainty)
{
  checkUncertainty("input cloud", uncertainty);
  Uncertainty copy = uncertainty;
  input_uncertainty_ = std::move(copy);
}

void ObstacleQuery::setObstacleUncertainty(const Uncertainty& uncertainty)
{
  checkUncertainty("obstacle cloud", uncertainty);
  Uncertainty copy = uncertainty;
  obstacle_uncertainty_ = std::move(copy);
  hierarchy_.reset(); // it holds its points' uncertainties
}

void ObstacleQuery::setWidestGap(double widest_gap)
{
  widest_gap_ = widest_gap;
  spacings_.reset();
}

const float* ObstacleQuery::obstacleSpacings(const SphereHierarchy& obstacle)
{
  if (!density_guard_) return nullptr;
  if (!(std::isfinite(widest_gap_) && widest_gap_ >= 0.0)) {
    throw InvalidInput(Input::density, "widest gap", plainText(widest_gap_), "give a finite length >= 0")
        .withValue(widest_gap_);
  }
  if (!spacings_) {
    const double gap = widest_gap_ > 0.0 ? widest_gap_ : usualGap(obstacle);
    spacings_ = std::make_shared<std::vector<float>>(gap > 0.0 ? patchSpacings(obstacle, gap, threads_)
                                                               : std::vector<float>(obstacle.view().count));
  }
  return spacings_->data();
}

PointsView ObstacleQuery::obstacleView() const
{
  const auto fields = obstacle_uncertainty_.field.empty() ? std::vector<pcl::PCLPointField>() : obstacle_fields_();
  return withUncertainty(obstacle_(), fields, "obstacle cloud", obstacle_uncertainty_);
}

const SphereHierarchy& ObstacleQuery::obstacleHierarchy()
{
  if (!obstacle_) throw std::invalid_argument("obstacle cloud is missing: call setObstacleCloud() before filtering");
  const PointsView view = obstacleView();
  const std::uint64_t checksum = checksumOf(view);
  if (!hierarchy_) {
    HierarchyOptions options;
    options.threads = threads_;
    hierarchy_ = std::make_shared<SphereHierarchy>(view, options);
    checksum_ = checksum;
  }
  // The hierarchy points into the cloud's memory, and its spheres hold the points as they were.
  if (hierarchy_->view().data != view.data || hierarchy_->view().count != view.count || checksum_ != checksum) {
    throw std::invalid_argument("obstacle cloud has changed since setObstacleCloud(): call it again");
  }
  return *hierarchy_;
}

void ObstacleQuery::warnOfCoarse(const char* cloud, const SphereHierarchy& hierarchy)
{
  const double spacing = hierarchy.coordinateSpacing();
  if (warned_ || !(clearance_ > 0.0) || spacing <= clearance_ / 10) return;
  warned_ = true;
  PCL_WARN("[pcl_bsh::CollisionFilter] the %s cloud's float32 coordinates lie %g apart, coarse for a clearance of %g: "
           "give float64 coordinates (pcl::PCLPointCloud2), or ones near the origin.\n",
           cloud, spacing, clearance_);
}

TrajectoryResult ObstacleQuery::run(const PointsView& input, TrajectoryRequest& request)
{
  if (density_guard_) {
    throw InvalidInput(Input::density, "density guard", "knows flags at one pose, neither paths nor distances",
                       "call setPose(), or setDensityGuard(false)");
  }
  if (trajectory_ && trajectory_->empty()) {
    throw std::invalid_argument("trajectory has no pose: give one at least, or call setPose()");
  }
  const SphereHierarchy& obstacle = obstacleHierarchy();
  HierarchyOptions options;
  options.threads = threads_;
  const SphereHierarchy hierarchy(input, options);

  warnOfCoarse("input", hierarchy);
  warnOfCoarse("obstacle", obstacle);

  request.clearance = clearance_;
  request.threads = threads_;
  request.accuracy = accuracy_;
  if (swept_ != 0.0) request.swept = swept_;
  request.progress = progress_;
  TrajectoryResult result =
      collideAlong({hierarchy}, obstacle, trajectory_ ? *trajectory_ : std::vector{pose_}, request);
  work_ = result.work;
  undecided_ = result.undecided;
  sparse_ = 0;
  return result;
}

TrajectoryResult ObstacleQuery::alongTrajectory(const PointsView& input)
{
  TrajectoryRequest request;
  request.distances = request.first_poses = request.closest_poses = true;
  request.pose_summaries = swept_ == 0.0;
  return run(input, request);
}

std::vector<std::uint8_t> ObstacleQuery::collisionFlags(const PointsView& input)
{
  if (trajectory_) {
    TrajectoryRequest request;
    return run(input, request).flags;
  }
  const SphereHierarchy& obstacle = obstacleHierarchy();
  HierarchyOptions options;
  options.threads = threads_;
  const SphereHierarchy hierarchy(input, options);

  warnOfCoarse("input", hierarchy);
  warnOfCoarse("obstacle", obstacle);

  FlagsRequest request;
  request.clearance = clearance_;
  request.flagged = Side::a;
  request.threads = threads_;
  request.accuracy = accuracy_;
  request.spacings_of_b = obstacleSpacings(obstacle);
  FlagsResult result = pcl_bsh::collisionFlags({hierarchy}, {obstacle, pose_}, request);
  work_ = result.work;
  undecided_ = result.undecided_a + result.sparse_a;
  sparse_ = result.sparse_a;
  return std::move(result.a);
}

void ObstacleQuery::select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed)
{
  const std::vector<std::uint8_t> collides = collisionFlags(input);
  // `kept` may be the very list the input is seen through: it is replaced only at the end.
  pcl::Indices keep;
  pcl::Indices remove;
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::uint32_t record = input.record(i);
    const bool flagged = collides[record] != 0;
    const bool wanted = negative ? flagged : !flagged && isFinite(input.point(record));
    if (wanted)
      keep.push_back(static_cast<pcl::index_t>(record));
    else if (removed)
      remove.push_back(static_cast<pcl::index_t>(record));
  }
  kept = std::move(keep);
  if (removed) *removed = std::move(remove);
}

} // namespace pcl_bsh
