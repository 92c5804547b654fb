// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/ignored_points.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/question/ask.h>

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct ClassedPoint {
  float x, y, z;
  std::uint8_t classification;
};

const std::vector<RecordField> classed_fields = {{"classification", offsetof(ClassedPoint, classification), 2, 1}};

PointsView viewOfClassed(const std::vector<ClassedPoint>& points)
{
  return viewOf(&points[0].x, points.size(), sizeof(ClassedPoint));
}

Shape classedShape(const std::vector<ClassedPoint>& points)
{
  return {"hall", viewOfClassed(points), classed_fields};
}

std::string refusalOfText(const std::string& text)
{
  try {
    IgnoredPoints::parse(text);
  }
  catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

std::string refusalToCount(const std::vector<ClassedPoint>& points, const std::string& ignored)
{
  try {
    countedPoints(viewOfClassed(points), classed_fields, "hall", IgnoredPoints::parse(ignored));
  }
  catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

/// A floor of class 2 at z = 0, one of class 9 beside it, and a wall of class 6 at x = 4.
std::vector<ClassedPoint> classedHall()
{
  std::vector<ClassedPoint> points;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.004f, 0.004f);
  for (int x = 0; x < 80; ++x)
    for (int y = 0; y < 80; ++y)
      points.push_back({0.05f * static_cast<float>(x), 0.05f * static_cast<float>(y), noise(random),
                        static_cast<std::uint8_t>(y < 60 ? 2 : 9)});
  for (int y = 0; y < 80; ++y)
    for (int z = 1; z < 60; ++z)
      points.push_back({4.0f + noise(random), 0.05f * static_cast<float>(y), 0.05f * static_cast<float>(z), 6});
  return points;
}

/// A box's corners and more of it, on the floor and beside the wall.
std::vector<Point3> machineInHall()
{
  std::vector<Point3> machine;
  for (int i = 0; i < 4000; ++i)
    machine.push_back({3.0 + 0.25 * (i % 5), 1.0 + 0.05 * (i / 5 % 40), 0.01 + 0.1 * (i / 200)});
  return machine;
}

TEST(IgnoredPoints, AreReadAsTheyAreWritten)
{
  for (const char* text : {"", "classification=2", "classification=2,9;box=0,0,-1,5,5.5,1e-300;plane=0,0,1,0.5,0.01",
                           "plane=1,-1,0,0,0;scan=-0.5", "mask=floor of week 12.txt;mask=1,0"})
    EXPECT_EQ(IgnoredPoints::parse(text).text(), text);
  for (const char* text :
       {"classification", "classification=", "=2", "classification=2;", "box=1,2,3", "class=2,x", "box=0,0,1,1,1,0",
        "plane=0,0,0,1,1", "plane=0,0,1,1,-1", "plane=0,0,1,1", "scan=nan", "mask="})
    EXPECT_THAT(refusalOfText(text), HasSubstr("is none: give FIELD=N,N, box=")) << text;
}

TEST(IgnoredPoints, AreOfTheFirstTermTheyMeet)
{
  const std::vector<ClassedPoint> points = {{0, 0, 0, 2}, {0, 0, 0.5f, 6}, {1, 1, 1, 9}, {5, 5, 5, 6}, {NAN, 0, 0, 6}};
  const CountedPoints counted =
      countedPoints(viewOfClassed(points), classed_fields, "hall",
                    IgnoredPoints::parse("classification=2,9;box=-1,-1,-1,0,0,0.5;plane=0,0,2,10,0"));
  EXPECT_THAT(counted.records, ElementsAre(4));
  EXPECT_THAT(counted.ignored, ElementsAre(2u, 1u, 1u));
  EXPECT_EQ(counted.all, 4u);
  PointsView some = viewOfClassed(points);
  const std::int32_t records[] = {3, 0};
  some.restrictTo(records, 2);
  EXPECT_THAT(countedPoints(some, classed_fields, "hall", IgnoredPoints::parse("classification=2")).records,
              ElementsAre(3));
}

TEST(IgnoredPoints, RefuseWhatIsNotThere)
{
  const std::vector<ClassedPoint> points = classedHall();
  EXPECT_EQ(refusalToCount(points, "classification=2,7"),
            "hall: has no point to ignore of 'classification=7': leave it out, or check its numbers, the frame and the "
            "unit");
  EXPECT_THAT(refusalToCount(points, "box=10,10,10,11,11,11"), HasSubstr("of 'box=10,10,10,11,11,11'"));
  EXPECT_THAT(refusalToCount(points, "plane=0,0,1,-1,0.01"), HasSubstr("of 'plane=0,0,1,-1,0.01'"));
  EXPECT_THAT(refusalToCount(points, "class=2"), HasSubstr("hall: field 'class' of points to ignore is missing"));
  EXPECT_EQ(refusalToCount(points, "plane=0,0,1,0,0.005;classification=6"), "");
}

TEST(IgnoredPoints, MayBeMarkedOneByOne)
{
  const std::vector<ClassedPoint> points = {{0, 0, 0, 2}, {1, 0, 0, 6}, {2, 0, 0, 6}, {3, 0, 0, 6}};
  IgnoredPoints ignored = IgnoredPoints::parse("classification=2;mask=marks.txt");
  EXPECT_EQ(
      refusalToCount(points, ignored.text()),
      "ignored points: mask marks.txt is not read: read it before the question is asked, as programs and stages do");
  const auto count = [&](const std::vector<std::uint8_t>& mask) {
    ignored.terms[1].mask = std::make_shared<const std::vector<std::uint8_t>>(mask);
    return countedPoints(viewOfClassed(points), classed_fields, "hall", ignored);
  };
  EXPECT_THAT(count({1, 0, 1, 0}).records, ElementsAre(1, 3));
  EXPECT_THAT(count({1, 0, 1, 0}).ignored, ElementsAre(1u, 1u));
  try {
    count({0, 1, 0});
    FAIL() << "a mask of another length is taken";
  }
  catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "hall: has 4 points, and mask marks.txt has 3 values: give the mask a value for each "
                               "point, in the order of the file");
  }
  EXPECT_THROW(count({1, 0, 0, 0}), InvalidInput) << "the term before has all of its points";
  const IgnoredPoints before = ignored;
  EXPECT_TRUE(ignored == before);
  count({1, 1, 0, 0});
  EXPECT_FALSE(ignored == before) << "what a shape is built with has changed";
}

class IgnoringHall : public testing::Test {
protected:
  IgnoringHall() : whole(classedShape(hall)), machine("machine", viewOf(robot[0].data(), robot.size()))
  {
    question.clearance = 0.1;
    question.wanted.flags = question.wanted.closest = true;
  }

  const std::vector<ClassedPoint> hall = classedHall();
  const std::vector<Point3> robot = machineInHall();
  Shape whole, machine;
  Question question;
};

/// Answers are those of a cloud without these points.
TEST_F(IgnoringHall, AnswersAsWithoutThem)
{
  const std::size_t before = ask(question, whole, machine).collisions.colliding;
  std::vector<ClassedPoint> walls = hall;
  for (ClassedPoint& point : walls)
    if (point.classification != 6) point.x = NAN;
  Shape of_walls = classedShape(walls);
  const Answer expected = ask(question, of_walls, machine);
  question.ignore_points = IgnoredPoints::parse("classification=2,9");
  const Answer found = ask(question, whole, machine);
  EXPECT_EQ(found.collisions.flags, expected.collisions.flags);
  EXPECT_GT(found.collisions.colliding, 0u);
  EXPECT_LT(found.collisions.colliding, before);
  EXPECT_EQ(found.closest.distance, expected.closest.distance);
  EXPECT_EQ(found.closest.pair->a, expected.closest.pair->a);
  std::vector<std::string> texts;
  addTexts(found.warnings, texts);
  EXPECT_THAT(texts, testing::Contains("hall: 6400 of 11120 points do not count: 6400 of classification=2,9"));
  question.path = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.1, 0.0))};
  question.wanted.contacts = true;
  EXPECT_EQ(ask(question, whole, machine).collisions.distance.size(), hall.size());
  EXPECT_EQ(ask(question, whole, machine).collisions.colliding, ask(question, of_walls, machine).collisions.colliding);
  question.path.reset();
  question.wanted = {};
  question.wanted.distances = question.wanted.both_ways = true;
  const SymmetricDistances near = ask(question, whole, machine).distances,
                           of = ask(question, of_walls, machine).distances;
  EXPECT_EQ(near.b.distance, of.b.distance);
  for (std::size_t i = 0; i < hall.size(); ++i)
    EXPECT_EQ(std::isnan(near.a.distance[i]), hall[i].classification != 6) << i;
  question.ignore_points = {};
  question.wanted = {};
  question.wanted.flags = true;
  EXPECT_EQ(ask(question, whole, machine).collisions.colliding, before) << "all count again";
}

/// Spacings are those of the whole cloud.
TEST_F(IgnoringHall, DensityKnowsThem)
{
  whole.hierarchy({}, 1);
  const std::vector<float> spacings = whole.patches(0.2, {}).spacings;
  Shape some = whole;
  some.ignore(IgnoredPoints::parse("classification=2,9"));
  some.hierarchy({}, 1);
  EXPECT_EQ(some.patches(0.2, {}).spacings, spacings);
  ASSERT_NE(some.counted(), nullptr);
  EXPECT_EQ(some.counted()->all, 6400u);
  EXPECT_EQ(whole.counted(), nullptr) << "a copy is another shape";
}

/// The free of the machine that nobody saw are, and whose beams saw it, with the floor or without it.
TEST_F(IgnoringHall, TheirBeamsCount)
{
  question.seen = true;
  question.clearance = 0.02;
  question.origin = ScanOrigins::of({1.0, 1.0, 1.5});
  const Answer of_all = ask(question, whole, machine);
  const std::size_t angles = of_all.unseen.angles.size();
  question.ignore_points = IgnoredPoints::parse("classification=2,9");
  const Answer found = ask(question, whole, machine);
  ASSERT_EQ(found.unseen.angles.size(), angles);
  EXPECT_EQ(found.unseen.angles, of_all.unseen.angles) << "of the same beams";
  std::size_t seen = 0, freed = 0;
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const Verdict before = of_all.obstacle_flags[i], now = found.obstacle_flags[i];
    EXPECT_TRUE(before == Verdict::colliding || now == before) << i;
    seen += now == Verdict::free;
    freed += before == Verdict::colliding && now != Verdict::colliding;
  }
  EXPECT_GT(seen, 0u);
  EXPECT_GT(freed, 0u) << "what stands on the floor";
}

TEST_F(IgnoringHall, RefusesShapesWithoutSuchPoints)
{
  const auto refusal = [&](Shape input) -> std::string {
    try {
      ask(question, input, machine);
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  };
  question.ignore_points = IgnoredPoints::parse("classification=2");
  const auto built = std::make_shared<const SphereHierarchy>(viewOfClassed(hall));
  EXPECT_THAT(refusal({"hall", built}), HasSubstr("hall: is built already, of all its points"));
  const std::uint32_t corners[] = {0, 1, 2};
  EXPECT_THAT(refusal({"mesh", viewOf(TrianglesView{viewOfClassed(hall), corners, 1})}),
              HasSubstr("mesh: is a surface, which has no points to ignore: give `vertices_only`"));
}

/// A shape whose owner may change it notices that other points would count.
TEST_F(IgnoringHall, NoticesChangedFields)
{
  std::vector<ClassedPoint> points = hall;
  Shape shape(
      "hall", [&] { return viewOfClassed(points); }, [] { return classed_fields; });
  shape.ignore(IgnoredPoints::parse("classification=2"));
  const SphereHierarchy* const first = &shape.hierarchy({}, 1);
  EXPECT_EQ(&shape.hierarchy({}, 1), first);
  const std::size_t size = first->view().size();
  points.back().classification = 2;
  EXPECT_EQ(shape.hierarchy({}, 1).view().size(), size - 1);
}

} // namespace
} // namespace pcl_bsh
