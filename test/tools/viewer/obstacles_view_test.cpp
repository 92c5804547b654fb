// SPDX-License-Identifier: BSD-3-Clause
// Several obstacles with names in one picture.
#include "pixels.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>

#include <algorithm>

namespace pcl_bsh::viewer {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Crates on the floor, by the command line.
class ObstaclesView : public ViewTest {
protected:
  Options parsed(const std::vector<std::string>& more) const
  {
    std::vector<std::string> words = {"pcl_bsh_view", floor.string(), "--clearance", "0.1", "--threads", "1",
                                      "--size",       "600x500"};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return *parseOptions(static_cast<int>(argv.size()), argv.data());
  }

  std::string refusal(const std::vector<std::string>& more) const
  {
    try {
      makeViewContent(parsed(more));
    }
    catch (const std::exception& error) {
      return error.what();
    }
    return {};
  }

  std::string named(const std::string& name, const std::string& more) const
  {
    return name + "=" + crate.string() + ";" + more;
  }

  std::filesystem::path crate =
      folder.write("crate.off", "OFF\n8 6 0\n0 0 0\n0.5 0 0\n0.5 0.5 0\n0 0.5 0\n0 0 0.5\n0.5 0 0.5\n0.5 0.5 0.5\n"
                                "0 0.5 0.5\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  std::vector<std::string> three = {"--obstacle", named("press", "pose=-1.5,-1,-0.03,0,0,0"),
                                    "--obstacle", named("mill", "pose=0.2,-1,1,0,0,0"),
                                    "--obstacle", named("lathe", "pose=0,0.5,0.5,0,0,0;clearance=0.5;solid=true")};
};

TEST_F(ObstaclesView, HaveAColourALineAndAMarkEach)
{
  OffscreenView view(parsed(three));
  const StepCollisions& found = view.view->collisions();
  ASSERT_EQ(found.named.size(), 3U);
  EXPECT_EQ(found.named[0].name, "press");
  EXPECT_GT(found.named[0].colliding, 0U);
  EXPECT_EQ(found.named[1].colliding, 0U);
  EXPECT_GT(found.named[2].colliding, 0U) << "its own clearance counts";
  EXPECT_EQ(found.colliding, found.named[0].colliding + found.named[2].colliding);
  ASSERT_TRUE(found.named[1].closest);
  EXPECT_NEAR(found.named[1].closest->distance, 0.991, 1e-6);
  const std::string heading = view.content->heading(found, 0);
  EXPECT_THAT(heading, HasSubstr("\npress: "));
  EXPECT_THAT(heading, HasSubstr("\nmill: free, smallest distance 0.991"));
  const Pixels pixels = view.draw();
  for (const std::size_t thing : {0U, 1U, 2U}) EXPECT_GT(pixels.count(named_colors[thing], 40), 200U) << thing;
  EXPECT_GT(pixels.count(colliding_color), 20U);
  const std::array<int, 2> at = view.seen(found.named[0].closest->a.data());
  EXPECT_GT(pixels.countNear(segment_color, at[0] + 40, at[1] + 15, 60, 40), 10U) << "its label";
}

TEST_F(ObstaclesView, StandWhereTheirPosesSay)
{
  std::vector<std::string> moving = three;
  moving.insert(moving.end(), {"--trajectory", path.string()});
  const auto content = makeViewContent(parsed(moving));
  ASSERT_EQ(content->steps(), 4U);
  EXPECT_TRUE(content->moves(1));
  EXPECT_FALSE(content->moves(0));
  EXPECT_TRUE(content->poseOf(1, 2).translation().isApprox(Eigen::Vector3d(-0.5, -1, 0.07)));
  EXPECT_TRUE(content->poseOf(2, 2).translation().isApprox(Eigen::Vector3d(1.2, -1, 1.1)));
  EXPECT_EQ(content->collisions(0).colliding, 0U);
  EXPECT_GT(content->collisions(2).colliding, 0U);
}

TEST_F(ObstaclesView, CollideAsTheCollisionProgramSays)
{
  const auto content = makeViewContent(parsed(three));
  const StepCollisions found = content->collisions(0);
  std::string arguments = floor.string() + " " + (folder / "marked.pcd").string() + " --clearance 0.1";
  for (std::size_t i = 0; i < three.size(); i += 2) arguments += " --obstacle \"" + three[i + 1] + '"';
  const Outcome done = run("pcl_bsh_collide", arguments);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const pcl::PCLPointCloud2 marked = io::readCloud(folder / "marked.pcd");
  for (std::size_t i = 0; i < found.flags[0].size(); ++i)
    ASSERT_EQ(found.flags[0][i] == Verdict::colliding, io::valueOf(marked, i, "collision") == 1) << i;
}

TEST_F(ObstaclesView, MaybeUncertainAndInOtherUnits)
{
  std::vector<std::string> one = {"--obstacle", named("press", "pose=-1.5,-1,0.15,0,0,0;uncertainty=0.1")};
  EXPECT_GT(makeViewContent(parsed(one))->collisions(0).undecided, 0U);
  one[1] = named("press", "pose=-1.5,-1,0.15,0,0,0");
  EXPECT_EQ(makeViewContent(parsed(one))->collisions(0).undecided, 0U);
  one[1] = named("press", "unit=mm");
  EXPECT_THAT(refusal(one), HasSubstr("--input-unit"));
  one.insert(one.end(), {"--input-unit", "m"});
  const auto content = makeViewContent(parsed(one));
  EXPECT_NEAR(content->viewedClouds()[1].placeOf(0)[0], 0.0003, 0.0003);
}

TEST_F(ObstaclesView, ManyAreToldAsFarAsThereIsRoom)
{
  std::vector<std::string> many;
  for (int i = 0; i < 15; ++i) {
    const std::string height = i == 14 ? "0" : "1";
    many.insert(many.end(), {"--obstacle", named("m" + std::to_string(i), "pose=0,0," + height + ",0,0,0")});
  }
  OffscreenView view(parsed(many));
  const std::string heading = view.content->heading(view.view->collisions(), 0);
  EXPECT_THAT(heading, HasSubstr("\nm14: ")) << "that collides";
  EXPECT_THAT(heading, HasSubstr("\nand 3 more obstacles"));
  EXPECT_THAT(heading, Not(HasSubstr("m13")));
}

TEST_F(ObstaclesView, AreRefusedInOneLine)
{
  const auto also = [&](std::vector<std::string> more) {
    more.insert(more.end(), three.begin(), three.end());
    return refusal(more);
  };
  EXPECT_THAT(also({"--obstacle", named("mill", "solid=true")}), HasSubstr("--obstacle: "));
  EXPECT_THAT(also({ball.string()}), HasSubstr("is an obstacle without a name, and others have names: give it as"));
  EXPECT_THAT(also({"--model", ball.string()}), HasSubstr("--model: is of one model, and obstacles have names: give"));
  EXPECT_THAT(also({"--pose", "1,0,0,0,0,0"}), HasSubstr("--pose: is of one model, and obstacles have names"));
  EXPECT_THAT(refusal({"--obstacle", named("mill", "colour=red")}), HasSubstr("'colour' is no option of an obstacle"));
  EXPECT_EQ(also({}), "");
}

} // namespace
} // namespace pcl_bsh::viewer
