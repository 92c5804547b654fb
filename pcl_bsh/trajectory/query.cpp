// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/query.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_bsh {
namespace {

// Bounds the rounding of places seen by the model, relative to all coordinates that go into one. `carried` rounds a
// place by 2 v per axis, and `see` sums three products of differences, 5 v. On three axes, for two clouds, this is less
// than 64 v.
constexpr double kPlacing = 64 * kDoubleUnit;
constexpr double kLargest = 0x1p100; ///< floats beyond may overflow when they are divided by a motion

/// The share of the tolerance for the bow of a motion taken as straight, three eighths. An eighth is for rounding. Half
/// is the margin that the reported clearance has.
constexpr double kStrayShare = 0.375;

double farthest(const BoxTree& boxes, const Point3& from)
{
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = from[axis] - boxes.origin[axis];
    const double distance = std::max(std::abs(boxes.low[axis] - at), std::abs(boxes.high[axis] - at));
    squared += distance * distance;
  }
  return std::sqrt(squared) * (1.0 + kDoubleMargin);
}

PosePath pathOf(const Placed& scan, const std::vector<Eigen::Isometry3d>& poses, const TrajectoryRequest& request,
                const BoxTree& boxes, double reach, Progress& progress)
{
  if (!request.swept) return PosePath(scan.pose, poses, boxes.origin, progress);
  double far = 0.0;
  for (const Eigen::Isometry3d& pose : poses) far = std::max(far, farthestPlace(pose, boxes, request.pivot));
  checkTolerance(scan, request, boxes, reach, far);
  return PosePath(scan.pose, poses, boxes.origin, sweepOf(request, boxes, reach), progress);
}

} // namespace

double farthestPlace(const Eigen::Isometry3d& pose, const BoxTree& boxes, const Point3& pivot)
{
  double far = 0.0;
  for (const Point3& center : {carried(pose, boxes.origin), carried(pose, pivot)})
    for (const double x : center) far = std::max(far, std::abs(x));
  return far;
}

void checkTolerance(const Placed& scan, const TrajectoryRequest& request, const BoxTree& boxes, double reach,
                    double far)
{
  double size = 4 * boxes.radius + reach + 2 * scan.hierarchy().storage().largest_radius;
  const LocalFrame& frame = scan.hierarchy().storage().frame;
  const Point3 origin = carried(scan.pose, frame.origin);
  for (std::size_t axis = 0; axis < 3; ++axis)
    size += std::abs(origin[axis]) + 2 * frame.reach[axis] * frame.unit + std::abs(boxes.origin[axis]) +
            std::abs(request.pivot[axis]);
  size += 3 * far;
  constexpr double smallest = 0x1p-400; // its square is far from underflow
  constexpr double rounding = 0x1p-46;  // of places along the motion; a sixteenth of the tolerance is for it
  const double least = std::max(16 * rounding * size, smallest);
  if (!(size < 0x1p100))
    throw InvalidInput(Input::swept, "swept motion", plainText("coordinates as large as ", size),
                       plainText("give the clouds in a larger unit, less than ", 0x1p100))
        .withValue(size);
  if (*request.swept >= least) return;
  throw InvalidInput(Input::swept, "swept", plainText(*request.swept, ": too small for coordinates as large as ", size),
                     plainText("give at least ", least))
      .withValue(*request.swept);
}

double reachOf(const TrajectoryRequest& request, const Reach& between)
{
  return std::max(0.0, between.most) + request.swept.value_or(0.0) / 2;
}

PosePath::Sweep sweepOf(const TrajectoryRequest& request, const BoxTree& boxes, double reach)
{
  const double tolerance = *request.swept;
  return {request.pivot,     farthest(boxes, request.pivot), boxes.radius,
          reach + tolerance, kStrayShare * tolerance,        tolerance / 64};
}

Travel travelOf(const std::vector<Eigen::Isometry3d>& poses, const Point3& center)
{
  Travel travel;
  const Eigen::Vector3d at(center[0], center[1], center[2]);
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const Eigen::Matrix3d turn = poses[k + 1].linear() - poses[k].linear();
    const Eigen::Vector3d step =
        poses[k].linear().transpose() * (turn * at + poses[k + 1].translation() - poses[k].translation());
    for (std::size_t axis = 0; axis < 3; ++axis) travel.way[axis] += std::abs(step[static_cast<Eigen::Index>(axis)]);
    travel.turned += turn.norm() / std::sqrt(2.0); // of small angles
  }
  return travel;
}

TrajectoryQuery::TrajectoryQuery(const Placed& scan_at, const SphereHierarchy& model_of, const BoxTree& model_boxes,
                                 const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& asked,
                                 TrajectoryResult& into, Progress& progress, MeantPlaces where, Wanted what)
: scan(scan_at),
  model(model_of),
  given(model_poses),
  request(asked),
  result(into),
  boxes(model_boxes),
  between(asked.clearance, scan_at.hierarchy().storage().uncertainty, model_of.storage().uncertainty, where),
  of_pairs(scan_at.hierarchy().view(), model_of.view(), asked.clearance, where),
  of_points(arePoints(scan_at.hierarchy().view()) && arePoints(model_of.view())),
  reach(reachOf(asked, between)),
  path(pathOf(scan_at, model_poses, asked, boxes, reach, progress)),
  certain(where == MeantPlaces::certain),
  witness(what == Wanted::witness),
  closest(asked.distances || asked.closest_poses),
  first(asked.first_poses || asked.swept.has_value())
{
}

double TrajectoryQuery::nearEnough(PointPair pair) const
{
  const RecordDistance::Sum terms = of_pairs.of(pair);
  if (of_pairs.areMeasured()) return reach + (terms[1] + terms[2]);
  const double within = std::accumulate(terms.begin(), terms.end(), 0.0);
  return within < 0.0 ? within : within + *request.swept / 2;
}

double TrajectoryQuery::error(const Point3& origin) const
{
  const double size = std::abs(origin[0]) + std::abs(origin[1]) + std::abs(origin[2]) + 3 * path.far + boxes.radius;
  const double ball = scan.hierarchy().storage().largest_radius;
  return kPlacing * (size + 3 * ball) + path.skew * (boxes.radius + reach + 2 * ball);
}

bool TrajectoryQuery::inFloatRange() const
{
  const LocalFrame& frame = scan.hierarchy().storage().frame;
  double largest = std::max({path.far, boxes.radius, reach, scan.hierarchy().storage().largest_radius});
  const Point3 center = carried(scan.pose, frame.origin);
  for (std::size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(center[axis]), frame.reach[axis] * frame.unit});
  return largest < kLargest;
}

} // namespace pcl_bsh
