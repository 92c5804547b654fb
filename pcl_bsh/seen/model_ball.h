// SPDX-License-Identifier: BSD-3-Clause
// The ball about a point of the model, where the model is placed among the scans.
#pragma once

#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/seen/ball_view.h>
#include <pcl_bsh/seen/unseen_points.h>

#include <Eigen/Geometry>

#include <cstddef>

namespace pcl_bsh {

/// A place of the model, in the frame of the scans, and the magnitude of the terms that it was summed from.
struct PosedPlace {
  PosedPlace(const Eigen::Isometry3d& pose, const Point3& place)
  {
    const Eigen::Vector3d p(place.data());
    at = pose * p;
    magnitude = (pose.linear().cwiseAbs() * p.cwiseAbs() + pose.translation().cwiseAbs()).sum();
  }
  Eigen::Vector3d at;
  double magnitude = 0.0;
};

/// All places where the point may be, and the clearance about these.
struct ModelBall {
  ModelBall(const Placed& model, std::uint32_t record, double clearance)
  : place(model.pose, model.hierarchy().view().point(record))
  {
    const PointsView& view = model.hierarchy().view();
    radius = clearance + view.radius(record) + view.uncertainty + view.ownUncertainty(record);
  }

  BallView from(const Point3& origin) const { return {origin, place.at, place.magnitude, radius}; }

  PosedPlace place;
  double radius;
};

/// Checks of both forms of markUnseen(). @throws InvalidInput
void checkUnseen(const Placed& model, const UnseenRequest& request, std::size_t verdicts);

} // namespace pcl_bsh
