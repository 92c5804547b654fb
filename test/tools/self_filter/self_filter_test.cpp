// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/self_filter/self_filter.h>

#include "io/clouds/samples.h"
#include "support/verdicts.h"
#include <examples/robot/made_robot.h>
#include <pcl_bsh/io/robots/read_robot.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
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

/// How often triangles wind round a point, by their solid angles (Van Oosterom and Strackee, The Solid Angle of a Plane
/// Triangle, 1983).
long windingOf(const Surface& surface, const Vector3d& p)
{
  double sum = 0.0;
  for (const Triangle& t : surface.triangles) {
    const auto corner = [&](std::size_t k) -> Vector3d { return Vector3d(surface.vertices[t[k]].data()) - p; };
    const Vector3d a = corner(0), b = corner(1), c = corner(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::lround(sum / (4 * M_PI));
}

/// A shape as it truly is: a solid box, cylinder or sphere, or triangles and what they enclose.
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
      if (out <= 0 && over <= 0) return 0.0;
      return out > 0 && over > 0 ? std::hypot(out, over) : std::max(out, over);
    }
    if (const auto* box = std::get_if<Box>(&shape_.form))
      if ((2 * p.array().abs() <= box->size.array()).all()) return 0.0;
    if (std::holds_alternative<robots::Mesh>(shape_.form) && windingOf(surface_, p) != 0) return 0.0;
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
    robot = io::readRobot(folder / "robot.urdf");
  }

  /// Holds flags of points about the robot against distances to its true shapes.
  void expectFlagged(const Settings& settings) const;

  const io::TemporaryFolder folder;
  Robot robot;
};

TEST_F(SelfFilterTest, FlagsWhatIsWithinThePaddingOfALink)
{
  expectFlagged({0.03, 1});
}

TEST_F(SelfFilterTest, LinksMayHaveAPaddingOfTheirOwn)
{
  Settings settings{0.03, 1};
  for (std::size_t link = 0; link < robot.links.size(); ++link)
    if (link % 3 != 0) settings.paddings[robot.links[link].name] = link % 3 == 1 ? 0.05 : 0.0;
  expectFlagged(settings);
  EXPECT_EQ(SelfFilter(robot, settings).leastPadding(), 0.0);
  EXPECT_EQ(SelfFilter(robot, {0.03, 1}).leastPadding(), 0.03);
  try {
    SelfFilter(robot, {0.03, 1, {{"nose", 0.1}}});
    ADD_FAILURE() << "there is none";
  }
  catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("link 'nose': is not one of "));
  }
}

void SelfFilterTest::expectFlagged(const Settings& settings) const
{
  SelfFilter filter(robot, settings);
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 0x100000000;
  };
  std::vector<std::pair<std::size_t, TrueShape>> shapes; // with their links
  for (std::size_t link = 0; link < robot.links.size(); ++link)
    for (const Shape& shape : robot.links[link].shapes) shapes.emplace_back(link, TrueShape(shape));
  std::size_t flagged = 0, near = 0;
  for (std::size_t frame = 0; frame < 3; ++frame) {
    const JointValues values = madeJointValues(frame, 3);
    const std::vector<Eigen::Isometry3d> poses = linkPoses(robot, values);
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
    const std::vector<Verdict>& flags = filter.flags(viewOf(scan.data(), points.size()), T_scan_root, values);
    ASSERT_EQ(flags.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      double distance = std::numeric_limits<double>::infinity(); // less the padding of the link
      for (const auto& [link, shape] : shapes) {
        const auto own = settings.paddings.find(robot.links[link].name);
        const double padding = own == settings.paddings.end() ? settings.padding : own->second;
        distance = std::min(distance, shape.distanceFrom(poses[link].inverse() * points[i]) - padding);
      }
      constexpr double rounding = 1e-12;
      if (distance <= -rounding) {
        EXPECT_EQ(flags[i], Verdict::colliding) << distance;
      }
      if (distance > rounding) {
        EXPECT_EQ(flags[i], Verdict::free) << distance;
      }
      flagged += flags[i] == Verdict::colliding;
      near += std::abs(distance) < 0.003;
    }
  }
  EXPECT_GT(flagged, 150U);
  EXPECT_LT(flagged, 500U);
  EXPECT_GT(near, 5U);
}

TEST(SelfFilterOfMeshes, TheInsideIsTheRobotWhereAMeshCloses)
{
  const io::TemporaryFolder folder;
  const std::string box = "OFF\n8 6 0\n-1 -1 -1\n1 -1 -1\n-1 1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n"
                          "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n";
  folder.write("closed.off", box + "4 1 3 7 5\n");
  folder.write("open.off", box.substr(0, 6) + "5" + box.substr(7)); // five faces
  const auto robotOf = [&](const char* file, double scale) {
    Robot robot;
    robot.name = "robot";
    Link link;
    link.name = "shoulder";
    link.shapes.push_back(
        {robots::Mesh{folder / file, {scale, 1, 1}}, Eigen::Isometry3d(Eigen::Translation3d(0, 5, 0))});
    robot.links.push_back(link);
    return robot;
  };
  const std::vector<double> scan = {0, 0, 0, 0.9, 0, 0, 1.25, 0, 0, 1.26, 0, 0, 0, 0, 3};
  const Eigen::Isometry3d T_scan_root(Eigen::Translation3d(0, -5, 0));
  for (const double scale : {1.0, -1.0}) { // mirrored, too
    SelfFilter closed(robotOf("closed.off", scale), {0.25, 1});
    EXPECT_TRUE(closed.warnings().empty());
    EXPECT_EQ(closed.solids(), 1u);
    EXPECT_EQ(closed.flags(viewOf(scan.data(), 5), T_scan_root, {}), test::verdictsOf({1, 1, 1, 0, 0}));
  }
  SelfFilter open(robotOf("open.off", 1.0), {0.25, 1});
  ASSERT_EQ(open.warnings().size(), 1u);
  EXPECT_THAT(open.warnings()[0],
              testing::AllOf(testing::StartsWith("link 'shoulder': "), testing::HasSubstr("open.off"),
                             testing::HasSubstr("4 edges are open, the first from (1, ")));
  EXPECT_EQ(open.solids(), 0u);
  EXPECT_EQ(open.flags(viewOf(scan.data(), 5), T_scan_root, {}), test::verdictsOf({0, 0, 0, 0, 0}));
}

TEST_F(SelfFilterTest, CutsOutWhatTheCameraSeesOfTheRobot)
{
  SelfFilter filter(robot, {0.02, 1});
  const JointValues values = madeJointValues(1, 3);
  const DepthImage image = seenBy(robot, values, 160);
  const Eigen::Isometry3d T_camera_root = linkPoses(robot, values)[robot.linkNamed("camera")].inverse();
  const std::vector<Verdict>& flags =
      filter.flags(viewOf(image.xyz.data(), image.xyz.size() / 3), T_camera_root, values);
  const auto seen = std::count(image.is_robot.begin(), image.is_robot.end(), 1);
  const auto cut = std::count(flags.begin(), flags.end(), Verdict::colliding);
  EXPECT_GT(seen, 500);
  EXPECT_LT(cut, 2 * seen);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (image.is_robot[i]) {
      EXPECT_EQ(flags[i], Verdict::colliding) << i;
    }
  }
}

TEST_F(SelfFilterTest, AnswersAlikeForAnyNumberOfThreadsAndFrameBefore)
{
  const DepthImage image = seenBy(robot, madeJointValues(0, 3), 160);
  const PointsView view = viewOf(image.xyz.data(), image.xyz.size() / 3);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  SelfFilter one(robot, {0.02, 1}), all(robot, {0.02, 0});
  all.flags(view, pose, madeJointValues(2, 3));
  EXPECT_EQ(one.flags(view, pose, madeJointValues(1, 3)), all.flags(view, pose, madeJointValues(1, 3)));
  EXPECT_THROW(one.flags(view, pose, {{"nose", 1}}), std::invalid_argument);
}

class SelfFilterOfOneBody : public testing::Test {
protected:
  /// Flags of points of a scan in the robot's own frame.
  static std::vector<Verdict> flags(const Shape& shape, const Settings& settings, const std::vector<Vector3d>& points)
  {
    Robot robot;
    robot.links.resize(1);
    robot.links[0].shapes = {shape};
    SelfFilter filter(robot, settings);
    return filter.flags(viewOf(points[0].data(), points.size()), Eigen::Isometry3d::Identity(), {});
  }

  const Eigen::Isometry3d pose =
      Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(0.8, Vector3d(1, 2, 3).normalized());
};

TEST_F(SelfFilterOfOneBody, CutsOutWhatLiesInsideOfEachSolid)
{
  // An arm's housing holds the sensor's own cables: far from every surface.
  for (const Shape& shape : {Shape{Box{{2, 3, 4}}, pose}, Shape{Cylinder{1, 3}, pose}, Shape{Sphere{1.5}, pose}}) {
    std::vector<Vector3d> points;
    for (double along = -0.75; along <= 0.75; along += 0.125) points.push_back(pose * Vector3d(0.2, along, 0.3));
    for (const Verdict flag : flags(shape, {0.02, 1}, points))
      EXPECT_EQ(flag, Verdict::colliding) << shape.form.index();
  }
}

TEST_F(SelfFilterOfOneBody, RoundsEdgesByThePadding)
{
  const double padding = 0.5, least = 1e-9;
  const double along = padding / std::sqrt(3.0), in_plane = padding / std::sqrt(2.0);
  const auto just = [&](const Shape& shape, const Vector3d& from, const Vector3d& step) {
    const std::vector<Vector3d> points = {pose * (from + (1 - least) * step), pose * (from + (1 + least) * step)};
    EXPECT_EQ(flags(shape, {padding, 1}, points), pcl_bsh::test::verdictsOf({1, 0}))
        << shape.form.index() << ": " << (from + step).transpose();
  };
  const Shape box{Box{{2, 3, 4}}, pose}, tube{Cylinder{1, 3}, pose}, ball{Sphere{1.5}, pose};
  just(box, {1, 1.5, 2}, {along, along, along});
  just(box, {-1, 0.3, -2}, {-in_plane, 0, -in_plane});
  just(box, {0.2, -1.5, 0.1}, {0, -padding, 0});
  just(tube, {0.6, 0.8, 1.5}, {0.6 * in_plane, 0.8 * in_plane, in_plane});
  just(tube, {0.6, -0.8, 0.2}, {0.6 * padding, -0.8 * padding, 0});
  just(tube, {0.1, 0.2, -1.5}, {0, 0, -padding});
  just(ball, {0, -1.5, 0}, {0, -padding, 0});
  const Shape rod{Box{{7, 0.2, 0.3}}, pose}, pipe{Cylinder{0.1, 9}, pose};
  for (double at = -1; at <= 1; at += 0.03125) { // all along slender ones
    just(rod, {3.5 * at, -0.1, 0.15}, {0, -in_plane, in_plane});
    just(pipe, {0.06, 0.08, 4.5 * at}, {0.6 * padding, 0.8 * padding, 0});
  }
}

TEST_F(SelfFilterOfOneBody, CutsOutWhatLiesInsideOfAMesh)
{
  const io::TemporaryFolder folder;
  writeMadeRobot(folder.path());
  const std::vector<Vector3d> points = {pose * Vector3d(0, 0, 0.1), pose * Vector3d(0.12, 0, 0.1)};
  EXPECT_EQ(flags({robots::Mesh{folder / "meshes/turret.stl"}, pose}, {0.02, 1}, points),
            pcl_bsh::test::verdictsOf({1, 1}));
}

TEST(SelfFilterOfNothing, IsAnError)
{
  Robot robot;
  robot.name = "ghost";
  robot.links.resize(2);
  try {
    SelfFilter(robot, {});
    ADD_FAILURE();
  }
  catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("robot 'ghost': has no body"));
  }
}

TEST(LinkBodyTest, NamesTheLinkThatHasNoSize)
{
  for (const Shape& shape : {Shape{Box{{1, 0, 1}}}, Shape{Cylinder{0.1, -1}}, Shape{Sphere{std::nan("")}}}) {
    Link link;
    link.name = "thumb";
    link.shapes = {shape};
    try {
      bodyOf(link);
      ADD_FAILURE();
    }
    catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("link 'thumb': a ")) << error.what();
    }
  }
}

TEST(LinkBodyTest, OfVastSolidsIsAFewBallsToLookIn)
{
  Link link;
  link.name = "drum";
  for (const double size : {1e9, 1e30}) {
    link.shapes = {{Sphere{size}}, {Cylinder{size, 1.0}}, {Box{{1.0, size, 1.0}}}};
    const LinkBody body = bodyOf(link);
    EXPECT_EQ(body.enclosing.centers.size(), 1U + 1U + 64U);
    EXPECT_TRUE(body.surface.triangles.empty());
    for (const float radius : body.enclosing.radii) EXPECT_TRUE(std::isfinite(radius));
  }
  link.shapes = {{Cylinder{1e31, 1.0}}};
  EXPECT_THROW(bodyOf(link), std::runtime_error);
}

TEST(LinkBodyTest, OfALinkWithoutBodiesIsEmpty)
{
  const LinkBody body = bodyOf({});
  EXPECT_EQ(body.surface.view().count + body.enclosing.view().count + body.solids.size(), 0U);
}

} // namespace
} // namespace pcl_bsh::self_filter
