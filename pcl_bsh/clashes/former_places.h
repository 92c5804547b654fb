// SPDX-License-Identifier: BSD-3-Clause
// Clashes that were there and are not found any more: did the run look there, or are they only out of its sight?
//
//   compareWithEarlier(clashes, earlier, cluster_distance);
//   FormerPlaces former(clashes, clearance, cluster_distance);
//   former.visit(wagon, poses, request);
//   former.scan(tunnel.view());
//   former.judge(); // some that were called resolved are not_visited or not_scanned
//
// The reach is the greatest of the clearance and the distances of these clashes, plus the cluster distance. A place was
// visited if the model comes within the reach of the point that was the clash's nearest, at a pose or during swept
// motion. It was scanned if a finite point of the scan lies within the reach, along each axis, of the clash's box. A
// wall that is removed with all that is near it leaves no points either: of such a place the scan says nothing, and
// not_scanned is the honest answer. It is unseen if something of the model is in shadow, at
// a pose, within the reach of the box; where beams passed, though not by the margin, the run looked.
#pragma once

#include <pcl_bsh/clashes/clashes.h>

#include <memory>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Scan and model may be told in parts.
class FormerPlaces {
public:
  /// Judges the resolved clashes. @param clashes kept by reference
  FormerPlaces(std::vector<Clash>& clashes, double clearance, double cluster_distance);
  ~FormerPlaces();
  FormerPlaces(const FormerPlaces&) = delete;
  FormerPlaces& operator=(const FormerPlaces&) = delete;

  bool empty() const; ///< nothing is resolved: nothing need be told

  /// The model moved along these poses, in the frame of the clashes. @param motion its swept, pivot and threads count
  /// @throws as collideAlong()
  void visit(const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
             const TrajectoryRequest& motion);

  /// The scan has these points.
  void scan(const PointsView& points);

  /// Something of the model was in shadow in this box.
  void unsee(const Extent& box);

  /// Whether visit() of points within this box may tell anything.
  bool mayVisit(const Extent& box, const std::vector<Eigen::Isometry3d>& poses, const TrajectoryRequest& motion) const;

  /// Whether scan() of points within this box may tell anything.
  bool mayScan(const Extent& box) const;

  /// Sets the status of each resolved clash that was not visited, or else is unseen, or else was not scanned.
  void judge();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
