// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/shape.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/neighbors/patch_spacings.h>

#include <gmock/gmock.h>

#include <memory>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Record {
  float x, y, z, sigma;
};

class WatchedShape : public testing::Test {
protected:
  WatchedShape()
  {
    for (int i = 0; i < 400; ++i)
      records.push_back({static_cast<float>(i % 20), static_cast<float>(i / 20), 0.0f, 0.1f});
    shape = Shape(
        "floor", [this] { return viewOf(&records[0].x, records.size(), sizeof(Record)); },
        [] {
          return std::vector<RecordField>{{"sigma", offsetof(Record, sigma), 7, 1}};
        });
  }

  const SphereHierarchy& hierarchy(const Uncertainty& uncertainty = {}) { return shape.hierarchy(uncertainty, 1); }

  void expectChanged(const Uncertainty& uncertainty = {})
  {
    EXPECT_THAT([&] { hierarchy(uncertainty); },
                ThrowsMessage<InvalidInput>(HasSubstr("floor: has changed since it was set: set it again")));
  }

  std::vector<Record> records;
  Shape shape;
};

TEST_F(WatchedShape, IsBuiltOnceForAnUncertainty)
{
  const SphereHierarchy* const first = &hierarchy();
  EXPECT_EQ(&hierarchy(), first);
  Shape copy = shape;
  EXPECT_EQ(&copy.hierarchy({}, 1), first) << "shared";
  EXPECT_EQ(hierarchy(0.25).view().uncertainty, 0.25);
  EXPECT_EQ(hierarchy(Uncertainty("sigma", 2.0)).view().uncertainties[3], 0.2f);
  EXPECT_EQ(&copy.hierarchy({}, 1), first);
}

TEST_F(WatchedShape, RefusesPointsThatHaveChanged)
{
  hierarchy();
  records[7].y += 1.0f;
  expectChanged();
  expectChanged(0.5);
  records[7].y -= 1.0f;
  EXPECT_NO_THROW(hierarchy());
  records[7].sigma = 1.0f;
  EXPECT_NO_THROW(hierarchy()) << "nobody has asked for it";
  hierarchy(Uncertainty("sigma", 1.0));
  records[7].sigma = 2.0f;
  expectChanged(Uncertainty("sigma", 1.0));
}

TEST_F(WatchedShape, MeasuresOnce)
{
  const SphereHierarchy& built = hierarchy();
  const Shape::Patches* const usual = &shape.patches({}, 1);
  EXPECT_EQ(usual->gap, usualGap(built));
  EXPECT_EQ(usual->spacings, patchSpacings(built, usual->gap));
  EXPECT_EQ(&shape.patches({}, 1), usual);
  EXPECT_EQ(shape.patches(0.5, 1).gap, 0.5);
  EXPECT_FALSE(shape.facts(false).spacing);
  EXPECT_EQ(shape.facts(true).spacing->median, 1.0);
}

TEST(Shape, OfOnePlaceHasNoPatches)
{
  const std::vector<float> xyz = {1, 2, 3, 1, 2, 3};
  Shape shape("place", viewOf(xyz.data(), 2));
  shape.hierarchy({}, 1);
  EXPECT_EQ(shape.patches({}, 1).gap, 0.0);
  EXPECT_TRUE(shape.patches({}, 1).spacings.empty());
}

/// Neither a vertex nor a corner's number may change.
TEST(Shape, OfTrianglesIsWatchedToo)
{
  std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  std::vector<Triangle> triangles = {{0, 1, 2}};
  const PointsView view = viewOf(TrianglesView{viewOf(xyz.data(), 4), triangles[0].data(), 1});
  Shape shape(
      "plate", [view] { return view; }, [] { return std::vector<RecordField>(); });
  EXPECT_TRUE(shape.isSurface());
  EXPECT_EQ(shape.hierarchy({}, 1).size(), 1u);
  EXPECT_EQ(shape.facts(true).loose, 1u);
  EXPECT_FALSE(shape.facts(true).spacing);
  xyz[4] = 0.5f;
  EXPECT_THAT([&] { shape.hierarchy({}, 1); }, ThrowsMessage<InvalidInput>(HasSubstr("plate: has changed")));
  xyz[4] = 0.0f;
  EXPECT_NO_THROW(shape.hierarchy({}, 1));
  triangles[0][1] = 3;
  EXPECT_THAT([&] { shape.hierarchy({}, 1); }, ThrowsMessage<InvalidInput>(HasSubstr("plate: has changed")));
}

TEST(Shape, HasNoUncertaintiesOfFieldsThatThereAreNot)
{
  const std::vector<Record> points(2, Record{0, 0, 0, 0.1f});
  const PointsView view = viewOf(&points[0].x, points.size(), sizeof(Record));
  const auto ask = [](Shape shape) { shape.hierarchy(Uncertainty("sigma", 1.0), 1); };
  EXPECT_THAT([&] { ask(Shape("a", view)); }, ThrowsMessage<InvalidInput>(HasSubstr("field 'sigma'")));
  EXPECT_THAT(
      [&] {
        ask(Shape("a", view, {{"sigma", sizeof(Record) - 1, 7, 1}}));
      },
      ThrowsMessage<InvalidInput>(HasSubstr("field 'sigma' reaches beyond its record")));
  const auto beyond = [] { return std::vector<RecordField>{{"sigma", sizeof(Record) - 1, 7, 1}}; };
  EXPECT_THAT(
      [&] {
        ask(Shape(
            "a", [&] { return view; }, beyond));
      },
      ThrowsMessage<InvalidInput>(HasSubstr("field 'sigma' reaches beyond its record")));
}

TEST(Shape, ThatIsNothing)
{
  Shape nothing;
  EXPECT_FALSE(nothing);
  EXPECT_THAT([&] { nothing.hierarchy({}, 1); }, ThrowsMessage<InvalidInput>("a cloud: is missing: give one"));
  Shape missing("the scan", std::shared_ptr<const SphereHierarchy>());
  EXPECT_FALSE(missing);
  EXPECT_THAT([&] { missing.hierarchy({}, 1); }, ThrowsMessage<InvalidInput>("the scan: is missing: give one"));
  EXPECT_TRUE(Shape("empty", PointsView()));
}

TEST(Shape, ThatIsBuiltAlready)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0};
  const auto built = std::make_shared<const SphereHierarchy>(viewOf(xyz.data(), 2));
  Shape shape("pair", built);
  EXPECT_EQ(&shape.hierarchy({}, 1), built.get());
  EXPECT_THROW(shape.hierarchy(0.1, 1), InvalidInput) << "they are those of its points";
  Uncertainty of_pose;
  of_pose.pose.angle = 0.1;
  EXPECT_THROW(shape.hierarchy(of_pose, 1), InvalidInput);
  EXPECT_FALSE(shape.isSurface());
  EXPECT_EQ(shape.facts(false).points, 2u);
}

/// It has no fields that would number several scans.
TEST(Shape, ThatIsBuiltAlreadyIsAScanOfOneOrigin)
{
  std::vector<float> xyz;
  for (int i = 0; i < 400; ++i)
    xyz.insert(xyz.end(), {10.0f, 0.1f * static_cast<float>(i % 20), 0.1f * static_cast<float>(i / 20)});
  const PointsView view = viewOf(xyz.data(), 400);
  Shape built("wall", std::make_shared<const SphereHierarchy>(view)), points("wall", view);
  points.hierarchy({}, 1);
  const ScanOrigins origin = ScanOrigins::of({0, 0, 0});
  EXPECT_GT(built.seen(origin, {}, 1).angle(0), 0.01);
  EXPECT_EQ(built.seen(origin, {}, 1).angle(0), points.seen(origin, {}, 1).angle(0));
  EXPECT_THAT([&] { built.seen(ScanOrigins::parse("scan:1=0,0,0"), {}, 1); },
              ThrowsMessage<InvalidInput>(HasSubstr("wall: field 'scan' that numbers its scans is missing")));
}

TEST(Shape, TakesPatchesThatItsOwnerHasMeasured)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0};
  Shape shape("pair", viewOf(xyz.data(), 2));
  shape.hierarchy({}, 1);
  shape.setPatches({0.5f, 0.25f});
  EXPECT_THAT(shape.patches({}, 1).spacings, testing::ElementsAre(0.5f, 0.25f));
  EXPECT_EQ(shape.patches({}, 1).gap, 0.0) << "which nobody has told";
  EXPECT_EQ(shape.patches(3.0, 1).gap, 3.0);
  EXPECT_EQ(shape.patches(3.0, 1).spacings, patchSpacings(shape.hierarchy(), 3.0));
}

TEST(Shape, CopiesMeasureSpacingsOnce)
{
  std::vector<float> xyz = {0, 0, 0, 1, 0, 0}, wider = {0, 0, 0, 3, 0, 0};
  const auto built = std::make_shared<SphereHierarchy>(viewOf(xyz.data(), 2));
  const Shape shape("pair", built), copy = shape.named("the same");
  EXPECT_EQ(copy.name(), "the same");
  EXPECT_EQ(copy.facts(true).spacing->median, 1.0);
  built->refit(viewOf(wider.data(), 2)); // which would be seen by who measures again
  EXPECT_EQ(shape.facts(true).spacing->median, 1.0);
  EXPECT_EQ(Shape("pair", built).facts(true).spacing->median, 3.0);
}

TEST(Shape, BallsHaveNoSpacings)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0}, radii = {0.1f, 0.2f};
  PointsView balls = viewOf(xyz.data(), 2);
  balls.radii = radii.data();
  EXPECT_FALSE(Shape("balls", std::make_shared<SphereHierarchy>(balls)).facts(true).spacing);
}

} // namespace
} // namespace pcl_bsh
