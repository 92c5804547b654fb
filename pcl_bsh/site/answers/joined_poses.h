// SPDX-License-Identifier: BSD-3-Clause
// Summaries of poses of several models that move together: a point of the scan that meets two of them counts once.
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace pcl_bsh::site {

class JoinedPoses {
public:
  /// All are borrowed.
  JoinedPoses(const SphereHierarchy& scan, const std::vector<Eigen::Isometry3d>& poses,
              const TrajectoryRequest& request);

  /// Adds the summaries of the next model.
  void add(const std::vector<PoseSummary>& of_model);

  /// Returns the summaries of all models together. At poses at which several models meet points, flags are computed
  /// once more, and joined.
  /// @param model_of the points of a model, by its number among those added; asked for once for many poses
  std::vector<PoseSummary> joined(const std::function<SphereHierarchy(std::size_t)>& model_of);

private:
  std::vector<std::size_t> sharedPoses() const;
  void count(const std::vector<std::size_t>& poses, const std::function<SphereHierarchy(std::size_t)>& model_of);

  const SphereHierarchy& scan_;
  const std::vector<Eigen::Isometry3d>& poses_;
  const TrajectoryRequest& request_;
  std::vector<PoseSummary> sum_;
  std::vector<std::vector<bool>> meets_; ///< of each model, whether it meets points at each pose
};

} // namespace pcl_bsh::site
