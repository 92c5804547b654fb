// SPDX-License-Identifier: BSD-3-Clause
// Clouds with faces are drawn as surfaces, and what collides of them is coloured.
#include "pixels.h"
#include "support/verdicts.h"

#include <pcl_bsh/tools/viewer/content/clouds_content.h>

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>

#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>

namespace pcl_bsh::viewer {
namespace {

using testing::Each;
using testing::HasSubstr;

/// A floor of points, and a crate of eight corners whose bottom stands over it.
class SurfaceViewTest : public ViewTest {
protected:
  static std::string crateOff()
  {
    std::ostringstream crate;
    crate << "OFF\n8 6 0\n";
    for (int k = 0; k < 8; ++k) crate << (k & 1) * 2 - 1 << ' ' << (k >> 1 & 1) * 2 - 1 << ' ' << (k >> 2) * 2 << '\n';
    crate << "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
    return crate.str();
  }

  /// The crate is asked about; a point stands before one of the two triangles of its front, and another far away.
  Options asked() const
  {
    Options made = options(false);
    made.clouds = {folder.write("crate.off", crateOff())};
    made.model = folder.write("point.xyz", "0.4 -1.05 0.8\n2 2 2\n");
    return made;
  }
  static constexpr std::uint32_t touched = 4;
  static constexpr double on_touched[3] = {0.7, -1.0, 0.3}, beside[3] = {-0.5, -1.0, 1.5};

  Options options(bool vertices_only) const
  {
    std::ostringstream scan;
    for (int i = -60; i <= 60; ++i)
      for (int j = -60; j <= 60; ++j) scan << 0.033 * i << ' ' << 0.033 * j << " -0.05\n";
    Options made;
    made.clouds = {folder.write("scan.xyz", scan.str())};
    made.model = folder.write("crate.off", crateOff());
    made.question.clearance = 0.1;
    made.question.vertices_only = vertices_only;
    made.width = 500;
    made.height = 400;
    made.question.threads = 1;
    made.camera.kind = Camera::Kind::front;
    return made;
  }
};

TEST_F(SurfaceViewTest, ACrateIsDrawnWithItsFaces)
{
  Options faces = options(false), corners = options(true);
  faces.question.clearance = corners.question.clearance = 0.01; // nothing collides
  OffscreenView surface(faces), vertices(corners);
  const double middle[3] = {0.0, -1.0, 1.0}; // of the face towards the camera
  const auto [x, y] = surface.seen(middle);
  EXPECT_GT(surface.draw().countNear(obstacle_color, x, y, 30), 1000u);
  EXPECT_EQ(vertices.draw().countNear(obstacle_color, x, y, 30), 0u);
}

TEST_F(SurfaceViewTest, WhatCollidesOfItStandsOut)
{
  const CloudsContent content(options(false));
  const StepCollisions found = content.collisions(0);
  const CloudsContent corners(options(true));
  EXPECT_GT(found.colliding, 3000u) << "all of the floor below the crate";
  EXPECT_LT(corners.collisions(0).colliding, 200u);
  // The bottom, and the sides, whose lowest points are 5 cm over the floor; not the top.
  EXPECT_EQ(found.flags[1], test::verdictsOf({1, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1}));
  Options seen_from_below = options(false);
  seen_from_below.camera = {Camera::Kind::given, {4, -5, -1}, {0, 0, 0.5}, {0, 0, 1}};
  seen_from_below.clouds = {folder.write("one.xyz", "0 0 -0.05\n0.1 0 -0.05\n3 3 3\n")};
  EXPECT_GT(OffscreenView(seen_from_below).draw().count(obstacle_colliding_color, 60), 20u);
}

TEST_F(SurfaceViewTest, TrianglesOfTheFirstCloudCollide)
{
  const CloudsContent content(asked());
  const StepCollisions found = content.collisions(0);
  std::vector<Verdict> expected(12, Verdict::free);
  expected[touched] = Verdict::colliding;
  EXPECT_EQ(found.flags[0], expected);
  EXPECT_EQ(found.colliding, 1u);
  EXPECT_THAT(content.heading(found, 0), HasSubstr("crate.off: 12 triangles, 1 collides"));
  Options corners = asked();
  corners.question.vertices_only = true;
  EXPECT_THAT(CloudsContent(corners).collisions(0).flags[0], Each(Verdict::free));
  EXPECT_EQ(CloudsContent(corners).collisions(0).flags[0].size(), 8u);
}

TEST_F(SurfaceViewTest, AndAreColouredWhereTheyAre)
{
  OffscreenView view(asked());
  const Pixels pixels = view.draw();
  const auto [x, y] = view.seen(on_touched);
  EXPECT_GT(pixels.countNear(colliding_color, x, y, 5, 30), 110u);
  const auto [u, v] = view.seen(beside);
  EXPECT_GT(pixels.countNear(scan_color, u, v, 5, 30), 110u);

  EXPECT_THAT(view.view->pick(x, y), HasSubstr("triangle 4 of crate.off: 0.333333333, -1, 0.666666667; collides"));
  EXPECT_THAT(view.view->pick(u, v), HasSubstr("triangle 5 of crate.off"));
  EXPECT_THAT(view.view->pick(u, v), HasSubstr("; free; distance 0."));
  EXPECT_EQ(view.view->pick(2, 398), "");

  Options cut = asked();
  cut.cut = Cut{{0, 0, 1}, {0, 0, -1}};
  OffscreenView upper(cut);
  EXPECT_EQ(upper.draw().countNear(ground, x, y, 2), 25u) << "nothing is drawn below the plane";
  EXPECT_GT(upper.draw().countNear(scan_color, u, v, 5, 30), 110u);
}

TEST_F(SurfaceViewTest, TheirDistancesAreExact)
{
  Options all = asked();
  all.question.clearance.reset();
  all.color = Coloring::distance;
  all.model = folder.write("above.xyz", "0.5 0.2 3\n");
  const std::vector<double> distances = CloudsContent(all).allDistances(0);
  ASSERT_EQ(distances.size(), 12u);
  // The top is 1 away, 0.8 beside the nearest corner of a side is farther; the bottom is 3 away.
  const double nearest = *std::min_element(distances.begin(), distances.end());
  EXPECT_EQ(nearest, 1.0);
  EXPECT_EQ(std::min_element(distances.begin(), distances.end()) - distances.begin(), 2) << "a triangle of the top";
  EXPECT_EQ(distances[1], 3.0);
  all.width = 800;
  all.height = 600;
  const Pixels pixels = OffscreenView(all).draw();
  EXPECT_GT(pixels.countIf(700, 100, 99, [&](int u, int v) { return pixels.at(u, v) != ground; }), 1000u)
      << "the histogram";

  Options within = asked();
  within.color = Coloring::distance;
  const std::vector<float> near = CloudsContent(within).distances(0);
  for (std::size_t i = 0; i < near.size(); ++i) EXPECT_EQ(std::isfinite(near[i]), i == touched) << i;
  EXPECT_FLOAT_EQ(near[touched], 0.05f);
}

TEST_F(SurfaceViewTest, FollowAPath)
{
  Options along = asked();
  along.trajectory =
      folder.write("path.txt", "1 0 0 0 0 1 0 -3 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 -1 0 1 0 0 0 0 1 0.9\n");
  const std::vector<std::int32_t> first = CloudsContent(along).firstPoses();
  const std::vector<std::int32_t> expected = {-1, -1, -1, -1, 1, 2, -1, -1, -1, -1, -1, -1};
  EXPECT_EQ(first, expected);
}

TEST_F(SurfaceViewTest, ShowWhatAFileSaysOfItsFaces)
{
  const Options question = asked();
  const std::filesystem::path marked = folder / "marked.ply";
  ASSERT_EQ(run("pcl_bsh_collide", question.clouds[0].string() + ' ' + question.model->string() + ' ' +
                                       marked.string() + " --clearance 0.1")
                .exit_code,
            0);
  Options told;
  told.clouds = {marked};
  told.question.threads = 1;
  const CloudsContent content(told);
  const StepCollisions found = content.collisions(0);
  EXPECT_TRUE(found.known);
  EXPECT_EQ(found.flags[0], CloudsContent(question).collisions(0).flags[0]);
}

TEST_F(SurfaceViewTest, AreExportedWithWhatIsKnownOfThem)
{
  Options asked_about = asked();
  OffscreenView view(asked_about);
  const std::filesystem::path file = folder / "crate.vtp";
  view.view->exportTo(file);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  ASSERT_EQ(reader->GetOutput()->GetNumberOfPolys(), 12);
  vtkDataArray* const flags = reader->GetOutput()->GetCellData()->GetArray("collision");
  ASSERT_NE(flags, nullptr);
  for (vtkIdType i = 0; i < 12; ++i) EXPECT_EQ(flags->GetTuple1(i), i == touched ? 1 : 0) << i;
  ASSERT_NE(reader->GetOutput()->GetCellData()->GetArray("distance"), nullptr);
}

TEST_F(SurfaceViewTest, DistancesFromASolidAreSigned)
{
  Options solid = options(false);
  solid.clouds = {folder.write("deep.xyz", "0 0 1\n0.5 0 1\n0 0 3\n")};
  solid.question.clearance.reset();
  solid.question.solid = true;
  solid.color = Coloring::distance;
  const CloudsContent content(solid);
  EXPECT_EQ(content.allDistances(0), (std::vector<double>{-1.0, -0.5, 1.0}));
  EXPECT_THAT(content.details(0, 0, 0), HasSubstr("distance -1"));
  solid.question.clearance = 0.125;
  EXPECT_EQ(CloudsContent(solid).collisions(0).flags[0], test::verdictsOf({1, 1, 0}));
  solid.question.solid = false;
  EXPECT_EQ(CloudsContent(solid).collisions(0).flags[0], test::verdictsOf({0, 0, 0}));
}

TEST(Palette, DepthsHaveColoursOfTheirOwn)
{
  const auto of = [](double low, double value) {
    const auto table = colorTable(low, 2.0, false);
    const unsigned char* const c = table->MapValue(value);
    return Color{c[0], c[1], c[2]};
  };
  const Color deep = of(-1.0, -1.0), shallow = of(-1.0, -0.01), near = of(-1.0, 0.02), far = of(-1.0, 2.0);
  EXPECT_GT(deep[0], deep[2] + 100) << "red";
  EXPECT_GT(shallow[0], shallow[2] + 100) << "orange";
  EXPECT_GT(shallow[1], deep[1]);
  EXPECT_GT(near[2], near[0]) << "violet";
  EXPECT_EQ(far, of(0.0, 2.0)) << "as without depths";
}

TEST_F(SurfaceViewTest, OpenEdgesAreDrawnOnRequest)
{
  std::string open = crateOff();
  open.replace(open.find("8 6 0"), 5, "8 5 0").erase(open.rfind("\n4 ") + 1); // without its right side
  Options made;
  made.clouds = {folder.write("open.off", open)};
  made.question.threads = 1;
  made.width = 500;
  made.height = 400;
  made.camera = {Camera::Kind::given, {6, -5, 3}, {0, 0, 1}, {0, 0, 1}};
  const std::size_t without = OffscreenView(made).draw().count(open_edge_color, 20);
  made.open_edges = true;
  OffscreenView view(made);
  EXPECT_GT(view.draw().count(open_edge_color, 20), without + 300);
  const double edge[3] = {1, -1, 1};
  const auto [x, y] = view.seen(edge);
  EXPECT_GT(view.draw().countNear(open_edge_color, x, y, 4, 20), 5u);
  made.clouds = {folder.write("closed.off", crateOff())};
  OffscreenView closed(made);
  EXPECT_LT(closed.draw().countNear(open_edge_color, x, y, 4, 20), 5u);
}

TEST_F(SurfaceViewTest, HaveTheMeanColourAndHeightOfTheirCorners)
{
  Options coloured;
  coloured.question.threads = 1;
  coloured.clouds = {folder.write("t.ply",
                                  "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                  "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar "
                                  "blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                  "0 0 0 30 0 9\n1 0 0 60 0 9\n0 1 3 90 3 9\n7 7 nan 1 1 1\n3 0 1 2\n")};
  const CloudsContent content(coloured);
  const Color mean = {60, 1, 9};
  EXPECT_THAT(*content.scan().colors(), testing::ElementsAre(mean));
  EXPECT_EQ(content.scan().placeOf(0)[2], 1.0);
  coloured.color = Coloring::height;
  OffscreenView(coloured).draw();
}

} // namespace
} // namespace pcl_bsh::viewer
