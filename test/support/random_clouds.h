// SPDX-License-Identifier: BSD-3-Clause
// Clouds of many shapes and memory layouts, and scenes of two of them.
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include "random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

enum class Shape { uniform, sphere, plane, line, clusters, grid, duplicates, outlier };

inline constexpr Shape all_shapes[] = {Shape::uniform,  Shape::sphere, Shape::plane,      Shape::line,
                                       Shape::clusters, Shape::grid,   Shape::duplicates, Shape::outlier};

/// Points within [-scale, scale]^3; one may be an outlier. Grids have a spacing of scale / 8: exact when scale is a
/// power of two.
inline std::vector<Point3> makePoints(Shape shape, std::size_t count, double scale, Random& random)
{
  const auto around = [&](const Point3& center, double reach) {
    const Point3 p = random.point([&] { return reach * random.uniform(-1, 1); });
    return Point3{center[0] + p[0], center[1] + p[1], center[2] + p[2]};
  };
  std::vector<Point3> centers(6);
  for (Point3& center : centers) center = around({0, 0, 0}, 0.8 * scale);

  std::vector<Point3> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    Point3& p = points[i];
    p = around({0, 0, 0}, scale);
    switch (shape) {
    case Shape::uniform:
      break;
    case Shape::sphere: {
      const double norm = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
      for (double& x : p) x *= scale / (norm + 1e-9 * scale);
      break;
    }
    case Shape::plane:
      p[2] = 0.25 * p[0] - 0.5 * p[1];
      break;
    case Shape::line:
      p = {p[0], 0.5 * p[0], -0.25 * p[0]};
      break;
    case Shape::clusters:
      p = around(centers[i % centers.size()], 0.02 * scale);
      break;
    case Shape::grid:
      p = random.point([&] { return scale / 8 * random.integer(-8, 8); });
      break;
    case Shape::duplicates:
      p = centers[i % centers.size()];
      break;
    case Shape::outlier:
      p = i == count / 2 ? Point3{1e4 * scale, 0, 0} : around({0, 0, 0}, 1e-3 * scale);
      break;
    }
  }
  return points;
}

/// How a cloud lies in memory.
struct Layout {
  Scalar scalar = Scalar::float32;
  std::size_t head = 0; ///< bytes before x; odd ones misalign every coordinate
  std::size_t tail = 0; ///< bytes after z
};

/// A cloud that owns its records.
class Cloud {
public:
  explicit Cloud(const std::vector<Point3>& points, const Layout& layout = {})
  {
    const std::size_t width = layout.scalar == Scalar::float32 ? sizeof(float) : sizeof(double);
    view_.count = points.size();
    view_.stride = layout.head + 3 * width + layout.tail;
    view_.offset = {layout.head, layout.head + width, layout.head + 2 * width};
    view_.scalar = layout.scalar;
    bytes_.assign(view_.stride * points.size(), 0xee);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        unsigned char* target = bytes_.data() + i * view_.stride + view_.offset[k];
        const auto narrow = static_cast<float>(points[i][k]);
        if (layout.scalar == Scalar::float32)
          std::memcpy(target, &narrow, sizeof narrow);
        else
          std::memcpy(target, &points[i][k], sizeof(double));
      }
    }
  }

  /// Only the records listed, in this order.
  void restrictTo(std::vector<std::int32_t> indices)
  {
    subset_ = true;
    indices_ = std::move(indices);
  }

  /// One per record.
  void setRadii(std::vector<float> radii) { radii_ = std::move(radii); }

  /// Sets the uncertainty of all points, and one per record; these may be empty.
  void setUncertainties(double of_all, std::vector<float> own)
  {
    view_.uncertainty = of_all;
    uncertainties_ = std::move(own);
  }

  /// Makes its records vertices, and triangles of three of them each the records.
  void setTriangles(std::vector<std::uint32_t> corners)
  {
    corners_ = std::move(corners);
    of_triangles_ = true;
  }

  /// Valid until the cloud changes or goes.
  PointsView view() const
  {
    PointsView view = view_;
    view.data = bytes_.data();
    if (of_triangles_) view = viewOf(TrianglesView{view, corners_.data(), corners_.size() / 3});
    if (!radii_.empty()) view.radii = radii_.data();
    view.uncertainties = uncertainties_.empty() ? nullptr : uncertainties_.data();
    static constexpr std::int32_t none = 0;
    if (subset_) view.indices = indices_.empty() ? &none : indices_.data();
    view.index_count = indices_.size();
    return view;
  }

private:
  PointsView view_;
  std::vector<unsigned char> bytes_;
  std::vector<std::int32_t> indices_;
  std::vector<float> radii_, uncertainties_;
  std::vector<std::uint32_t> corners_;
  bool subset_ = false, of_triangles_ = false;
};

/// One length of all, one for each record, or both; of the size of the clearance, or so that ties are likely.
inline void makeUncertain(Cloud& cloud, double scale, Random& random)
{
  const auto length = [&] {
    return random.chance(0.5) ? scale * random.integer(0, 4) / 16 : scale * random.uniform(0, 0.2);
  };
  const bool of_all = random.chance(0.6);
  std::vector<float> own;
  if (!of_all || random.chance(0.3))
    for (std::size_t i = 0; i < cloud.view().count; ++i) own.push_back(static_cast<float>(length()));
  cloud.setUncertainties(of_all ? length() : 0.0, std::move(own));
}

/// Two clouds, where they stand and how near counts as a collision.
struct Scene {
  Cloud a, b;
  Eigen::Isometry3d pose_a, pose_b;
  double clearance;
  std::string name;
};

/// Coordinates no point should have, in about every fourth point.
inline void spoil(std::vector<Point3>& points, Random& random)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double bad[] = {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity};
  for (Point3& p : points) {
    if (random.chance(0.25)) p[static_cast<std::size_t>(random.integer(0, 2))] = random.pick(bad);
  }
}

/// A cloud of any shape and layout around `center`; sometimes with bad points, a subset, radii.
inline Cloud anyCloud(std::size_t count, double scale, const Point3& center, Random& random)
{
  const Shape shape = random.pick(all_shapes);
  std::vector<Point3> points = makePoints(shape, count, scale, random);
  for (Point3& p : points) {
    for (std::size_t k = 0; k < 3; ++k) p[k] += center[k];
  }
  if (random.chance(0.2)) spoil(points, random);

  constexpr Layout layouts[] = {{Scalar::float32, 0, 0},
                                {Scalar::float32, 0, 4},
                                {Scalar::float32, 3, 2},
                                {Scalar::float64, 0, 0},
                                {Scalar::float64, 1, 8}};
  Cloud cloud(points, random.pick(layouts));
  if (random.chance(0.2)) {
    std::vector<std::int32_t> indices;
    for (std::size_t i = count; i-- > 0;) {
      if (random.chance(0.5)) indices.push_back(static_cast<std::int32_t>(i));
    }
    cloud.restrictTo(std::move(indices));
  }
  if (random.chance(0.2)) {
    std::vector<float> radii(count);
    for (float& radius : radii) radius = random.chance(0.2) ? 0.0f : static_cast<float>(scale * random.uniform(0, 0.1));
    cloud.setRadii(std::move(radii));
  }
  return cloud;
}

/// A clearance that some pair meets as exactly as a double can (on grids: exactly), or misses by the last bit.
inline double tiedClearance(const PointsView& a, const Eigen::Isometry3d& pose_a, const PointsView& b,
                            const Eigen::Isometry3d& pose_b, Random& random)
{
  const ExactDistance distance(pose_a, pose_b);
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 50 && a.size() > 0 && b.size() > 0; ++i) {
    const auto any_record = [&](const PointsView& view) {
      return view.record(static_cast<std::size_t>(random.integer(0, static_cast<int>(view.size()) - 1)));
    };
    const std::uint32_t p = any_record(a), q = any_record(b);
    const auto finite = [](const Point3& x) { return std::isfinite(x[0] + x[1] + x[2]); };
    if (!finite(a.point(p)) || !finite(b.point(q))) continue;
    smallest = std::min(smallest, std::max(0.0, distance.gap({a.point(p), b.point(q), a.radius(p), b.radius(q)})));
  }
  if (!std::isfinite(smallest)) return 0.0;
  const int last_bit = random.integer(-1, 1);
  return last_bit == 0 ? smallest : std::nextafter(smallest, last_bit < 0 ? 0.0 : 2 * smallest);
}

/// Two clouds of up to max_points that meet or nearly meet, in any pose; half of the clearances are ties.
inline Scene anyScene(std::uint64_t seed, int max_points)
{
  Random random(seed);
  constexpr int small_counts[] = {0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 33, 64, 100};
  const auto any_count = [&] {
    return static_cast<std::size_t>(random.chance(0.3) ? std::min(random.pick(small_counts), max_points)
                                                       : random.integer(0, max_points));
  };
  constexpr double scales[] = {0x1p-10, 1.0, 0x1p10};
  constexpr double distances[] = {0, 0, 0x1p7, 1e6};
  const double scale = random.pick(scales);
  const double far_a = scale * random.pick(distances), far_b = scale * random.pick(distances);
  const Point3 center_a = {far_a, -0.5 * far_a, 0.25 * far_a}, center_b = {-far_b, 0.125 * far_b, far_b};
  const std::size_t count_a = any_count(), count_b = any_count();
  Cloud a = anyCloud(count_a, scale, center_a, random), b = anyCloud(count_b, scale, center_b, random);

  // Both centers come to stand near the same place of the world, or beside each other.
  const double beside = random.chance(0.3) ? 2.5 * scale : 0.0;
  const Eigen::Isometry3d world = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(100 * scale);
  const auto bring = [&](const Point3& center, bool turned, double shift) {
    Eigen::Isometry3d pose = turned ? random.pose(scale) : Eigen::Isometry3d::Identity();
    if (!turned && random.chance(0.5)) pose.translation().setConstant(scale * random.integer(-4, 4) / 8);
    pose = world * Eigen::Translation3d(0, shift, 0) * pose;
    pose.translate(-Eigen::Vector3d(center[0], center[1], center[2]));
    return pose;
  };
  const bool turned_a = random.chance(0.5), turned_b = random.chance(0.5);
  const Eigen::Isometry3d pose_a = bring(center_a, turned_a, 0), pose_b = bring(center_b, turned_b, beside);

  const int kind = random.integer(0, 9);
  const double clearance = kind < 5    ? tiedClearance(a.view(), pose_a, b.view(), pose_b, random)
                           : kind == 5 ? 0.0
                           : kind == 6 ? scale * random.integer(0, 8) / 8
                                       : scale * random.uniform(0, 0.5);
  const std::string name = "scene " + std::to_string(seed) + " of up to " + std::to_string(max_points) + ": " +
                           std::to_string(count_a) + " x " + std::to_string(count_b) + " points, clearance " +
                           std::to_string(clearance);
  return {std::move(a), std::move(b), pose_a, pose_b, clearance, name};
}

} // namespace pcl_bsh::test
