// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/robot/swept_region.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

namespace pcl_bsh::robots {

namespace {

constexpr double kCubes = 40.0; ///< along the longest edge

} // namespace

SweptRegion::SweptRegion(const std::vector<SweptBall>& balls, double margin, const Eigen::Isometry3d& T_world_cloud)
{
  if (!(margin >= 0.0 && std::isfinite(margin)))
    throw InvalidInput(Input::clearance, "margin", "is " + std::to_string(margin), "give one that is finite and >= 0")
        .withValue(margin);
  checkPose("T_world_cloud", T_world_cloud);
  const Eigen::Isometry3d T_cloud_world = T_world_cloud.inverse();
  if (balls.empty()) return;
  std::vector<SweptBall> seen;
  double largest = 0.0;
  for (const SweptBall& ball : balls) {
    seen.push_back({T_cloud_world * ball.center, ball.radius + margin});
    largest = std::max(largest, ball.center.norm() + seen.back().center.norm() + seen.back().radius);
  }
  Eigen::AlignedBox3d box;
  for (SweptBall& ball : seen) {
    constexpr double kInexact = 0x1p-18; // the pose is rigid within 1e-6, and floats are rounded on the way to a cube
    ball.radius += kInexact * largest;
    box.extend(Eigen::Vector3d(ball.center.array() - ball.radius));
    box.extend(Eigen::Vector3d(ball.center.array() + ball.radius));
  }
  const double edge = std::max(box.sizes().maxCoeff(), 1e-30) / kCubes;
  low_ = box.min().cast<float>();
  cubes_per_m_ = static_cast<float>(1.0 / edge);
  for (int axis = 0; axis < 3; ++axis)
    count_[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(box.sizes()[axis] / edge) + 1;
  near_.assign(count_[0] * count_[1] * count_[2], 0);
  for (const SweptBall& ball : seen) mark(ball.center, ball.radius);
}

void SweptRegion::mark(const Eigen::Vector3d& center, double radius)
{
  const auto per_m = static_cast<double>(cubes_per_m_);
  const Eigen::Array3d middle = (center.array() - low_.cast<double>()) * per_m;
  const double r = radius * per_m;
  const auto cubesOf = [&](int axis, double half) { // the first and the last one that it touches
    const std::size_t most = count_[static_cast<std::size_t>(axis)] - 1;
    return std::pair(std::min(static_cast<std::size_t>(std::max(middle[axis] - half, 0.0)), most),
                     std::min(static_cast<std::size_t>(std::max(middle[axis] + half, 0.0)), most));
  };
  const auto apart = [](double at, std::size_t cube) { // from the nearest place of the cube, squared
    const auto low = static_cast<double>(cube);
    const double way = std::max({low - at, at - low - 1.0, 0.0});
    return way * way;
  };
  const auto [z_first, z_last] = cubesOf(2, r);
  const auto [y_first, y_last] = cubesOf(1, r);
  for (std::size_t z = z_first; z <= z_last; ++z)
    for (std::size_t y = y_first; y <= y_last; ++y) {
      const double left = r * r - apart(middle.z(), z) - apart(middle.y(), y);
      if (left < 0.0) continue;
      const auto [first, last] = cubesOf(0, std::sqrt(left));
      const auto row = near_.begin() + static_cast<std::ptrdiff_t>((z * count_[1] + y) * count_[0]);
      std::fill(row + static_cast<std::ptrdiff_t>(first), row + static_cast<std::ptrdiff_t>(last) + 1, std::uint8_t{1});
    }
}

template <class T>
bool SweptRegion::isNear(const unsigned char* point, const std::array<std::size_t, 3>& offset) const
{
  std::array<T, 3> p;
  std::size_t cube = 0, cubes = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    std::memcpy(&p[k], point + offset[k], sizeof(T));
    const float at = (static_cast<float>(p[k]) - low_[static_cast<Eigen::Index>(k)]) * cubes_per_m_;
    if (!(at >= 0.0f && at < static_cast<float>(count_[k]))) return false; // also where it is NaN
    cube += cubes * static_cast<std::size_t>(static_cast<int>(at));
    cubes *= count_[k];
  }
  return near_[cube] != 0 && p != std::array<T, 3>{};
}

void SweptRegion::recordsInside(const PointsView& cloud, std::vector<std::int32_t>& records) const
{
  records.clear();
  const bool are_floats = cloud.scalar == Scalar::float32;
  const auto* const points = static_cast<const unsigned char*>(cloud.data);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t record = cloud.record(i);
    const unsigned char* const point = points + cloud.stride * record;
    if (are_floats ? isNear<float>(point, cloud.offset) : isNear<double>(point, cloud.offset))
      records.push_back(static_cast<std::int32_t>(record));
  }
}

} // namespace pcl_bsh::robots
