// SPDX-License-Identifier: BSD-3-Clause
// Scenes: where objects are at each step, what collides there, and that the picture says so.
#include "pixels.h"
#include "support/verdicts.h"

#include <pcl_bsh/tools/viewer/content/scene_content.h>
#include <pcl_bsh/tools/viewer/viewer.h>

#include <pcl_bsh/collide.h>

#include <gmock/gmock.h>

#include <vtkCommand.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkXMLMultiBlockDataReader.h>

namespace pcl_bsh::viewer {
namespace {

using testing::HasSubstr;

/// A ball that flies into another, or beside it: centres 2 apart at step 0, one in the other at step 4.
class SceneRunTest : public ViewTest {
protected:
  SceneRunTest() { unsetenv("DISPLAY"); }

  Options options(const std::string& effects = R"("any": true)", const std::string& more = "") const
  {
    Options made;
    made.scene = folder.write("crash.json", R"({
      "clouds": { "ball": { "sphere": { "radius": 0.5 }, "spacing": 0.05 } },
      "objects": [ { "name": "still", "cloud": "ball", "fixed": true },
                   { "name": "flying", "cloud": "ball", "pose": [-2, 0, 0], "motion": { "velocity": [1, 0, 0] })" +
                                                more + R"(} ],
      "clearance": 0.05, "tolerance": 0.001, "steps": 4, "dt": 0.5, "effects": { )" +
                                                effects + " } }");
    made.width = 400;
    made.height = 300;
    made.camera.kind = Camera::Kind::front;
    made.question.threads = 1;
    return made;
  }

  /// Colliding points at a step, by the query for two clouds.
  static std::size_t collidingAt(const ViewContent& content, std::size_t step, double clearance)
  {
    FlagsRequest request;
    request.clearance = clearance;
    request.flagged = Flagged::both;
    const FlagsResult flags = collisionFlags({*content.viewedClouds()[0].hierarchy, content.poseOf(0, step)},
                                             {*content.viewedClouds()[1].hierarchy, content.poseOf(1, step)}, request);
    return static_cast<std::size_t>(std::count(flags.a.begin(), flags.a.end(), Verdict::colliding) +
                                    std::count(flags.b.begin(), flags.b.end(), Verdict::colliding));
  }
};

TEST_F(SceneRunTest, CollidingPointsStandOutAtTheStepsWhereThereAreAny)
{
  OffscreenView set(options());
  const double contact[3] = {-0.25, 0.0, 0.0};
  for (const std::size_t step : {0u, 3u, 1u}) {
    set.view->show(step);
    const Pixels pixels = set.draw();
    const auto [x, y] = set.seen(contact);
    const std::size_t marked = pixels.countNear(colliding_color, x, y, 60);
    const std::size_t marked_flying = pixels.countNear(obstacle_colliding_color, x, y, 60);
    if (step == 3) {
      EXPECT_GT(marked, 50u);
      EXPECT_GT(marked_flying, 50u);
    }
    else {
      EXPECT_EQ(marked + marked_flying, 0u) << "step " << step;
    }
    EXPECT_GT(pixels.count(scan_color, 60), 500u) << "the still ball";
    EXPECT_GT(pixels.count(obstacle_color, 60), 500u) << "the flying ball";
  }
}

TEST_F(SceneRunTest, FlagsAreThoseOfTheTwoCloudsInAnyOrderOfSteps)
{
  const std::unique_ptr<ViewContent> scene = makeSceneContent(options());
  ASSERT_EQ(scene->steps(), 5u);
  for (const std::size_t step : {4u, 1u, 3u, 0u, 2u}) {
    EXPECT_EQ(scene->poseOf(1, step).translation(), Eigen::Vector3d(-2 + 0.5 * static_cast<double>(step), 0, 0));
    EXPECT_EQ(scene->collisions(step).colliding, collidingAt(*scene, step, 0.05)) << step;
  }
  EXPECT_EQ(scene->collisions(1).colliding, 0u);
  EXPECT_GT(scene->collisions(3).colliding, 0u);
  EXPECT_THAT(scene->heading(scene->collisions(3), 3), HasSubstr("step 3 of 0..4, 1.5 s"));
  EXPECT_EQ(scene->paths(3).poses.at(0).size(), 4u);
}

TEST_F(SceneRunTest, ObjectsHaltAsTheSceneSaysAndAClearanceShowsWhatIsNear)
{
  Options near = options(R"("response": "stop")");
  const std::unique_ptr<ViewContent> scene = makeSceneContent(near);
  EXPECT_EQ(scene->collisions(4).colliding, 0u);
  EXPECT_NEAR(scene->poseOf(1, 4).translation().x(), -1.05, 0.02) << "before the other";
  EXPECT_THAT(scene->heading(scene->collisions(4), 4), HasSubstr("flying meets still"));
  near.question.clearance = 0.2;
  near.closest = true;
  const std::unique_ptr<ViewContent> wide = makeSceneContent(near);
  EXPECT_EQ(wide->poseOf(1, 4).matrix(), scene->poseOf(1, 4).matrix()) << "the path is the scene's";
  EXPECT_EQ(wide->collisions(4).colliding, collidingAt(*wide, 4, 0.2));
  EXPECT_GT(wide->collisions(4).colliding, 0u);
  EXPECT_NEAR(wide->collisions(4).closest->distance, 0.05, 0.001);
}

TEST_F(SceneRunTest, WavesRunForwardAndBack)
{
  const Options waving =
      options(R"("deform": 1.5)", R"(, "wave": { "amplitude": [0, 0, 0.3], "length": 1.3, "period": 1.7 })");
  const std::unique_ptr<ViewContent> scene = makeSceneContent(waving);
  EXPECT_TRUE(scene->deforms(1));
  const auto topAt = [&](std::size_t step) {
    scene->collisions(step);
    return scene->viewedClouds()[1].points().point(0)[2];
  };
  const double early = topAt(1);
  EXPECT_NE(topAt(3), early);
  EXPECT_EQ(topAt(1), early);
  for (const std::size_t step : {3u, 2u}) {
    const StepCollisions found = scene->collisions(step); // puts the points where they are then
    EXPECT_EQ(found.colliding, collidingAt(*scene, step, 0.05)) << step;
  }

  OffscreenView set(waving);
  set.view->show(3);
  const Pixels before = set.draw();
  set.view->show(0);
  EXPECT_GT(set.draw().differing(before), 500u);
  set.view->show(3);
  EXPECT_EQ(set.draw().differing(before, 200, 180, 115), 0U)
      << "above the legend, whose words may move by half a pixel";
}

TEST_F(SceneRunTest, TheSliderMovesObjectsAndFlagsFollow)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> scene = makeSceneContent(options());
  Viewer viewer(*scene);
  ASSERT_NE(viewer.slider(), nullptr);
  const Pixels before = pixelsOf(viewer.window());
  vtkSliderRepresentation2D::SafeDownCast(viewer.slider()->GetRepresentation())->SetValue(3.0);
  viewer.slider()->InvokeEvent(vtkCommand::InteractionEvent);
  EXPECT_EQ(viewer.renderView().step(), 3u);
  EXPECT_EQ(viewer.renderView().collisions().flags, scene->collisions(3).flags);
  EXPECT_GT(pixelsOf(viewer.window()).count(colliding_color), before.count(colliding_color) + 50);
}

TEST_F(SceneRunTest, TheProgramDrawsAndExportsAStep)
{
  const std::string scene = options().scene->string();
  const auto drawn = [&](const std::string& step) {
    const Outcome done = run("pcl_bsh_view", "--scene " + scene + " --camera front --size 400x300 --step " + step +
                                                 " --screenshot " + (folder / "p.png").string());
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return readPng(folder / "p.png");
  };
  EXPECT_GT(drawn("3").countNear(obstacle_colliding_color, 200, 150, 80), 50u);
  EXPECT_EQ(drawn("1").countNear(obstacle_colliding_color, 200, 150, 80), 0u);
  ASSERT_EQ(run("pcl_bsh_view", "--scene " + scene + " --step 3 --export " + (folder / "f.vtm").string()).exit_code, 0);
  vtkNew<vtkXMLMultiBlockDataReader> blocks;
  blocks->SetFileName((folder / "f.vtm").c_str());
  blocks->Update();
  EXPECT_EQ(vtkMultiBlockDataSet::SafeDownCast(blocks->GetOutput())->GetNumberOfBlocks(), 11u)
      << "two balls; spheres, glyphs, voxels, cells of both; the path";
}

/// A ball that has fallen on a plate.
TEST_F(SceneRunTest, ContactsOfBodiesAreArrows)
{
#ifndef PCL_BSH_BODIES
  GTEST_SKIP() << "pcl_bsh::physics is not built: install libbullet-dev";
#endif
  Options made = options();
  made.scene = folder.write("fall.json", R"({
    "clouds": { "ball": { "sphere": { "radius": 0.5 }, "spacing": 0.05 },
                "plate": { "box": { "size": [2, 2, 0.1] }, "spacing": 0.05 } },
    "objects": [ { "name": "plate", "cloud": "plate", "fixed": true },
                 { "name": "ball", "cloud": "ball", "pose": [0, 0, 0.7], "body": { "mass": 10 } } ],
    "steps": 4, "dt": 0.1, "effects": { "bodies": {} } })");
  OffscreenView set(made);
  EXPECT_TRUE(set.content->contacts(0).empty());
  EXPECT_EQ(set.draw().count(contact_color, 40), 0u);
  set.view->show(4);
  const std::vector<Contact> contacts = set.content->contacts(4);
  ASSERT_FALSE(contacts.empty());
  const auto [x, y] = set.seen(contacts[0].place_b.data());
  EXPECT_GT(contacts[0].normal.z(), 0.9);
  EXPECT_NEAR(contacts[0].place_b.z(), 0.05, 1e-3);
  EXPECT_GT(set.draw().countNear(contact_color, x, y, 60, 40), 5u) << "beside the ball's own points";
  set.view->exportTo(folder / "fall.vtm");
  vtkNew<vtkXMLMultiBlockDataReader> blocks;
  blocks->SetFileName((folder / "fall.vtm").c_str());
  blocks->Update();
  EXPECT_EQ(vtkMultiBlockDataSet::SafeDownCast(blocks->GetOutput())->GetNumberOfBlocks(), 13u)
      << "two clouds; spheres, glyphs, voxels, cells of both; contacts and arrows; the path";
}

TEST_F(SceneRunTest, RefusesWhatIsNoSceneOrNoStepOfIt)
{
  const auto fails = [&](const std::string& arguments, int code, const std::string& message) {
    const Outcome failed = run("pcl_bsh_view", arguments + " --screenshot " + (folder / "p.png").string());
    EXPECT_EQ(failed.exit_code, code) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "p.png")) << arguments;
  };
  const std::string scene = "--scene " + options().scene->string();
  fails("--scene " + (folder / "none.json").string(), 1, "none.json");
  fails("--scene " + folder.write("bad.json", R"({ "steps": 1, "colour": 2 })").string(), 1, "'colour'");
  fails(scene + " --step 5", 2, "--step: 5: the scene has steps 0 to 4");
  fails(scene + " --step=-1", 2, "--step");
  fails(scene + ' ' + floor.string(), 2, "CLOUD");
  fails(scene + " --model " + ball.string(), 2, "--model");
  fails(scene + " --pose 1,0,0,0,0,0", 2, "--pose");
  fails(scene + " --trajectory " + path.string(), 2, "--trajectory");
  fails(scene + " --trace", 2, "--trace");
  fails(scene + " --color height", 2, "--color");
  fails(scene + " --clearance -1", 2, "--clearance");
  fails(scene + " --export " + (folder / "p.vtp").string(), 2, ".vtm");
}

#ifdef PCL_BSH_ROBOTS
TEST_F(SceneRunTest, LinksAreWhereTheyAreAtTheStepShown)
{
  folder.write("robot.urdf", R"(<robot name="slider">
    <link name="rail"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
    <joint name="s" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 1 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="2" effort="1" velocity="1"/></joint></robot>)");
  folder.write("states.csv", "s\n0\n2\n");
  Options made = options();
  made.scene = folder.write("robot.json", R"({
    "clouds": { "ball": { "sphere": { "radius": 0.02 }, "spacing": 0.01 } },
    "objects": [ { "name": "ball", "cloud": "ball", "fixed": true, "pose": [1, 1, 0.11] },
                 { "name": "slider", "robot": { "urdf": "robot.urdf", "states": "states.csv", "interval": 1 } } ],
    "steps": 4, "dt": 0.25, "effects": { "any": true } })");
  const std::unique_ptr<ViewContent> content = makeSceneContent(made);
  ASSERT_EQ(content->viewedClouds().size(), 3u);
  EXPECT_EQ(content->viewedClouds()[2].name, "slider/cart");
  for (const std::size_t step : {2u, 0u, 4u, 1u}) {
    EXPECT_EQ(content->poseOf(1, step).translation(), Eigen::Vector3d::Zero());
    EXPECT_EQ(content->poseOf(2, step).translation(), Eigen::Vector3d(0.5 * static_cast<double>(step), 1, 0));
    EXPECT_EQ(content->collisions(step).colliding > 0, step == 2) << step;
  }
  DraggedCloud* const drag = content->drag(2, 4);
  ASSERT_NE(drag, nullptr);
  drag->moveTo(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)));
  EXPECT_EQ(content->poseOf(2, 4).translation(), Eigen::Vector3d(2, 1, 1)) << "as the joints are at this step";
  EXPECT_EQ(content->paths(3).poses[0].back().translation(), Eigen::Vector3d(1.5, 1, 0)) << "of the last link";
}
#endif

} // namespace
} // namespace pcl_bsh::viewer
