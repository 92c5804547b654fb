// SPDX-License-Identifier: BSD-3-Clause
#include "camera.h"

#include <Eigen/Geometry>
#include <vtkCamera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pcl_bsh::viewer {

void look(vtkRenderer& renderer, const Camera& camera, const vtkBoundingBox& seen, double aspect, double free_width)
{
  vtkCamera& eye = *renderer.GetActiveCamera();
  if (camera.kind == Camera::Kind::given) {
    eye.SetPosition(camera.eye.data());
    eye.SetFocalPoint(camera.focus.data());
    eye.SetViewUp(camera.up.data());
    renderer.ResetCameraClippingRange();
    return;
  }
  std::array<double, 3> from = {-0.55, -1.0, 0.7}, up = {0, 0, 1};
  if (camera.kind == Camera::Kind::top) {
    from = {0, 0, 1};
    up = {0, 1, 0};
  }
  if (camera.kind == Camera::Kind::front) from = {0, -1, 0};
  if (camera.kind == Camera::Kind::side) from = {1, 0, 0};

  double focus[3];
  seen.GetCenter(focus);
  const Eigen::Vector3d toward_eye = Eigen::Vector3d(from.data()).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d(up.data()).cross(toward_eye).normalized();
  const double tall = std::tan(eye.GetViewAngle() * std::numbers::pi / 360.0);
  const double wide = free_width * tall * aspect;
  double away = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double at[3];
    seen.GetCorner(corner, at);
    const Eigen::Vector3d p = Eigen::Vector3d(at) - Eigen::Vector3d(focus);
    away = std::max({away, std::abs(p.dot(right)) / wide + p.dot(toward_eye),
                     std::abs(p.dot(toward_eye.cross(right))) / tall + p.dot(toward_eye)});
  }
  // Of a single place any distance will do that the graphics card's floats tell from none.
  away = away > 0.0 ? std::max(away, 1e-6) : std::max(1.0, 1e-3 * Eigen::Vector3d(focus).norm());
  const Eigen::Vector3d position = Eigen::Vector3d(focus) + 1.1 * away * toward_eye;
  eye.SetFocalPoint(focus);
  eye.SetPosition(position.data());
  eye.SetViewUp(up.data());
  renderer.ResetCameraClippingRange();
}

} // namespace pcl_bsh::viewer
