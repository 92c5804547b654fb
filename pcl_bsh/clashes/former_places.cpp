// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/former_places.h>
#include <pcl_bsh/clashes/near_boxes.h>
#include <pcl_bsh/geometry/ball_about_box.h>
#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh {
namespace {

std::vector<Clash*> resolvedOf(std::vector<Clash>& clashes)
{
  std::vector<Clash*> resolved;
  for (Clash& clash : clashes)
    if (clash.status == ClashStatus::resolved) resolved.push_back(&clash);
  return resolved;
}

std::vector<Extent> boxesOf(const std::vector<Clash*>& clashes)
{
  std::vector<Extent> boxes;
  for (const Clash* clash : clashes) boxes.push_back({clash->low, clash->high});
  return boxes;
}

double reachOf(const std::vector<Clash*>& clashes, double clearance, double cluster_distance)
{
  double reach = clearance;
  for (const Clash* clash : clashes) reach = std::max(reach, clash->distance);
  return reach + cluster_distance;
}

} // namespace

struct FormerPlaces::Impl {
  Impl(std::vector<Clash>& of, double clearance, double cluster_distance)
  : clashes(resolvedOf(of)),
    reach(reachOf(clashes, clearance, cluster_distance)),
    not_scanned(boxesOf(clashes)),
    not_unseen(not_scanned),
    is_visited(clashes.size(), false),
    is_scanned(clashes.size(), false),
    is_unseen(clashes.size(), false)
  {
  }

  template <typename Near>
  void findNear(const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                const TrajectoryRequest& motion, const Near& near) const;

  std::vector<Clash*> clashes;
  double reach;
  mutable NearBoxes not_scanned, not_unseen;
  std::vector<bool> is_visited, is_scanned, is_unseen;
};

FormerPlaces::FormerPlaces(std::vector<Clash>& clashes, double clearance, double cluster_distance)
: impl_(std::make_unique<Impl>(clashes, clearance, cluster_distance))
{
}

FormerPlaces::~FormerPlaces() = default;

bool FormerPlaces::empty() const
{
  return impl_->clashes.empty();
}

/// Calls near(i) for each place that is not visited yet and that the model comes near to.
template <typename Near>
void FormerPlaces::Impl::findNear(const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                                  const TrajectoryRequest& motion, const Near& near) const
{
  std::vector<std::size_t> left;
  std::vector<Point3> at;
  for (std::size_t i = 0; i < clashes.size(); ++i) {
    if (is_visited[i]) continue;
    left.push_back(i);
    at.push_back(clashes[i]->place);
  }
  if (left.empty()) return;
  TrajectoryRequest request;
  request.clearance = reach;
  request.swept = motion.swept;
  request.pivot = motion.pivot;
  request.threads = motion.threads;
  const SphereHierarchy points(viewOf(at.front().data(), at.size()));
  const TrajectoryResult found = collideAlong({points}, model, poses, request);
  for (std::size_t i = 0; i < left.size(); ++i)
    if (found.flags[i] != Verdict::free) near(left[i]);
}

void FormerPlaces::visit(const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                         const TrajectoryRequest& motion)
{
  impl_->findNear(model, poses, motion, [&](std::size_t i) { impl_->is_visited[i] = true; });
}

bool FormerPlaces::mayVisit(const Extent& box, const std::vector<Eigen::Isometry3d>& poses,
                            const TrajectoryRequest& motion) const
{
  const BoxBall about = ballAboutBox(box.low, box.high); // the query has balls and no boxes
  const float radius = roundUp(about.radius);
  PointsView ball = viewOf(about.center.data(), 1);
  ball.radii = &radius;
  bool may = false;
  impl_->findNear(SphereHierarchy(ball), poses, motion, [&](std::size_t) { may = true; });
  return may;
}

void FormerPlaces::scan(const PointsView& points)
{
  for (std::size_t i = 0; i < points.size() && impl_->not_scanned.left() > 0; ++i) {
    const std::uint32_t record = points.record(i);
    if (!isFinite(points.point(record))) continue;
    impl_->not_scanned.visitNear(extentOf(points, record), impl_->reach, [&](std::size_t place) {
      impl_->is_scanned[place] = true;
      return true;
    });
  }
}

void FormerPlaces::unsee(const Extent& box)
{
  if (impl_->not_unseen.left() == 0) return;
  impl_->not_unseen.visitNear(box, impl_->reach, [&](std::size_t place) {
    impl_->is_unseen[place] = true;
    return true;
  });
}

bool FormerPlaces::mayScan(const Extent& box) const
{
  bool near = false;
  impl_->not_scanned.visitNear(box, impl_->reach, [&](std::size_t) {
    near = true;
    return false;
  });
  return near;
}

void FormerPlaces::judge()
{
  for (std::size_t i = 0; i < impl_->clashes.size(); ++i) {
    if (!impl_->is_visited[i])
      impl_->clashes[i]->status = ClashStatus::not_visited;
    else if (impl_->is_unseen[i])
      impl_->clashes[i]->status = ClashStatus::unseen;
    else if (!impl_->is_scanned[i])
      impl_->clashes[i]->status = ClashStatus::not_scanned;
  }
}

} // namespace pcl_bsh
