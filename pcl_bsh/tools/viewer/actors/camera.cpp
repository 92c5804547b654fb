// SPDX-License-Identifier: BSD-3-Clause
#include "camera.h"

#include <Eigen/Geometry>
#include <vtkCamera.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace pcl_bsh::viewer {

namespace {

/// A side from which a box is looked at.
struct ViewSide {
  Eigen::Vector3d toward_eye, up;
};

ViewSide sideOf(Camera::Kind kind)
{
  if (kind == Camera::Kind::top) return {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY()};
  if (kind == Camera::Kind::front) return {-Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  if (kind == Camera::Kind::side) return {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()};
  return {Eigen::Vector3d(-0.55, -1.0, 0.7).normalized(), Eigen::Vector3d::UnitZ()};
}

/// The slanted side and its turns about z, the top, and then all of these from below.
std::vector<ViewSide> allSides()
{
  constexpr int turns = 8;
  const ViewSide slanted = sideOf(Camera::Kind::slanted), top = sideOf(Camera::Kind::top);
  std::vector<ViewSide> sides;
  for (const double height : {1.0, -1.0}) {
    const Eigen::Vector3d flip(1.0, 1.0, height);
    for (int turn = 0; turn < turns; ++turn) {
      const Eigen::AngleAxisd about_z(turn * 2.0 * std::numbers::pi / turns, Eigen::Vector3d::UnitZ());
      sides.push_back({(about_z * slanted.toward_eye).cwiseProduct(flip), slanted.up});
    }
    sides.push_back({height * top.toward_eye, top.up});
  }
  return sides;
}

/// The gaze from a side that sees the whole box. @param tall half the picture's height at a distance of 1
Gaze gazeAt(const ViewSide& side, const vtkBoundingBox& seen, double tall, double aspect, double free_width)
{
  Gaze gaze;
  gaze.toward = side.toward_eye;
  gaze.right = side.up.cross(side.toward_eye).normalized();
  gaze.up = side.toward_eye.cross(gaze.right);
  gaze.tall = tall;
  gaze.wide = tall * aspect;
  Eigen::Vector3d focus;
  seen.GetCenter(focus.data());
  double away = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at;
    seen.GetCorner(corner, at.data());
    const Eigen::Vector3d p = at - focus;
    away = std::max({away, std::abs(p.dot(gaze.right)) / (free_width * gaze.wide) + p.dot(gaze.toward),
                     std::abs(p.dot(gaze.up)) / gaze.tall + p.dot(gaze.toward)});
  }
  // For a box that is a single place, any distance will do that the graphics card's floats tell from 0.
  away = away > 0.0 ? std::max(away, 1e-6) : std::max(1.0, 1e-3 * focus.norm());
  gaze.at = focus + 1.1 * away * gaze.toward;
  return gaze;
}

} // namespace

void look(vtkRenderer& renderer, const Camera& camera, const vtkBoundingBox& seen, double aspect, double free_width,
          std::span<const Drawn> things)
{
  vtkCamera& view = *renderer.GetActiveCamera();
  if (camera.kind == Camera::Kind::given) {
    view.SetPosition(camera.eye.data());
    view.SetFocalPoint(camera.focus.data());
    view.SetViewUp(camera.up.data());
    renderer.ResetCameraClippingRange();
    return;
  }
  const double tall = std::tan(view.GetViewAngle() * std::numbers::pi / 360.0);
  ViewSide side = sideOf(camera.kind);
  if (camera.kind == Camera::Kind::colliding) {
    constexpr double clearly = 1.1;
    double most = 0.0;
    for (const ViewSide& other : allSides()) {
      const double share = shareSeen(gazeAt(other, seen, tall, aspect, free_width), things);
      if (!(share > clearly * most)) continue;
      most = share;
      side = other;
    }
  }
  const Gaze gaze = gazeAt(side, seen, tall, aspect, free_width);
  double focus[3];
  seen.GetCenter(focus);
  view.SetFocalPoint(focus);
  view.SetPosition(gaze.at.data());
  view.SetViewUp(side.up.data());
  renderer.ResetCameraClippingRange();
}

} // namespace pcl_bsh::viewer
