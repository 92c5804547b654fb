// SPDX-License-Identifier: BSD-3-Clause
#include "self_filter/self_filter.h"

#include "../cloud_files/samples.h"
#include "self_filter/made_robot.h"
#include "self_filter/shape_surface.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace pcl_bsh::self_filter {
namespace {

using Eigen::Vector3d;

double distanceToTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  const auto toSegment = [&](const Vector3d& from, const Vector3d& to) {
    const double at = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (p - from - at * (to - from)).norm();
  };
  const Vector3d normal = (b - a).cross(c - a);
  const auto inside = [&](const Vector3d& from, const Vector3d& to) {
    return normal.dot((to - from).cross(p - from)) >= 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(normal.normalized().dot(p - a));
  return std::min({toSegment(a, b), toSegment(b, c), toSegment(c, a)});
}

/// A shape as it truly is: the surface of a box or a cylinder, a solid sphere, triangles.
class TrueShape {
public:
  explicit TrueShape(const Shape& shape)
  : shape_(shape),
    surface_(surfaceOf({shape.form, Eigen::Isometry3d::Identity()}, 1.0)) // only asked for what has corners
  {
  }

  double distanceFrom(const Vector3d& in_link) const
  {
    const Vector3d p = shape_.pose.inverse() * in_link;
    if (const auto* ball = std::get_if<Sphere>(&shape_.form)) return std::max(0.0, p.norm() - ball->radius);
    if (const auto* tube = std::get_if<Cylinder>(&shape_.form)) {
      const double out = p.head<2>().norm() - tube->radius, over = std::abs(p.z()) - tube->length / 2;
      return out > 0 && over > 0 ? std::hypot(out, over) : std::abs(std::max(out, over));
    }
    double least = std::numeric_limits<double>::infinity();
    const auto corner = [&](std::uint32_t i) { return Vector3d(surface_.vertices[i].data()); };
    for (const Triangle& t : surface_.triangles)
      least = std::min(least, distanceToTriangle(p, corner(t[0]), corner(t[1]), corner(t[2])));
    return least;
  }

private:
  Shape shape_;
  Surface surface_;
};

class SelfFilterTest : public testing::Test {
protected:
  SelfFilterTest()
  {
    writeMadeRobot(folder.path());
    robot = readRobot(folder / "robot.urdf");
  }

  const io::TemporaryFolder folder;
  Robot robot;
};

TEST_F(SelfFilterTest, FlagsWhatIsWithinThePaddingOfALink)
{
  const Settings settings{0.03, 0.003, 1};
  SelfFilter filter(robot, settings);
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 0x100000000;
  };
  std::vector<std::pair<std::size_t, TrueShape>> shapes; // with their links
  for (std::size_t link = 0; link < robot.links.size(); ++link)
    for (const Shape& shape : robot.links[link].shapes) shapes.emplace_back(link, TrueShape(shape));
  std::size_t flagged = 0, between = 0;
  for (std::size_t frame = 0; frame < 3; ++frame) {
    const JointValues values = madeJointValues(frame, 3);
    const std::vector<Eigen::Isometry3d> poses = robot.poses(values);
    // Half of the points about the links' bodies, half anywhere near.
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < 200; ++i) {
      Vector3d p(uniform(-0.6, 1.2), uniform(-0.7, 0.7), uniform(-0.1, 1.6));
      if (const Link& link = robot.links[i % robot.links.size()]; i % 2 == 0 && !link.shapes.empty()) {
        const Surface surface = surfaceOf(link.shapes[0], 0.001);
        const Vector3d corner(surface.vertices[random() % surface.vertices.size()].data());
        p = poses[i % robot.links.size()] * (corner + 0.03 * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
      }
      points.push_back(p);
    }
    const Eigen::Isometry3d T_scan_root = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Vector3d::UnitY());
    std::vector<double> scan;
    for (const Vector3d& p : points) {
      const Vector3d seen = T_scan_root * p;
      scan.insert(scan.end(), {seen.x(), seen.y(), seen.z()});
    }
    const std::vector<std::uint8_t>& flags = filter.flags(viewOf(scan.data(), points.size()), T_scan_root, values);
    ASSERT_EQ(flags.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      double distance = std::numeric_limits<double>::infinity();
      for (const auto& [link, shape] : shapes)
        distance = std::min(distance, shape.distanceFrom(poses[link].inverse() * points[i]));
      constexpr double rounding = 1e-12;
      if (distance <= settings.padding - rounding) {
        EXPECT_EQ(flags[i], 1) << distance;
      }
      if (distance > settings.padding + settings.tolerance + rounding) {
        EXPECT_EQ(flags[i], 0) << distance;
      }
      flagged += flags[i];
      between += distance > settings.padding && distance < settings.padding + settings.tolerance;
    }
  }
  EXPECT_GT(flagged, 150U);
  EXPECT_LT(flagged, 500U);
  EXPECT_GT(between, 5U);
}

TEST_F(SelfFilterTest, CutsOutWhatTheCameraSeesOfTheRobot)
{
  SelfFilter filter(robot, {0.02, 0.005, 1});
  const JointValues values = madeJointValues(1, 3);
  const DepthImage image = seenBy(robot, values, 160);
  const Eigen::Isometry3d T_camera_root = robot.poses(values)[robot.linkNamed("camera")].inverse();
  const std::vector<std::uint8_t>& flags =
      filter.flags(viewOf(image.xyz.data(), image.xyz.size() / 3), T_camera_root, values);
  const auto seen = std::count(image.is_robot.begin(), image.is_robot.end(), 1);
  const auto cut = std::count(flags.begin(), flags.end(), 1);
  EXPECT_GT(seen, 500);
  EXPECT_LT(cut, 2 * seen);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (image.is_robot[i]) {
      EXPECT_EQ(flags[i], 1) << i;
    }
  }
}

TEST_F(SelfFilterTest, AnswersAlikeForAnyNumberOfThreadsAndFrameBefore)
{
  const DepthImage image = seenBy(robot, madeJointValues(0, 3), 160);
  const PointsView view = viewOf(image.xyz.data(), image.xyz.size() / 3);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  SelfFilter one(robot, {0.02, 0.005, 1}), all(robot, {0.02, 0.005, 0});
  all.flags(view, pose, madeJointValues(2, 3));
  EXPECT_EQ(one.flags(view, pose, madeJointValues(1, 3)), all.flags(view, pose, madeJointValues(1, 3)));
  EXPECT_THROW(one.flags(view, pose, {{"nose", 1}}), std::runtime_error);
}

TEST(LinkBodyTest, NamesTheLinkThatHasNoSize)
{
  for (const Shape& shape : {Shape{Box{{1, 0, 1}}}, Shape{Cylinder{0.1, -1}}, Shape{Sphere{std::nan("")}}}) {
    Link link;
    link.name = "thumb";
    link.shapes = {shape};
    try {
      bodyOf(link, 0.01);
      ADD_FAILURE();
    }
    catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("link 'thumb': a ")) << error.what();
    }
  }
}

TEST(LinkBodyTest, OfAVastSphereIsOneBall)
{
  Link link;
  link.shapes = {{Sphere{1e9}, Eigen::Isometry3d::Identity()}};
  EXPECT_EQ(bodyOf(link, 0.001).centers.size(), 1U);
  link.name = "drum";
  for (const double radius : {1e9, 1e30}) {
    link.shapes = {{Cylinder{radius, 1.0}, Eigen::Isometry3d::Identity()}};
    try {
      bodyOf(link, 0.001);
      ADD_FAILURE() << radius;
    }
    catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("link 'drum': a circle of radius "));
    }
  }
}

TEST(LinkBodyTest, OfALinkWithoutBodiesIsEmpty)
{
  EXPECT_EQ(bodyOf({}, 0.01).view().count, 0U);
}

} // namespace
} // namespace pcl_bsh::self_filter
