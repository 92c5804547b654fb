// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/scene_warnings.h>
#include <pcl_bsh/question/warnings/warnings.h>

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::vector<std::string> textsOf(const std::vector<Warning>& warnings)
{
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.text);
  return texts;
}

TEST(Density, CouldHideWhatIsBetweenTheScannedPointsOfBoth)
{
  const auto of = [](std::optional<std::size_t> input, std::optional<std::size_t> obstacle) {
    Density density;
    if (input) density.input = Spacing{*input, 1.0, 1.0};
    if (obstacle) density.obstacle = Spacing{*obstacle, 1.0, 1.0};
    return density;
  };
  const std::optional<std::size_t> surface, few = 99, scan = 100;
  EXPECT_NEAR(of(scan, scan).blind(), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(of(surface, scan).blind(), std::sqrt(0.5), 1e-15);
  for (const auto& input : {surface, few, scan})
    for (const auto& obstacle : {surface, few, scan}) {
      const bool is_scanned = (input || obstacle) && input != few && obstacle != few;
      EXPECT_EQ(of(input, obstacle).couldHide(0.5), is_scanned);
      EXPECT_FALSE(of(input, obstacle).couldHide(1.5));
    }
}

/// A plane of n * n points, one apart, its least corner at (x, 0, 0).
std::vector<float> plane(int n, float x = 0)
{
  std::vector<float> xyz;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) xyz.insert(xyz.end(), {x + static_cast<float>(i), static_cast<float>(j), 0.0f});
  return xyz;
}

struct Cloud {
  std::vector<float> xyz;
  SphereHierarchy hierarchy{viewOf(xyz.data(), xyz.size() / 3)};

  explicit Cloud(std::vector<float> points) : xyz(std::move(points)) {}

  NamedCloud named(const std::string& name, bool measured = false) const
  {
    return measured ? measuredCloud(name, hierarchy) : namedCloud(name, hierarchy);
  }
};

Eigen::Isometry3d at(double x)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = x;
  return pose;
}

Question question(const std::vector<Eigen::Isometry3d>& poses, std::optional<double> clearance)
{
  Question question;
  question.path = poses;
  question.clearance = clearance;
  return question;
}

TEST(Warnings, NoneOfCloudsThatAreInOrder)
{
  const Cloud a(plane(12)), b(plane(12, 3));
  EXPECT_THAT(warningsOf(question({at(0)}, 2.0), a.named("a", true), b.named("b", true)), IsEmpty());
  EXPECT_THAT(warningsOf(question({at(0)}, 0.5), a.named("a"), b.named("b")), IsEmpty())
      << "nobody has measured spacings";
}

TEST(Warnings, EmptyClouds)
{
  const Cloud a(plane(3)), nothing({}), no_numbers({nan, 0, 0, 0, nan, 0});
  for (const Cloud* empty : {&nothing, &no_numbers}) {
    EXPECT_THAT(textsOf(warningsOf(question({at(0)}, 0.5), a.named("a"), empty->named("b"))),
                ElementsAre("b: has no finite point: nothing collides with it"));
    EXPECT_THAT(textsOf(warningsOf(question({at(0)}, {}), empty->named("a"), a.named("b"))),
                ElementsAre("a: has no finite point: nothing has a distance from it"));
  }
}

TEST(Warnings, PointsThatAreNotFinite)
{
  const Cloud one({0, 0, 0, nan, 0, 0}), two({0, 0, 0, nan, 0, 0, 1, 0, nan});
  EXPECT_THAT(textsOf(warningsOf(question({at(0)}, 0.5), one.named("a"), two.named("b"))),
              ElementsAre("a: 1 of 2 points is not finite: it is left out",
                          "b: 2 of 3 points are not finite: they are left out"));
}

/// float32 coordinates at 500 km lie 1/32 apart.
TEST(Warnings, CoarseCoordinates)
{
  const Cloud far(plane(12, 500000)), near(plane(12));
  const auto told = [&](double clearance) {
    return textsOf(warningsOf(question({at(500000)}, clearance), far.named("a"), near.named("b")));
  };
  EXPECT_THAT(told(0.3), ElementsAre(HasSubstr("a: its float32 coordinates lie 0.03125 apart, coarse for a clearance "
                                               "of 0.3: ")));
  EXPECT_THAT(told(0.32), IsEmpty());
  EXPECT_THAT(told(0.0), IsEmpty());
  const std::vector<double> wide(far.xyz.begin(), far.xyz.end());
  const SphereHierarchy float64(viewOf(wide.data(), wide.size() / 3));
  EXPECT_THAT(warningsOf(namedCloud("a", float64), 0.001), IsEmpty());
}

TEST(Warnings, SurfacesHaveCornersAndNoHoles)
{
  const std::vector<float> corners = {500000, 0, 0, 500030, 0, 0, 500000, 30, 0, 9, 9, 9, nan, 0, 0};
  const std::vector<Triangle> triangles(120, Triangle{0, 1, 2});
  const TrianglesView view{viewOf(corners.data(), 5), triangles[0].data(), triangles.size()};
  const NamedCloud surface = measuredCloud("mesh", SphereHierarchy(viewOf(view)));
  EXPECT_EQ(surface.coordinate_spacing, 0.03125);
  EXPECT_FALSE(surface.spacing);
  EXPECT_TRUE(surface.is_surface);

  const Cloud scan(plane(12));
  EXPECT_THAT(textsOf(warningsOf(question({at(-500000)}, 0.25), scan.named("scan", true), surface)),
              ElementsAre("mesh: 1 of its vertices belongs to no face: it is no part of the surface that is compared",
                          HasSubstr("mesh: its float32 coordinates"),
                          "points lie 1 apart in scan: what was scanned may touch the surface of mesh with no point "
                          "within the clearance of 0.25: scan more densely, or give a clearance of 0.707107 at least"));
  EXPECT_THAT(warningsOf(question({at(0)}, 0.5), surface, surface), testing::SizeIs(1)) << "of the loose vertex";
}

/// A large floor of two triangles, whose middles are one place.
TEST(Warnings, SurfacesAreAsLargeAsTheirCorners)
{
  const std::vector<float> corners = {0, 0, 0, 100, 0, 0, 100, 100, 0, 0, 100, 0};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
  const TrianglesView view{viewOf(corners.data(), 4), triangles[0].data(), 2};
  const NamedCloud floor = namedCloud("floor", SphereHierarchy(viewOf(view)));
  EXPECT_EQ(floor.box.max(), Eigen::Vector3d(100, 100, 0));
  const Cloud robot(plane(2, 5));
  EXPECT_THAT(warningsOf(question({at(0)}, 0.5), robot.named("robot"), floor), IsEmpty());
}

TEST(Warnings, TrianglesThatAreNotFinite)
{
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0};
  const auto told = [&](const std::vector<Triangle>& triangles) {
    const TrianglesView view{viewOf(corners.data(), 4), triangles[0].data(), triangles.size()};
    return textsOf(warningsOf(namedCloud("mesh", SphereHierarchy(viewOf(view))), 0.1));
  };
  EXPECT_THAT(told({{0, 1, 2}, {0, 1, 3}}), ElementsAre("mesh: 1 of 2 triangles is not finite: it is left out"));
  EXPECT_THAT(told({{0, 1, 2}, {0, 1, 3}, {1, 2, 3}}),
              ElementsAre("mesh: 2 of 3 triangles are not finite: they are left out"));
  EXPECT_THAT(told({{0, 1, 3}}), testing::Contains("mesh: has no finite triangle: nothing collides with it"));
}

TEST(Warnings, HolesBetweenPoints)
{
  const Cloud a(plane(12)), b(plane(12, 3)), few(plane(9));
  const auto told = [&](const Cloud& first, const Cloud& second, double clearance) {
    return textsOf(warningsOf(question({at(0)}, clearance), first.named("a", true), second.named("b", true)));
  };
  EXPECT_THAT(told(a, b, 1.4), ElementsAre("points lie 1 apart in a and 1 in b: surfaces may touch with no two points "
                                           "within the clearance of 1.4: scan more densely, or give a clearance of "
                                           "1.41421 at least"));
  EXPECT_THAT(told(a, b, 1.42), IsEmpty());
  EXPECT_THAT(told(a, few, 0.5), IsEmpty()) << "less than a hundred points are no scan";
}

TEST(Warnings, OneCloudTwiceIsToldOnce)
{
  std::vector<float> xyz = plane(12, 500000);
  xyz.insert(xyz.end(), {nan, 0, 0});
  const Cloud a(xyz);
  EXPECT_THAT(textsOf(warningsOf(question({at(0)}, 0.25), a.named("a", true), a.named("a", true))),
              ElementsAre(HasSubstr("a: 1 of 145 points"), HasSubstr("a: its float32 coordinates"),
                          HasSubstr("points lie 1 apart in a: surfaces may touch")));
  std::vector<std::string> texts = {"b"};
  addTexts({{WarningKind::empty, "a"}, {WarningKind::empty, "b"}, {WarningKind::empty, "a"}}, texts);
  EXPECT_THAT(texts, ElementsAre("b", "a"));
}

/// A wagon that stays in another coordinate system than its tunnel.
TEST(Warnings, FramesThatNeverMeet)
{
  const Cloud tunnel(plane(31)), wagon(plane(4));
  const auto told = [&](const std::vector<Eigen::Isometry3d>& poses) {
    return textsOf(warningsOf(question(poses, 0.05), tunnel.named("tunnel"), wagon.named("wagon")));
  };
  EXPECT_THAT(
      told({at(5e6), at(5e6 + 10)}),
      ElementsAre(
          "the boxes of tunnel and of wagon, with all of its motion, are 4.99997e+06 apart, and neither "
          "is larger than 42.4264: check that both have one coordinate system and one unit (--obstacle-unit converts), "
          "and that poses lead from the frame of wagon to that of tunnel"));
  EXPECT_THAT(told({at(5e6), at(10)}), IsEmpty()) << "it comes from afar";
  EXPECT_THAT(told({at(-300), at(-400)}), IsEmpty()) << "within ten diagonals";
  EXPECT_THAT(told({at(-1000)}), testing::SizeIs(1));
  const Cloud place({0, 0, 0});
  EXPECT_THAT(warningsOf(question({at(7)}, 0.5), place.named("a"), place.named("b")), IsEmpty())
      << "places have no size";
  EXPECT_THAT(warningsOf(question({at(1000)}, 5000.0), tunnel.named("a"), wagon.named("b")), IsEmpty())
      << "it may collide";
  EXPECT_THAT(warningsOf(question({at(1000)}, {}), tunnel.named("a"), wagon.named("b")), testing::SizeIs(1))
      << "distances";
}

/// Both stand far from the origin of a world.
TEST(Warnings, PosesOfTheInputCount)
{
  const Cloud tunnel(plane(31)), wagon(plane(4));
  Question far = question({at(5e6)}, 0.05);
  far.pose_of_input = at(5e6);
  EXPECT_THAT(warningsOf(far, tunnel.named("tunnel"), wagon.named("wagon")), IsEmpty());
  far.pose_of_input = at(-5e6);
  EXPECT_THAT(warningsOf(far, tunnel.named("tunnel"), wagon.named("wagon")), testing::SizeIs(1));
}

TEST(Warnings, BoxesAlongAPathHoldTurnedPoints)
{
  const Cloud bar({0, 0, 0, 2, 0, 0});
  Eigen::Isometry3d turned(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
  const Eigen::AlignedBox3d box = boxAlong(bar.named("bar").box, {at(5), turned});
  EXPECT_TRUE(box.contains(Eigen::Vector3d(7, 0, 0)));
  EXPECT_TRUE(box.contains(Eigen::Vector3d(0, 2, 0)));
  EXPECT_LT(box.max().y(), 2.001);
  EXPECT_TRUE(boxAlong(Cloud({}).named("empty").box, {at(0)}).isEmpty());
}

TEST(Warnings, AnglesInDegrees)
{
  EXPECT_EQ(warningOfAngles(0, 0, 12.5), std::nullopt);
  EXPECT_EQ(warningOfAngles(0, 12.6, 0)->substr(0, 26), "an angle of 12.6 radians i");
  EXPECT_THAT(*warningOfAngles(0, 0, -90), HasSubstr("90 degrees are 1.5708"));
  EXPECT_TRUE(warningOfAngles(90, 0, 0));
}

TEST(Warnings, StreamsHearEachKindOnce)
{
  const Cloud a(plane(3)), nothing({}), gaps({0, 0, 0, nan, 0, 0});
  WarningsOnce once;
  const auto told = [&](const Cloud& input, const Cloud& obstacle) {
    return textsOf(once.unheard(warningsOf(question({at(0)}, 0.5), input.named("a"), obstacle.named("b"))));
  };
  EXPECT_THAT(told(a, a), IsEmpty());
  EXPECT_THAT(told(gaps, gaps), testing::SizeIs(2)) << "of both clouds of one question";
  EXPECT_THAT(told(a, gaps), IsEmpty());
  EXPECT_THAT(told(a, nothing), ElementsAre(HasSubstr("b: has no finite point")));
  EXPECT_THAT(told(nothing, a), IsEmpty());
}

/// A machine in millimetres in a scan in metres: it holds the scan, and is not far from it.
TEST(Warnings, OfUnitsThatDiffer)
{
  const auto scaled = [](std::vector<float> xyz, double by) {
    for (float& x : xyz) x = static_cast<float>(by * static_cast<double>(x));
    return Cloud(std::move(xyz));
  };
  const Cloud scan(plane(12)), machine = scaled(plane(3), 1000.0), small = scaled(plane(3), 0.05),
                               smaller = scaled(plane(3), 0.06), place(std::vector<float>{1, 1, 1});
  const auto told = [&](const Cloud& input, const Cloud& obstacle, std::optional<double> clearance = 0.5) {
    return textsOf(warningsOf(question({at(0)}, clearance), input.named("scan.pcd"), obstacle.named("machine.off")));
  };
  EXPECT_THAT(told(scan, machine),
              ElementsAre("machine.off is 182 times as large as scan.pcd: their boxes have diagonals "
                          "of 2828.43 and 15.5564: if one is in millimetres "
                          "and the other in metres, say, name both units: --input-unit and --obstacle-unit, or `unit` "
                          "and `to_unit` where a file is read"));
  EXPECT_THAT(told(machine, scan), ElementsAre(HasSubstr("scan.pcd is 182 times as large as machine.off: ")));
  EXPECT_THAT(told(scan, machine, std::nullopt), testing::SizeIs(1)) << "of distances, too";
  EXPECT_THAT(told(scan, small), ElementsAre(HasSubstr("scan.pcd is 110 times as large as machine.off: ")));
  EXPECT_THAT(told(scan, smaller), IsEmpty()) << "92 times";
  EXPECT_THAT(told(scan, scan), IsEmpty());
  EXPECT_THAT(told(scan, place), IsEmpty()) << "a place has no size";
  EXPECT_THAT(told(place, place), IsEmpty());
  const auto far = textsOf(warningsOf(question({at(1e6)}, 0.5), scan.named("a"), machine.named("b")));
  EXPECT_THAT(far, ElementsAre(HasSubstr("one coordinate system and one unit"))) << "which names units";
}

NamedObject named(const std::string& name, const std::string& cloud, double x, bool fixed = false)
{
  NamedObject made;
  made.name = name;
  made.fixed = fixed;
  made.parts = {{cloud, at(0)}};
  made.pose = at(x);
  return made;
}

/// A scene: a wall, and a cart that moves.
struct WallAndCart {
  Cloud wall{plane(31)}, cart{plane(4)};
  std::map<std::string, NamedCloud> clouds = {{"wall", wall.named("wall")}, {"cart", cart.named("cart")}};
  std::vector<NamedObject> objects = {named("wall", "wall", 0, true), named("cart", "cart", 0)};

  std::vector<std::string> told(std::optional<double> duration = 1.0) const
  {
    return warningsOf(objects, clouds, 0.05, duration);
  }
};

TEST(SceneWarnings, OfObjectsThatNeverMeet)
{
  WallAndCart scene;
  EXPECT_THAT(scene.told(), IsEmpty());
  scene.objects[1].pose = at(5e6);
  EXPECT_THAT(scene.told(),
              ElementsAre(testing::AllOf(HasSubstr("'wall'"), HasSubstr("'cart'"), HasSubstr("4.99997e+06"))));
  scene.objects[1].fixed = true;
  EXPECT_THAT(scene.told(), IsEmpty()) << "neither moves";
  scene.objects[1].fixed = false;
  scene.objects[1].motion = VelocityMotion{{-5e6, 0, 0}};
  EXPECT_THAT(scene.told(1.0), IsEmpty()) << "it comes";
  EXPECT_THAT(scene.told(1e-9), testing::SizeIs(1));
  EXPECT_THAT(scene.told(0.0), testing::SizeIs(1));
  EXPECT_THAT(scene.told(std::nullopt), IsEmpty()) << "nobody knows for how long";
  scene.objects[0].fixed = false;
  scene.objects[1].fixed = true;
  EXPECT_THAT(scene.told(1.0), testing::SizeIs(1)) << "what is fixed does not move, whatever its motion is";
  EXPECT_THAT(scene.told(std::nullopt), testing::SizeIs(1));
}

/// Several objects each that are far from all others, before it and behind it.
TEST(SceneWarnings, OfObjectsFarFromTheOthers)
{
  WallAndCart scene;
  for (const auto& [count, lost] : {std::pair(3u, 0u), {3u, 1u}, {3u, 2u}, {4u, 0u}, {4u, 1u}, {4u, 2u}, {4u, 3u}}) {
    scene.objects.clear();
    for (std::size_t i = 0; i < count; ++i)
      scene.objects.push_back(
          named("object " + std::to_string(i), "cart", i == lost ? 5e6 : 3.0 * static_cast<double>(i)));
    EXPECT_THAT(scene.told(), ElementsAre(testing::AllOf(HasSubstr("the other objects"),
                                                         HasSubstr("'object " + std::to_string(lost) + "'"))));
  }
}

/// Warns of the two whose sizes differ most, where one of them moves.
TEST(SceneWarnings, OfUnitsThatDiffer)
{
  WallAndCart scene;
  const auto scaled = [](double by) {
    std::vector<float> xyz = plane(4);
    for (float& x : xyz) x = static_cast<float>(by * static_cast<double>(x));
    return Cloud(std::move(xyz));
  };
  const Cloud large = scaled(2000.0), larger = scaled(4000.0);
  scene.clouds["crane"] = large.named("crane.off");
  scene.clouds["bridge"] = larger.named("bridge.off");
  EXPECT_THAT(scene.told(), IsEmpty()) << "of clouds that no object has";
  scene.objects.push_back(named("crane", "crane", 0));
  EXPECT_THAT(scene.told(), ElementsAre(HasSubstr("crane.off is 2000 times as large as cart: ")));
  scene.objects.push_back(named("bridge", "bridge", 0));
  EXPECT_THAT(scene.told(), ElementsAre(HasSubstr("bridge.off is 4000 times as large as cart: ")));
  for (NamedObject& object : scene.objects) object.fixed = true;
  EXPECT_THAT(scene.told(), IsEmpty());
}

/// Where effects are about pairs.
TEST(SceneWarnings, OfNoPairs)
{
  const auto told = [](const std::vector<bool>& fixed, Effects effects, const std::vector<bool>& tested = {}) {
    SceneOptions options;
    options.effects = effects;
    Scene scene(options);
    const Cloud cloud(plane(2));
    const auto hierarchy = std::make_shared<SphereHierarchy>(viewOf(cloud.xyz.data(), cloud.xyz.size() / 3));
    for (std::size_t i = 0; i < fixed.size(); ++i)
      scene.add(fixed[i] ? fixedObject(std::to_string(i), hierarchy) : object(std::to_string(i), hierarchy));
    for (const bool rule : tested) scene.setRule(0, 1, {rule, {}});
    EXPECT_EQ(warningOfNoPairs(scene).has_value() || effects.none() || fixed.empty(), !scene.testsPairs());
    return warningOfNoPairs(scene).value_or("");
  };
  Effects any, response, none;
  any.any = true;
  response.response = Response::slide;
  EXPECT_EQ(told({true, true, true}, any), "no pair of objects is tested: all 3 objects are fixed: do not fix what "
                                           "moves, or give a rule that tests them");
  EXPECT_EQ(told({true}, response),
            "no pair of objects is tested: there is one object, and nothing that it could meet");
  EXPECT_EQ(told({false, true}, any, {false}),
            "no pair of objects is tested: rules leave out all of them: give a rule that tests two objects");
  EXPECT_EQ(told({true, true}, any, {true}), "");
  EXPECT_EQ(told({true, false}, any), "");
  EXPECT_EQ(told({true, true}, none), "");
  EXPECT_EQ(told({}, any), "");
}

TEST(SceneWarnings, OfHolesBetweenPointsOfWhatMayMeet)
{
  WallAndCart scene;
  std::vector<float> twofold = plane(12);
  for (float& x : twofold) x *= 2.0f;
  const Cloud coarse(twofold), finer(plane(12));
  scene.clouds = {{"a", coarse.named("a", true)}, {"b", finer.named("b", true)}, {"c", finer.named("c", true)}};
  scene.objects = {named("one", "b", 0), named("two", "c", 0)};
  ASSERT_THAT(scene.told(), testing::SizeIs(1));
  EXPECT_THAT(scene.told()[0], testing::AllOf(HasSubstr("b"), HasSubstr("c")));
  const std::string of_finer = scene.told()[0];
  scene.objects.push_back(named("three", "a", 0, true));
  ASSERT_THAT(scene.told(), testing::SizeIs(1)) << "of the two with the widest holes";
  EXPECT_NE(scene.told()[0], of_finer);
  for (NamedObject& object : scene.objects) object.fixed = true;
  EXPECT_THAT(scene.told(), IsEmpty()) << "nothing moves";
  scene.objects = {named("alone", "a", 0)};
  scene.objects[0].parts.emplace_back("b", at(0));
  EXPECT_THAT(scene.told(), IsEmpty()) << "parts of one object";
}

} // namespace
} // namespace pcl_bsh
