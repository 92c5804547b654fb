// SPDX-License-Identifier: BSD-3-Clause
// Pictures of the viewer, pixel by pixel; without a display.
#include "pixels.h"
#include "support/verdicts.h"

#include <pcl_bsh/tools/viewer/content/clouds_content.h>

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/vtk/hierarchy_data.h>

#include <gmock/gmock.h>

#include <vtkDataArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>

namespace pcl_bsh::viewer {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Picture : public ViewTest {
protected:
  Picture() { unsetenv("DISPLAY"); }

  /// The picture of a program's run.
  Pixels drawn(const std::string& arguments) const
  {
    const Outcome done = run("pcl_bsh_view", arguments + " --size 400x300 --screenshot " + (folder / "p.png").string());
    EXPECT_EQ(done.exit_code, 0) << arguments << '\n' << done.err;
    return readPng(folder / "p.png");
  }

  Options options() const
  {
    Options made;
    made.clouds = {floor};
    made.model = ball;
    made.question.pose.translation() = Eigen::Vector3d(-0.5, 0.5, 0.2);
    made.question.clearance = 0.1;
    made.width = 400;
    made.height = 300;
    made.camera.kind = Camera::Kind::top;
    made.question.threads = 1;
    return made;
  }
};

TEST_F(Picture, MarksWhatCollidesWhereItIs)
{
  Options touching = options();
  OffscreenView set(touching);
  const Pixels pixels = set.draw();
  ASSERT_GT(set.view->collisions().colliding, 0u);
  EXPECT_GT(pixels.count(scan_color, 60), 1000u) << "the floor, shaded";
  EXPECT_GT(pixels.count(ground), 1000u);

  // Seen from above, the ball hides its contact; from below it cannot.
  touching.camera.kind = Camera::Kind::given;
  touching.camera.eye = {0, 0, -6};
  touching.camera.focus = {0, 0, 0};
  touching.camera.up = {0, 1, 0};
  OffscreenView below(touching);
  const Pixels under = below.draw();
  const double contact[3] = {-0.5, 0.5, 0.0};
  const auto [x, y] = below.seen(contact);
  EXPECT_GT(under.countNear(colliding_color, x, y, 30), 200u) << "around the ball's dip";
  EXPECT_GT(under.countNear(colliding_color, x, y, 40), under.count(colliding_color) * 3 / 4) << "legend apart";
  touching.question.pose.translation().z() = 2.0;
  OffscreenView apart(touching);
  ASSERT_EQ(apart.view->collisions().colliding, 0u);
  EXPECT_EQ(apart.draw().countNear(colliding_color, x, y, 40), 0u);
}

TEST_F(Picture, ATitleStandsAboveTheCounts)
{
  const auto rows_of_text = [this](const std::string& title) {
    Options titled = options();
    titled.title = title;
    const Pixels pixels = OffscreenView(titled).draw();
    int lowest = pixels.height;
    for (int y = 0; y < pixels.height; ++y)
      for (int x = 0; x < pixels.width / 8; ++x)
        if (y < lowest && pixels.at(x, y) == text_color) lowest = y;
    return pixels.height - lowest;
  };
  const int counts = rows_of_text("");
  EXPECT_GT(counts, 5);
  EXPECT_GT(rows_of_text("A ball on a floor"), counts + 10);
}

TEST_F(Picture, DistancesHaveColoursUpToTheRangeAndCollisionsTheirOwn)
{
  Options near = options();
  near.color = Coloring::distance;
  near.camera.kind = Camera::Kind::given;
  near.camera.eye = {0, 0, -6};
  near.camera.focus = {0, 0, 0};
  near.camera.up = {0, 1, 0};
  OffscreenView to_clearance(near);
  const double contact[3] = {-0.5, 0.5, 0.0}, beside[3] = {-0.5, 1.1, 0.0};
  const auto [x, y] = to_clearance.seen(contact);
  const Pixels dim = to_clearance.draw();
  EXPECT_EQ(dim.countNear(colliding_color, x, y, 40), 0u);
  near.range = 1.0;
  OffscreenView to_range(near);
  const Pixels pixels = to_range.draw();
  EXPECT_GT(pixels.countNear(colliding_color, x, y, 40), 200u);
  const auto [u, v] = to_range.seen(beside);
  EXPECT_EQ(pixels.differing(dim, u, v, 2), 25u) << "has the colour of its distance";
}

TEST_F(Picture, DistancesOfAllPointsHaveColoursABarAndAHistogram)
{
  Options all = options();
  all.question.clearance.reset();
  all.color = Coloring::distance;
  all.range = 2.0;
  all.camera.kind = Camera::Kind::given;
  all.camera.eye = {0, 0, -6};
  all.camera.focus = {0, 0, 0};
  all.camera.up = {0, 1, 0};
  all.width = 800, all.height = 600;
  OffscreenView view(all);
  const Pixels pixels = view.draw();
  EXPECT_FALSE(view.view->collisions().known);
  const auto table = colorTable(0.0, 2.0, false);
  const SphereHierarchy& obstacle = *view.content->viewedClouds()[1].hierarchy;
  const std::vector<double> distances =
      brute_force::pointDistances({*view.content->viewedClouds()[0].hierarchy}, {obstacle, all.question.pose}).distance;
  std::size_t compared = 0;
  for (std::uint32_t i = 0; i < distances.size(); i += 37) {
    const Point3 p = view.content->scan().points().point(i);
    const auto [x, y] = view.seen(p.data());
    if (y < 300 || y > 560 || x > 560) continue; // words, the bar and the histogram
    const unsigned char* const c = table->MapValue(distances[i]);
    EXPECT_GT(pixels.countNear({c[0], c[1], c[2]}, x, y, 1, 12), 0u) << i;
    ++compared;
  }
  EXPECT_GT(compared, 20u);
  EXPECT_GT(pixels.countIf(700, 100, 99, [&](int u, int v) { return pixels.at(u, v) != ground; }), 1000u)
      << "the histogram";

  // As read from a field, too: what pcl_bsh_collide --distances wrote.
  const std::filesystem::path told = folder / "told.pcd";
  ASSERT_EQ(run("pcl_bsh_collide", floor.string() + ' ' + ball.string() + ' ' + told.string() +
                                       " --pose=-0.5,0.5,0.2,0,0,0 --clearance 0.1 --distances")
                .exit_code,
            0);
  Options field = all;
  field.clouds = {told};
  field.model.reset();
  field.question.pose = Eigen::Isometry3d::Identity();
  OffscreenView from_field(field);
  from_field.draw();
  const std::vector<double> read = from_field.content->allDistances(0);
  ASSERT_EQ(read.size(), distances.size());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i], static_cast<float>(distances[i]));
}

TEST_F(Picture, NothingOfTheFirstCloudIsDrawnBeyondTheCut)
{
  Options whole = options();
  OffscreenView all(whole);
  whole.cut = Cut{{0, 0, 0}, {1, 0, 0}};
  OffscreenView half(whole);
  const Pixels without = all.draw(), with = half.draw();
  const double kept[3] = {-1, 1, 0}, gone[3] = {1, -1, 0}, model[3] = {-0.5, 0.5, 0.45};
  const auto count = [&](const Pixels& pixels, const double* at) {
    const auto [x, y] = all.seen(at);
    return pixels.countNear(ground, x, y, 8);
  };
  EXPECT_EQ(count(with, kept), count(without, kept));
  EXPECT_LT(count(without, gone), 17u * 17u);
  EXPECT_EQ(count(with, gone), 17u * 17u);
  whole.cut = Cut{{0, 0, 0}, {-1, 0, 0}};
  OffscreenView other(whole);
  EXPECT_EQ(count(other.draw(), kept), 17u * 17u);
  EXPECT_LT(count(other.draw(), model), 17u * 17u) << "the model is not cut";
}

TEST_F(Picture, TheProgramDrawsTheSameWithAndWithoutADisplay)
{
  const std::string arguments =
      floor.string() + " --model " + ball.string() + " --pose=-0.5,0.5,0.2,0,0,0 --clearance 0.1";
  const Pixels without = drawn(arguments);
  EXPECT_GT(without.count(colliding_color), 5u);
  const Xvfb display;
  const Pixels with = drawn(arguments);
  EXPECT_EQ(with.bytes, without.bytes);
}

TEST_F(Picture, ADeadDisplayIsNoneAtAll)
{
  setenv("DISPLAY", ":987", 1);
  EXPECT_GT(drawn(floor.string()).count(ground), 100u);
}

TEST_F(Picture, SpheresAreOutlinedWhereTheirCentresSay)
{
  Options plain = options();
  plain.clouds = {ball};
  plain.model.reset();
  plain.question.clearance.reset();
  plain.question.pose = Eigen::Isometry3d::Identity();
  plain.color = Coloring::height;
  plain.width = 800; // the bar stands beside the ball, not before it
  OffscreenView set(plain);
  const Pixels none = set.draw();
  set.view->setExtras({0, false, false, false});
  const Pixels some = set.draw();
  const auto spheres = vtk::sphereData(*set.content->scan().hierarchy, 0);
  for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i) {
    double rim[3];
    spheres->GetPoint(i, rim);
    rim[0] += spheres->GetPointData()->GetArray("radius")->GetTuple1(i);
    const auto [x, y] = set.seen(rim);
    EXPECT_GT(some.differing(none, x, y, 2), 0u) << "sphere " << i;
  }
  set.view->setExtras({2, false, false, false});
  EXPECT_GT(set.draw().differing(some), 200u) << "a level changes the picture";
  set.view->setExtras({});
  EXPECT_EQ(set.draw().bytes, none.bytes);
}

TEST_F(Picture, ExtrasChangeThePictureAndTheLegend)
{
  OffscreenView set(options());
  const Pixels plain = set.draw();
  const auto count = [&](const Extras& extras, const Color& color) {
    set.view->setExtras(extras);
    return set.draw().countNear(color, 40, 60, 80); // the legend's corner
  };
  EXPECT_GT(plain.countNear(colliding_color, 40, 60, 80), 10u);
  EXPECT_GT(count({{}, true, false, false}, voxel_color), 10u);
  EXPECT_GT(count({{}, false, true, false}, cell_color), 10u);
  set.view->setExtras({{}, false, false, true});
  EXPECT_GT(set.draw().differing(plain), 500u) << "the trace";
}

TEST_F(Picture, EveryColouringHasItsBarAndNeedsItsField)
{
  const std::string both = floor.string() + " --model " + ball.string() + " --pose=-0.5,0.5,0.2,0,0,0 --clearance 0.1 ";
  // Words at the right, between title and legend, are the bar's; the clouds change with it and would not tell.
  const auto words = [](const Pixels& pixels) { return pixels.countNear(text_color, 345, 150, 54, 40); };
  EXPECT_EQ(words(drawn(both)), 0u);
  for (const char* name : {"distance", "first_pose", "height", "intensity"})
    EXPECT_GT(words(drawn(both + "--color " + name)), 5u) << name << ": a bar at the right";
  EXPECT_GT(drawn(both + "--color rgb").count({255, 0, 0}), 50u);
  const Outcome lacking =
      run("pcl_bsh_view", ball.string() + " --color rgb --screenshot " + (folder / "x.png").string());
  EXPECT_EQ(lacking.exit_code, 2);
  EXPECT_THAT(lacking.err, HasSubstr("no colours"));
  EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_F(Picture, LegendNamesTheColourOfAnObstacleThatDistancesLeadTo)
{
  const auto box = folder.write("box.off", "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                           "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const auto near_and_inside = folder.write("points.xyz", "0.5 0.5 0.5\n3 0 0\n0 4 0\n");
  const std::string both = near_and_inside.string() + " --model " + box.string() + " --color distance";
  for (const char* const solid : {"", " --solid"}) { // the latter has no histogram
    const Pixels pixels = drawn(both + solid);
    EXPECT_GT(pixels.countNear(compared_color, 40, 60, 80), 10u) << solid;
    EXPECT_EQ(pixels.countNear(obstacle_color, 40, 60, 80), 0u) << solid;
  }
}

TEST_F(Picture, ACloudWithoutAColourIsDrawnByHeight)
{
  const auto cloud = [&](const std::string& last_blue) {
    std::string file = "x y z r g b\n";
    for (int i = 0; i < 400; ++i)
      file += std::to_string(i % 20) + ' ' + std::to_string(i / 20) + ' ' + std::to_string(i % 7) + " 0 0 " +
              (i == 399 ? last_blue : "0") + '\n';
    return folder.write("black.xyz", file).string();
  };
  const auto words = [](const Pixels& pixels) { return pixels.countNear(text_color, 345, 150, 54, 40); };
  EXPECT_GT(words(drawn(cloud("0"))), 5u) << "all is black: a bar of heights";
  EXPECT_EQ(words(drawn(cloud("0") + " --color rgb")), 0u) << "as it is asked for";
  EXPECT_EQ(words(drawn(cloud("1"))), 0u) << "a colour";
}

TEST_F(Picture, TheClosestPairIsDrawn)
{
  Options apart = options();
  apart.question.pose.translation() = Eigen::Vector3d(3.0, 0, 0);
  apart.closest = true;
  OffscreenView set(apart);
  const Pixels pixels = set.draw();
  ASSERT_TRUE(set.view->collisions().closest);
  const Eigen::Vector3d middle = (set.view->collisions().closest->a + set.view->collisions().closest->b) / 2;
  const auto [x, y] = set.seen(middle.data());
  EXPECT_GT(pixels.countNear(segment_color, x, y, 3), 3u);
}

TEST_F(Picture, ExportsReadBack)
{
  const std::string both = floor.string() + " --model " + ball.string() + " --pose=-0.5,0.5,0.2,0,0,0 --clearance 0.1 ";
  ASSERT_EQ(run("pcl_bsh_view", both + "--export " + (folder / "f.vtp").string()).exit_code, 0);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder / "f.vtp").c_str());
  reader->Update();
  const CloudsContent content(options());
  const StepCollisions found = content.collisions(0);
  vtkPointData* const values = reader->GetOutput()->GetPointData();
  ASSERT_EQ(reader->GetOutput()->GetNumberOfPoints(), static_cast<vtkIdType>(found.flags[0].size()));
  for (const char* name : {"index", "collision", "distance", "first_pose", "intensity"})
    ASSERT_NE(values->GetArray(name), nullptr) << name;
  for (vtkIdType i = 0; i < reader->GetOutput()->GetNumberOfPoints(); ++i) {
    const bool collides = found.flags[0][static_cast<std::size_t>(i)] != Verdict::free;
    ASSERT_EQ(values->GetArray("collision")->GetTuple1(i), collides);
    ASSERT_EQ(values->GetArray("first_pose")->GetTuple1(i), collides ? 0 : -1);
    if (collides)
      ASSERT_LE(values->GetArray("distance")->GetTuple1(i), 0.1f);
    else
      ASSERT_TRUE(std::isnan(values->GetArray("distance")->GetTuple1(i)));
  }
  ASSERT_EQ(run("pcl_bsh_view", floor.string() + " --model " + ball.string() + " --trajectory " + path.string() +
                                    " --clearance 0.1 --level 1 --export " + (folder / "f.vtm").string())
                .exit_code,
            0);
  vtkNew<vtkXMLMultiBlockDataReader> blocks;
  blocks->SetFileName((folder / "f.vtm").c_str());
  blocks->Update();
  EXPECT_EQ(vtkMultiBlockDataSet::SafeDownCast(blocks->GetOutput())->GetNumberOfBlocks(), 11u)
      << "floor and ball; spheres, glyphs, voxels, cells of both; the path";
}

TEST_F(Picture, APointAloneIsInTheMiddle)
{
  for (const char* place : {"0 0 0\n", "5 5 5\n", "513449.7 5402650.2 300\n"}) {
    const Pixels pixels = drawn(folder.write("one.xyz", place).string() + " --color height");
    EXPECT_GT(pixels.countIf(200, 150, 4, [&](int x, int y) { return pixels.at(x, y) != ground; }), 2u) << place;
  }
}

TEST_F(Picture, PointsFarOffLeaveTheOthersInSight)
{
  std::string text = "3.4028234e38 0 0\n-1e30 1e6 5\n";
  for (int i = 0; i < 2000; ++i)
    text += std::to_string(i % 50) + ' ' + std::to_string(i / 50) + " 0." + std::to_string(i % 10) + '\n';
  const std::string far = folder.write("far.xyz", text).string();
  EXPECT_GT(drawn(far + " --camera top").count(ground), 1000u);
  Options asked;
  asked.clouds = {far};
  asked.width = 400;
  asked.height = 300;
  asked.camera.kind = Camera::Kind::top;
  asked.question.threads = 1;
  OffscreenView set(asked);
  const Pixels pixels = set.draw();
  for (const double x : {1.0, 25.0, 48.0}) {
    const double point[3] = {x, 20, 0};
    const auto [u, v] = set.seen(point);
    EXPECT_GT(u, 0);
    EXPECT_LT(u, 400);
    EXPECT_GT(pixels.countIf(u, v, 3, [&](int i, int k) { return pixels.at(i, k) != ground; }), 3u) << x;
  }
  ASSERT_EQ(run("pcl_bsh_view", far + " --export " + (folder / "far.vtp").string()).exit_code, 0);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder / "far.vtp").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 2002) << "a file has them all";
}

TEST_F(Picture, WordsBesideTheBarEndInThePicture)
{
  for (const int width : {320, 400, 500, 1280}) {
    Options asked;
    asked.clouds = {floor};
    asked.color = Coloring::height;
    asked.unit = "metres";
    asked.width = width;
    asked.height = 300;
    asked.question.threads = 1;
    OffscreenView set(asked);
    const Pixels pixels = set.draw();
    const auto column = [&](int x) { // below the title
      std::size_t lit = 0;
      for (int y = 0; y < 250; ++y) lit += pixels.at(x, y) != ground ? 1 : 0;
      return lit;
    };
    EXPECT_EQ(column(width - 1), 0u) << width << ": no letter is cut";
    std::size_t lit = 0;
    for (int x = width - 100; x < width; ++x) lit += column(x);
    EXPECT_GT(lit, 300u) << width << ": a bar with words at the right";
  }
}

TEST_F(Picture, RefusesWhatItCannotShow)
{
  const auto fails = [&](const std::string& arguments, int code, const std::string& message) {
    const std::size_t files = folder.files();
    const Outcome failed = run("pcl_bsh_view", arguments);
    EXPECT_EQ(failed.exit_code, code) << arguments;
    EXPECT_THAT(failed.err, StartsWith("pcl_bsh_view: "));
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(folder.files(), files) << arguments;
  };
  const std::string png = " --screenshot " + (folder / "p.png").string(), one = floor.string();
  fails(one, 1, "DISPLAY");
  fails("", 2, "CLOUD");
  fails((folder / "none.pcd").string() + png, 1, "none.pcd");
  fails(one + " --clearance 1" + png, 2, "--clearance");
  fails(one + " --color green" + png, 2, "--color: 'green'");
  fails(one + " --color collision" + png, 2, "--color");
  fails(one + " --camera behind" + png, 2, "--camera");
  fails(one + " --camera nan" + png, 2, "--camera: 'nan' is unknown");
  fails(one + " --camera nan,0,0,0,0,1" + png, 2, "--camera: 'nan,0,0,0,0,1': has a number that is not finite");
  fails(one + " --camera 0,0,inf,0,0,1" + png, 2, "has a number that is not finite");
  fails(one + " --camera 0,0,9,0,0,1,0,0,0" + png, 2, "up is 0 or along the view");
  fails(one + " --camera 0,0,9,0,0,1,0,0,-3" + png, 2, "up is 0 or along the view");
  fails(one + " --cut 1,2,3" + png, 2, "--cut: '1,2,3' is no plane");
  fails(one + " --cut 0,0,0,0,0,0" + png, 2, "--cut: '0,0,0,0,0,0' is no plane");
  fails(one + " --range 1" + png, 2, "--range: is for distances: give --color distance, too");
  fails(one + " --color distance" + png, 2, "--color: ");
  fails(one + ' ' + ball.string() + " --color distance --range 0" + png, 2, "--range: give a length greater");
  fails(one + " --size 10" + png, 2, "--size");
  fails(one + " --trajectory " + path.string() + png, 2, "--model");
  fails(one + " --model " + ball.string() + " --trajectory " + path.string() + " --step 99" + png, 2, "--step");
  fails(one + " --model " + ball.string() + " --clearance -1" + png, 2, "--clearance");
  fails(one + " --screenshot " + (folder / "p.jpg").string(), 2, "--screenshot");
  fails(one + " --export " + (folder / "p.obj").string(), 2, "--export");
  fails(one + " --screenshot " + (folder / "none" / "p.png").string(), 1, "p.png");
  const std::string nothing = folder.write("nothing.xyz", "nan nan nan\n").string();
  fails(nothing + png, 1, "no finite point");
}

} // namespace
} // namespace pcl_bsh::viewer
