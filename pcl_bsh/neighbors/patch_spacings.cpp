// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbor_scratch.h>
#include <pcl_bsh/neighbors/patch_spacings.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

using Place = Eigen::Vector2d;

/// The region nearer to a point than to its neighbours: its Voronoi cell, within a square about it.
class Cell {
public:
  void begin(double half_edge)
  {
    corners_ = {{-half_edge, -half_edge}, {half_edge, -half_edge}, {half_edge, half_edge}, {-half_edge, half_edge}};
    measure();
  }

  /// Cuts off what is nearer to the neighbour.
  void cut(const Place& neighbor)
  {
    const double squared = neighbor.squaredNorm();
    if (!(squared > 0.0) || squared >= 4 * farthest_) return; // at the point itself, or too far off to cut
    const auto beyond = [&](const Place& corner) { return corner.dot(neighbor) - 0.5 * squared; };
    kept_.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Place &from = corners_[i], &to = corners_[(i + 1) % corners_.size()];
      const double at_from = beyond(from), at_to = beyond(to);
      if (at_from <= 0.0) kept_.push_back(from);
      if ((at_from < 0.0 && at_to > 0.0) || (at_from > 0.0 && at_to < 0.0))
        kept_.push_back(from + (to - from) * (at_from / (at_from - at_to)));
    }
    corners_.swap(kept_);
    measure();
  }

  /// Twice the distance of the farthest corner.
  double width() const { return 2 * std::sqrt(farthest_); }

  /// Width of the widest circle at a corner that is no wider than `widest`; 0 for none.
  double widthWithin(double widest) const
  {
    double largest = 0.0;
    for (const Place& corner : corners_)
      if (const double width = 2 * corner.norm(); width <= widest) largest = std::max(largest, width);
    return largest;
  }

private:
  void measure()
  {
    farthest_ = 0.0;
    for (const Place& corner : corners_) farthest_ = std::max(farthest_, corner.squaredNorm());
  }

  std::vector<Place> corners_, kept_;
  double farthest_ = 0.0; ///< squared
};

/// The spacings of one thread's points.
class PatchSpacing {
public:
  PatchSpacing(const SphereHierarchy& cloud, double widest_gap) : cloud_(cloud), widest_gap_(widest_gap) {}

  double at(std::uint32_t record)
  {
    const Point3 place = cloud_.view().point(record);
    const double half_edge = std::isfinite(widest_gap_) ? widest_gap_ : 0x1p500;
    for (std::size_t k = 16;; k *= 4) {
      nearestKSearch(cloud_, place, k, found_);
      turnIntoPlane(place);
      cell_.begin(half_edge);
      for (const Place& neighbor : neighbors_) cell_.cut(neighbor);
      const double reach = neighbors_.empty() ? 0.0 : neighbors_.back().norm();
      if (found_.indices.size() < k || reach >= widest_gap_ || reach >= cell_.width())
        return cell_.widthWithin(widest_gap_);
    }
  }

private:
  void turnIntoPlane(const Point3& place)
  {
    away_.clear();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::int32_t index : found_.indices) {
      const Point3 p = cloud_.view().point(static_cast<std::uint32_t>(index));
      away_.emplace_back(p[0] - place[0], p[1] - place[1], p[2] - place[2]);
      middle += away_.back();
    }
    middle /= static_cast<double>(away_.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : away_) spread += (p - middle) * (p - middle).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    const Eigen::Matrix<double, 2, 3> plane = axes.eigenvectors().rightCols<2>().transpose();
    neighbors_.clear();
    for (const Eigen::Vector3d& p : away_) {
      const Place flat = plane * p;
      const double length = flat.norm();
      if (length > 0.0) neighbors_.push_back(flat * (p.norm() / length));
    }
  }

  const SphereHierarchy& cloud_;
  const double widest_gap_;
  Neighbors found_;
  std::vector<Eigen::Vector3d> away_;
  std::vector<Place> neighbors_; ///< by ascending distance
  Cell cell_;
};

} // namespace

double usualGap(const SphereHierarchy& cloud)
{
  return 8 * spacingOf(cloud).median;
}

std::vector<float> patchSpacings(const SphereHierarchy& cloud, double widest_gap, const Effort& effort)
{
  checkOfPoints(cloud.view());
  if (!(widest_gap > 0.0))
    throw InvalidInput(Input::density, "widest gap", plainText(widest_gap), "give a length > 0").withValue(widest_gap);
  checkExact(effort);
  const DefaultFloatEnvironment environment;
  Progress progress(effort.progress);
  const PointsView& view = cloud.view();
  std::vector<float> spacings(view.count, 0.0f);
  constexpr std::size_t block = 1024;
  const std::size_t blocks = (view.size() + block - 1) / block;
  progress.begin(1.0, blocks);
  parallelFor(blocks, threadCount(effort.threads), [&](std::size_t number) {
    if (progress.stopped()) return;
    const DefaultFloatEnvironment of_thread;
    PatchSpacing spacing(cloud, widest_gap);
    const std::size_t end = std::min(view.size(), (number + 1) * block);
    for (std::size_t i = number * block; i < end; ++i) {
      const std::uint32_t record = view.record(i);
      if (isFinite(view.point(record))) spacings[record] = roundUp(spacing.at(record));
    }
    progress.step();
  });
  progress.end();
  return spacings;
}

} // namespace pcl_bsh
