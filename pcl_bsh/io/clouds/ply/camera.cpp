// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/clouds/ply/camera.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/number_text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t pose_values = 12; // of a camera: position and rotation
constexpr auto remedy_for_camera = "export it again with the sensor's pose, or without a camera";

std::array<float, pose_values> poseInFloats(const Viewpoint& viewpoint)
{
  Eigen::Quaterniond turn(viewpoint[3], viewpoint[4], viewpoint[5], viewpoint[6]);
  const bool turned = turn.norm() > 0 && std::isfinite(turn.norm());
  const Eigen::Matrix3d rotation =
      turned ? turn.normalized().toRotationMatrix() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  std::array<float, pose_values> floats;
  for (std::size_t i = 0; i < pose_values; ++i) {
    const auto at = static_cast<Eigen::Index>(i) - 3;
    floats[i] = roundToFloat(i < 3 ? viewpoint[i] : rotation(at / 3, at % 3));
  }
  return floats;
}

} // namespace

void PlyCamera::take(const std::string& name, std::uint8_t datatype, const std::uint8_t* bytes)
{
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (name != ply_camera_values[i].name) continue;
    withFieldType(datatype, [&](auto value) {
      std::memcpy(&value, bytes, sizeof value);
      values_[i] = static_cast<double>(value);
    });
  }
}

Viewpoint PlyCamera::viewpoint(const std::optional<Viewpoint>& in_full, std::vector<std::string>& remarks) const
{
  if (in_full) {
    const std::array<float, pose_values> floats = poseInFloats(*in_full);
    if (std::equal(floats.begin(), floats.end(), values_.begin())) return *in_full;
  }
  constexpr double limit = 3.4e38; // of PCL's
  Viewpoint viewpoint = no_viewpoint;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!values_[k]) return no_viewpoint;
    if (!std::isfinite(*values_[k])) throw FormatError("has a camera whose position is not finite", remedy_for_camera);
    if (std::abs(*values_[k]) > limit) return no_viewpoint;
    viewpoint[k] = *values_[k];
  }
  Eigen::Matrix3d rotation;
  for (std::size_t i = 0; i < 9; ++i) {
    if (!values_[3 + i]) return viewpoint;
    rotation(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = *values_[3 + i];
  }
  if (rotation.isZero(0.0)) return viewpoint;
  const RigidPart part = rigidPart(rotation);
  if (!part.wrong.empty()) throw FormatError("has a camera whose rotation " + part.wrong, remedy_for_camera);
  if (part.deviation > 0) remarks.push_back("camera: " + nearestRotationWarning(part.deviation));
  const Eigen::Quaterniond turn = Eigen::Quaterniond(part.rotation).normalized();
  const double quaternion[] = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy(std::begin(quaternion), std::end(quaternion), viewpoint.begin() + 3);
  return viewpoint;
}

std::string cameraComment(const Viewpoint& viewpoint)
{
  std::string line = "comment " + std::string(ply_viewpoint_comment);
  for (const double value : viewpoint) line += ' ' + numberText(value);
  return line + '\n';
}

std::string cameraRow(const Viewpoint& viewpoint, std::uint32_t width, std::uint32_t height)
{
  const std::array<float, pose_values> pose = poseInFloats(viewpoint);
  std::string row;
  const auto append = [&](auto value) { row.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (std::size_t i = 0; i < ply_camera_values.size(); ++i) {
    if (ply_camera_values[i].whole) {
      append(ply_camera_values[i].name == "viewportx" ? width : height);
    }
    else {
      append(i < pose_values ? pose[i] : 0.0F);
    }
  }
  return row;
}

} // namespace pcl_bsh::io
