// SPDX-License-Identifier: BSD-3-Clause
#include "made_robot.h"

#include <pcl_bsh/io/robots/surface.h>

#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace pcl_bsh::self_filter {

namespace {

constexpr auto urdf = R"(<?xml version="1.0"?>
<robot name="made_arm">
  <link name="base"><collision><origin xyz="0 0 0.1"/><geometry><cylinder radius="0.16" length="0.2"/></geometry></collision></link>
  <link name="mast"><collision><geometry><cylinder radius="0.03" length="1.5"/></geometry></collision></link>
  <link name="camera"/>
  <link name="turret"><collision><geometry><mesh filename="meshes/turret.stl"/></geometry></collision></link>
  <link name="upper_arm"><collision><geometry><mesh filename="meshes/upper_arm.stl"/></geometry></collision></link>
  <link name="elbow"><collision><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="forearm"><collision><geometry><mesh filename="meshes/forearm.stl" scale="0.001 0.001 0.001"/></geometry></collision></link>
  <link name="wrist"><collision><origin rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.05" length="0.12"/></geometry></collision></link>
  <link name="hand"><collision><geometry><box size="0.05 0.16 0.08"/></geometry></collision></link>
  <link name="left_finger"><collision><origin xyz="0.06 0 0"/><geometry><box size="0.12 0.02 0.04"/></geometry></collision></link>
  <link name="right_finger"><collision><origin xyz="0.06 0 0"/><geometry><box size="0.12 0.02 0.04"/></geometry></collision></link>
  <joint name="mast_foot" type="fixed"><parent link="base"/><child link="mast"/><origin xyz="-0.35 0 0.75"/></joint>
  <joint name="mast_top" type="fixed"><parent link="mast"/><child link="camera"/><origin xyz="0.06 0 0.72" rpy="-2.1415926535897931 0 -1.5707963267948966"/></joint>
  <joint name="turn" type="continuous"><parent link="base"/><child link="turret"/><origin xyz="0 0 0.2"/><axis xyz="0 0 1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="turret"/><child link="upper_arm"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/><limit lower="-1.6" upper="1.6" effort="1" velocity="1"/></joint>
  <joint name="elbow_seat" type="fixed"><parent link="upper_arm"/><child link="elbow"/><origin xyz="0 0 0.45"/></joint>
  <joint name="bend" type="revolute"><parent link="elbow"/><child link="forearm"/><axis xyz="0 1 0"/><limit lower="0" upper="2.6" effort="1" velocity="1"/></joint>
  <joint name="roll" type="continuous"><parent link="forearm"/><child link="wrist"/><origin xyz="0 0 0.42" rpy="0 -1.5707963267948966 0"/><axis xyz="1 0 0"/></joint>
  <joint name="hand_seat" type="fixed"><parent link="wrist"/><child link="hand"/><origin xyz="0.085 0 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="left_finger"/><origin xyz="0.025 0.01 0"/><axis xyz="0 1 0"/><limit lower="0" upper="0.06" effort="1" velocity="1"/></joint>
  <joint name="grip_too" type="prismatic"><parent link="hand"/><child link="right_finger"/><origin xyz="0.025 -0.01 0"/><axis xyz="0 1 0"/><limit lower="-0.06" upper="0" effort="1" velocity="1"/><mimic joint="grip" multiplier="-1"/></joint>
</robot>
)";

/// A closed surface about z, from 0 to `length`.
void writeTurned(const std::filesystem::path& path, double length, double unit,
                 const std::function<double(double)>& radius)
{
  constexpr int sides = 48, rows = 40;
  const auto at = [&](int row, int side) {
    const double along = static_cast<double>(std::clamp(row, 0, rows)) / rows;
    const double turn = 2 * std::numbers::pi * (side % sides) / sides;
    const double reach = row < 0 || row > rows ? 0.0 : radius(along); // beyond the ends: the middle of a lid
    return Eigen::Vector3f(
        Eigen::Vector3d(reach * std::cos(turn), reach * std::sin(turn), along * length).cast<float>() *
        static_cast<float>(unit));
  };
  std::string triangles;
  std::uint32_t count = 0;
  const auto add = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    if (a == b || b == c || a == c) return;
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
    for (const Eigen::Vector3f& v : {normal, a, b, c}) triangles.append(reinterpret_cast<const char*>(v.data()), 12);
    triangles.append(2, '\0');
    ++count;
  };
  for (int row = -1; row <= rows; ++row)
    for (int side = 0; side < sides; ++side) {
      add(at(row, side), at(row, side + 1), at(row + 1, side + 1));
      add(at(row, side), at(row + 1, side + 1), at(row + 1, side));
    }
  files::replaceFile(path, [&](std::ostream& out) {
    std::string header(80, ' ');
    header.replace(0, 8, "made_arm");
    out << header;
    out.write(reinterpret_cast<const char*>(&count), sizeof count);
    out << triangles;
  });
}

/// The first hits of rays from the camera.
class Image {
public:
  explicit Image(std::size_t width)
  : width_(width),
    height_(width * 3 / 4),
    depth_(width_ * height_, far),
    robot_(depth_.size())
  {
  }

  Eigen::Vector3d ray(std::size_t x, std::size_t y) const
  {
    return {(static_cast<double>(x) - 0.5 * static_cast<double>(width_)) / focal(),
            (static_cast<double>(y) - 0.5 * static_cast<double>(height_)) / focal(), 1.0};
  }

  /// @param depth_along of a ray: its depth, or infinity
  void drawRoom(const std::function<double(const Eigen::Vector3d&)>& depth_along)
  {
    for (std::size_t i = 0; i < depth_.size(); ++i)
      depth_[i] = std::min(depth_[i], depth_along(ray(i % width_, i / width_)));
  }

  void drawRobot(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
  {
    constexpr double near = 0.05; // what reaches closer is not seen: the mast
    if (std::min({a.z(), b.z(), c.z()}) < near) return;
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const auto [left, right] = std::minmax({column(a), column(b), column(c)});
    const auto [top, bottom] = std::minmax({row(a), row(b), row(c)});
    for (std::size_t y = pixel(top, height_); y < height_ && static_cast<double>(y) <= bottom; ++y)
      for (std::size_t x = pixel(left, width_); x < width_ && static_cast<double>(x) <= right; ++x) {
        const Eigen::Vector3d direction = ray(x, y);
        const double depth = normal.dot(a) / normal.dot(direction);
        const auto within = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
          return from.cross(to).dot(direction) * normal.dot(direction) >= 0.0;
        };
        if (!(depth > near) || !within(a, b) || !within(b, c) || !within(c, a) || depth >= depth_[y * width_ + x])
          continue;
        depth_[y * width_ + x] = depth;
        robot_[y * width_ + x] = 1;
      }
  }

  DepthImage points() const
  {
    DepthImage image{width_, height_, {}, robot_};
    std::mt19937 random(1);
    for (std::size_t i = 0; i < depth_.size(); ++i) {
      const double noise = 0.001 * (static_cast<double>(random()) / 0x80000000 - 1.0);
      const Eigen::Vector3d direction = ray(i % width_, i / width_);
      const Eigen::Vector3d point = (depth_[i] + noise / direction.norm()) * direction;
      for (const double coordinate : {point.x(), point.y(), point.z()})
        image.xyz.push_back(depth_[i] < far ? static_cast<float>(coordinate) : std::numeric_limits<float>::quiet_NaN());
    }
    return image;
  }

private:
  static constexpr double far = 5.0;

  double focal() const { return 0.82 * static_cast<double>(width_); }
  double column(const Eigen::Vector3d& p) const { return focal() * p.x() / p.z() + 0.5 * static_cast<double>(width_); }
  double row(const Eigen::Vector3d& p) const { return focal() * p.y() / p.z() + 0.5 * static_cast<double>(height_); }
  static std::size_t pixel(double at, std::size_t end)
  {
    return static_cast<std::size_t>(std::clamp(std::ceil(at), 0.0, static_cast<double>(end)));
  }

  std::size_t width_, height_;
  std::vector<double> depth_;
  std::vector<std::uint8_t> robot_;
};

/// Where a ray enters a box, or leaves it when it begins inside; infinity: nowhere.
double depthOfBox(const Eigen::Vector3d& from, const Eigen::Vector3d& along, const Eigen::Vector3d& low,
                  const Eigen::Vector3d& high)
{
  const Eigen::Array3d one = (low - from).array() / along.array(), other = (high - from).array() / along.array();
  const double enters = one.min(other).maxCoeff(), leaves = one.max(other).minCoeff();
  if (enters > leaves || leaves <= 0.0) return std::numeric_limits<double>::infinity();
  return enters > 0.0 ? enters : leaves;
}

} // namespace

void writeMadeRobot(const std::filesystem::path& folder)
{
  const files::OutputFolder meshes(folder / "meshes");
  writeTurned(folder / "meshes/turret.stl", 0.2, 1.0, [](double along) { return 0.14 - 0.05 * along; });
  writeTurned(folder / "meshes/upper_arm.stl", 0.45, 1.0,
              [](double along) { return 0.06 + 0.02 * std::cos(3 * std::numbers::pi * along); });
  writeTurned(folder / "meshes/forearm.stl", 0.42, 1000.0, // in millimetres
              [](double along) { return 0.065 - 0.025 * along + 0.008 * std::sin(12 * along); });
  files::replaceFile(folder / "robot.urdf", [](std::ostream& out) { out << urdf; });
}

JointValues madeJointValues(std::size_t frame, std::size_t frames)
{
  const double phase = 2 * std::numbers::pi * static_cast<double>(frame) / static_cast<double>(frames);
  return {{"turn", 0.5 * std::sin(phase)},
          {"shoulder", 0.5 + 0.2 * std::cos(phase)},
          {"bend", 1.2 + 0.3 * std::sin(phase)},
          {"roll", phase},
          {"grip", 0.03 + 0.02 * std::cos(phase)}};
}

DepthImage seenBy(const Robot& robot, const JointValues& values, std::size_t width)
{
  const std::vector<Eigen::Isometry3d> poses = linkPoses(robot, values);
  const Eigen::Isometry3d T_root_camera = poses[robot.linkNamed("camera")];
  Image image(width);
  image.drawRoom([&](const Eigen::Vector3d& ray) {
    const Eigen::Vector3d from = T_root_camera.translation(), along = T_root_camera.linear() * ray;
    return std::min(depthOfBox(from, along, {-3, -2, 0}, {3, 2, 2.6}),
                    depthOfBox(from, along, {0.7, -0.6, 0}, {1.5, 0.6, 0.4}));
  });
  for (std::size_t link = 0; link < robot.links.size(); ++link)
    for (const Shape& shape : robot.links[link].shapes) {
      const Surface surface = surfaceOf(shape, 0.0005);
      const Eigen::Isometry3d T_camera_link = T_root_camera.inverse() * poses[link];
      const auto corner = [&](std::uint32_t i) { return T_camera_link * Eigen::Vector3d(surface.vertices[i].data()); };
      for (const Triangle& t : surface.triangles) image.drawRobot(corner(t[0]), corner(t[1]), corner(t[2]));
    }
  return image.points();
}

} // namespace pcl_bsh::self_filter
