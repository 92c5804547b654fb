// SPDX-License-Identifier: BSD-3-Clause
// PLY's element `camera`, where PCL's writer (and MeshLab's) puts the sensor: its position, and the rows of its
// rotation matrix, all float32, for PCL's reader takes no others. A comment beside it has the viewpoint in full.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

struct PlyCameraValue {
  std::string_view name;
  bool whole; ///< an int, else a float
};

/// The values of a camera, in the order of PCL's writer: position, rotation, and properties of a lens, zero here.
inline constexpr std::array<PlyCameraValue, 21> ply_camera_values = {
    {{"view_px", false}, {"view_py", false}, {"view_pz", false},  {"x_axisx", false},  {"x_axisy", false},
     {"x_axisz", false}, {"y_axisx", false}, {"y_axisy", false},  {"y_axisz", false},  {"z_axisx", false},
     {"z_axisy", false}, {"z_axisz", false}, {"focal", false},    {"scalex", false},   {"scaley", false},
     {"centerx", false}, {"centery", false}, {"viewportx", true}, {"viewporty", true}, {"k1", false},
     {"k2", false}}};

inline constexpr std::string_view ply_viewpoint_comment = "viewpoint"; ///< and tx ty tz qw qx qy qz

/// The values of a camera as they come.
class PlyCamera {
public:
  void take(const std::string& name, std::uint8_t datatype, const std::uint8_t* bytes);

  /// The pose of the camera. It is no_viewpoint where the position is missing, or float32 cannot hold it. It is not
  /// turned where the rotation is missing, or is nine zeros.
  /// @param in_full the viewpoint of a comment, which is returned where it rounds to this camera
  /// @param remarks gets a line where the nearest rotation took the place of the camera's
  /// @throws FormatError for what is no rigid motion (rigid_pose.h)
  Viewpoint viewpoint(const std::optional<Viewpoint>& in_full, std::vector<std::string>& remarks) const;

private:
  std::array<std::optional<double>, 12> values_; ///< the first of ply_camera_values
};

/// The header's comment with the viewpoint in full. Ends with a line break.
std::string cameraComment(const Viewpoint& viewpoint);

/// A camera's bytes, in this machine's byte order.
std::string cameraRow(const Viewpoint& viewpoint, std::uint32_t width, std::uint32_t height);

} // namespace pcl_bsh::io
