// SPDX-License-Identifier: BSD-3-Clause
// A site: its overview, and the tiles that the camera sees nearest.
#include "pixels.h"

#include <pcl_bsh/tools/viewer/content/site_content.h>
#include <pcl_bsh/tools/viewer/viewer.h>

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/site/make_site.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

namespace pcl_bsh::viewer {
namespace {

using testing::HasSubstr;

/// A floor of 100 x 100 m, a point each metre, in the field `collision` of which a patch in the near corner is 1.
class SiteView : public ViewTest {
protected:
  void SetUp() override
  {
    std::ostringstream csv;
    csv << "x,y,z,collision\n";
    for (int i = 0; i < 100; ++i)
      for (int j = 0; j < 100; ++j)
        csv << i << ',' << j << ',' << 0.01 * ((7 * i + j) % 10) << ',' << isPatch(i, j) << '\n';
    site::MakeOptions make;
    make.tile_points = 500;
    make.overview_points = 99; // each 102nd point: not along a line
    made = site::makeSite({folder.write("floor.csv", csv.str())}, site, make);
  }

  static bool isPatch(int i, int j) { return i >= 10 && i < 14 && j >= 10 && j < 14; }

  /// From above the near corner.
  Options options() const
  {
    Options chosen;
    chosen.site = site;
    chosen.budget = 2500;
    chosen.width = 400;
    chosen.height = 300;
    chosen.question.threads = 1;
    chosen.camera = {Camera::Kind::given, {-15, -15, 25}, {15, 15, 0}, {0, 0, 1}};
    return chosen;
  }

  static std::size_t loadAll(RenderView& view)
  {
    std::size_t calls = 0;
    while (view.loadTile()) ++calls;
    return calls;
  }

  static std::size_t drawn(const Pixels& pixels)
  {
    return pixels.countIf(200, 150, 80, [&](int u, int v) { return pixels.at(u, v) != ground; });
  }

  void damageTiles() const
  {
    for (const site::Tile& tile : made.tiles) {
      std::fstream file(site / tile.file, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(-1, std::ios::end);
      file.put('\x7f');
    }
  }

  std::filesystem::path site = folder / "site";
  site::Site made;
};

TEST_F(SiteView, DrawsTheOverviewAtOnceAndThenWhatIsNearest)
{
  OffscreenView view(options());
  const std::size_t overview = drawn(view.draw());
  EXPECT_GT(overview, 5u);
  const std::size_t calls = loadAll(*view.view);
  EXPECT_GE(calls, 4u) << "one tile with each";
  EXPECT_THAT(view.view->tilesText(), HasSubstr("drawn: 99 points of the overview, "));
  EXPECT_THAT(view.view->tilesText(), testing::Not(HasSubstr("to load")));
  const Pixels pixels = view.draw();
  EXPECT_GT(drawn(pixels), 10 * overview);
  const double patch[3] = {11.5, 11.5, 0.05};
  const auto [x, y] = view.seen(patch);
  EXPECT_GT(pixels.countNear(colliding_color, x, y, 12), 100u) << "tiles have the colours of their fields";
  EXPECT_GT(pixels.count(colliding_color), 100u);
  EXPECT_THAT(view.view->pick(x, y), HasSubstr(" of tile_0000"));
  EXPECT_THAT(view.view->pick(x, y), HasSubstr("; collides; record 1"));
  EXPECT_THAT(view.view->pick(x, y), HasSubstr("floor.csv"));

  OffscreenView again(options());
  loadAll(*again.view);
  EXPECT_EQ(again.draw().bytes, pixels.bytes);
}

TEST_F(SiteView, LetsGoOfWhatTheEyeLeaves)
{
  OffscreenView view(options());
  loadAll(*view.view);
  const int props = view.renderer->GetActors()->GetNumberOfItems();
  const double corner[3] = {90, 90, 0}, patch[3] = {11.5, 11.5, 0.05};
  for (int turn = 0; turn < 3; ++turn) {
    view.view->look({Camera::Kind::given, {115, 115, 25}, {85, 85, 0}, {0, 0, 1}});
    EXPECT_GE(loadAll(*view.view), 4u);
    const auto [x, y] = view.seen(corner);
    const Pixels far = view.draw();
    EXPECT_GT(far.countIf(x, y, 20, [&](int u, int v) { return far.at(u, v) != ground; }), 20u);
    view.view->look(options().camera);
    EXPECT_GE(loadAll(*view.view), 4u);
    const auto [u, v] = view.seen(patch);
    EXPECT_GT(view.draw().countNear(colliding_color, u, v, 12), 100u);
  }
  EXPECT_EQ(view.renderer->GetActors()->GetNumberOfItems(), props) << "what was let go is not drawn";
}

TEST_F(SiteView, TilesHaveTheColoursOfTheOverviewsBar)
{
  Options high = options();
  high.color = Coloring::height;
  OffscreenView view(high);
  loadAll(*view.view);
  const SiteContent& content = *view.content->site();
  SharedColors alike;
  alike.values = ColorRange{0.0, 0.09};
  const auto tile = content.readTile(0, alike);
  EXPECT_EQ(tile->sharedColors()->values->high, 0.09);
  const auto table = colorTable(0.0, 0.09, false);
  const Pixels pixels = view.draw();
  for (const double z : {0.0, 0.09}) {
    const unsigned char* const c = table->MapValue(z);
    EXPECT_GT(pixels.count({c[0], c[1], c[2]}, 3), 50u) << z;
  }
}

TEST_F(SiteView, ABudgetForAllLoadsAllThatIsSeen)
{
  Options rich = options();
  rich.budget = 1'000'000;
  rich.camera.kind = Camera::Kind::slanted;
  OffscreenView view(rich);
  EXPECT_EQ(loadAll(*view.view), made.tiles.size());
  EXPECT_THAT(view.view->tilesText(), HasSubstr("10 000 of "));
}

TEST_F(SiteView, AWindowLoadsTilesWhileNothingMovesAndOutlivesADamagedOne)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeViewContent(options());
  Viewer viewer(*content);
  pixelsOf(viewer.window());
  const std::string before = viewer.renderView().tilesText();
  viewer.setMoving(true);
  viewer.loadTile();
  EXPECT_EQ(viewer.renderView().tilesText(), before);
  viewer.setMoving(false);
  viewer.interactor().InvokeEvent(vtkCommand::TimerEvent);
  EXPECT_NE(viewer.renderView().tilesText(), before);
  damageTiles();
  for (std::size_t i = 0; i < 2 * made.tiles.size(); ++i) viewer.loadTile(); // no error ends the window
  EXPECT_THAT(viewer.renderView().tilesText(), HasSubstr(" of 1 tile"));
}

/// The complaint about the arguments; "nothing" if nothing is.
std::string complaintOf(std::vector<std::string> arguments)
{
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  try {
    makeViewContent(*parseOptions(static_cast<int>(argv.size()), argv.data()));
    return "nothing";
  }
  catch (const std::exception& error) {
    return error.what();
  }
}

TEST_F(SiteView, RefusesWhatItCannotShow)
{
  const std::string name = site.string();
  EXPECT_EQ(complaintOf({name, "--budget", "99"}), "nothing");
  EXPECT_THAT(complaintOf({name, "--budget", "98"}), HasSubstr("--budget: 98 points: the overview alone has 99: give"));
  EXPECT_THAT(complaintOf({name, "--budget", "lots"}), HasSubstr("--budget"));
  EXPECT_THAT(complaintOf({name, ball.string()}), HasSubstr("CLOUD: " + name + " is a site, which is shown alone"));
  EXPECT_THAT(complaintOf({name, "--clearance", "1"}), HasSubstr("--clearance: " + name + " is a site"));
  EXPECT_THAT(complaintOf({name, "--export", "a.vtm"}), HasSubstr("pcl_bsh_site export"));
  EXPECT_THAT(complaintOf({floor.string(), "--budget", "1M"}), HasSubstr("--budget: is for a site"));
  const std::filesystem::path overview = site / site::overview_file_name, kept = folder / "kept.pcd";
  std::filesystem::rename(overview, kept);
  EXPECT_THAT(complaintOf({name}), HasSubstr("the overview of the site is missing"));
  std::filesystem::rename(kept, overview);
  std::filesystem::rename(site / site::site_file_name, folder / "site.json");
  EXPECT_THAT(complaintOf({name}), HasSubstr("is no site"));
  folder.write("site/unfinished_site", "");
  EXPECT_THAT(complaintOf({name}), HasSubstr("is a site that is not complete: make it again with pcl_bsh_site make"));
}

TEST_F(SiteView, ADamagedTileMakesNoPicture)
{
  damageTiles();
  const Outcome failed = run("pcl_bsh_view", site.string() + " --screenshot " + (folder / "p.png").string());
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("tile_0000"));
  EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

/// A room that was scanned, where the real scans are.
TEST_F(SiteView, OfARealScan)
{
  const std::filesystem::path scan = std::filesystem::path(PCL_BSH_SHARED_DIR) / "data/indoor_room_scan1.pcd";
  if (!std::filesystem::exists(scan)) GTEST_SKIP() << "no real scans";
  site::MakeOptions make;
  make.tile_points = 10'000;
  make.overview_points = 1'000;
  site::makeSite({scan}, folder / "room", make);
  Options near = options();
  near.site = folder / "room";
  near.budget = 70'000;
  near.camera = {Camera::Kind::given, {0, 0, 0.5}, {5, 2, 0}, {0, 0, 1}};
  OffscreenView view(near);
  const std::size_t before = drawn(view.draw());
  EXPECT_GE(loadAll(*view.view), 2u);
  EXPECT_GT(drawn(view.draw()), 2 * before);
  EXPECT_EQ(loadAll(*view.view), 0u) << "nothing is left to do";
}

} // namespace
} // namespace pcl_bsh::viewer
