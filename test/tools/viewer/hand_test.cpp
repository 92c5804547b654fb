// SPDX-License-Identifier: BSD-3-Clause
// Objects dragged with the mouse, in a window, by events as a mouse makes them.
#include "pixels.h"

#include <pcl_bsh/tools/viewer/content/scene_content.h>
#include <pcl_bsh/tools/viewer/viewer.h>

#include <gtest/gtest.h>

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRendererCollection.h>

#include <chrono>
#include <thread>

namespace pcl_bsh::viewer {
namespace {

/// A ball of points beside a wall of points, seen from the front; its middle is 1 from the wall.
class HandTest : public ViewTest {
protected:
  Options options(const std::string& effects) const
  {
    Options made;
    made.scene = folder.write("hand.json", R"({
      "clouds": { "ball": { "sphere": { "radius": 0.3 }, "spacing": 0.02 },
                  "wall": { "box": { "size": [0.1, 1, 2] }, "spacing": 0.02 },
                  "crate": { "file": "crate.off" }, "floor": { "file": "floor.off" } },
      "objects": [ )" + std::string(objects(effects)) +
                                               R"( ],
      "clearance": 0.02, "tolerance": 0.001, "steps": 2, "dt": 0.1, "effects": { )" +
                                               effects + " } }");
    made.width = 500;
    made.height = 400;
    made.camera.kind = Camera::Kind::front;
    made.question.threads = 1;
    return made;
  }

  static const char* objects(const std::string& effects)
  {
    if (effects.find("bodies") == std::string::npos)
      return R"({ "name": "wall", "cloud": "wall", "fixed": true, "pose": [1, 0, 0] }, { "name": "ball", "cloud": "ball" })";
    return R"({ "name": "floor", "cloud": "floor", "fixed": true, "pose": [0, 0, -0.5] },
              { "name": "crate", "cloud": "crate", "pose": [0, 0, 0.201], "body": { "density": 100 } },
              { "name": "other", "cloud": "crate", "pose": [0.6, 0, 0.201], "body": { "density": 100 } })";
  }

  /// A cube about the origin.
  static std::string cube(double x, double z)
  {
    std::ostringstream text;
    text << "OFF\n8 12 0\n";
    for (int i = 0; i < 8; ++i) text << (i & 1 ? x : -x) << ' ' << (i & 2 ? x : -x) << ' ' << (i & 4 ? z : -z) << '\n';
    text << "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 "
            "5\n";
    return text.str();
  }

  static void mouse(Viewer& viewer, unsigned long event, const std::array<int, 2>& at, bool shift = false)
  {
    viewer.interactor().SetEventInformation(at[0], at[1], 0, shift ? 1 : 0);
    viewer.interactor().InvokeEvent(event);
  }

  static void press(Viewer& viewer, char key)
  {
    const char symbol[] = {key, '\0'};
    viewer.interactor().SetKeyEventInformation(0, 0, key, 1, symbol);
    viewer.interactor().InvokeEvent(vtkCommand::KeyPressEvent);
  }

  static std::array<int, 2> seen(Viewer& viewer, double x, double y, double z)
  {
    vtkRenderer* const renderer = viewer.window().GetRenderers()->GetFirstRenderer();
    renderer->SetWorldPoint(x, y, z, 1.0);
    renderer->WorldToDisplay();
    return {static_cast<int>(std::lround(renderer->GetDisplayPoint()[0])),
            static_cast<int>(std::lround(renderer->GetDisplayPoint()[1]))};
  }

  /// From a place of an object to another one in so many events, with the button held.
  static void drag(Viewer& viewer, const std::array<int, 2>& from, const std::array<int, 2>& to, int events = 20,
                   bool shift = false)
  {
    mouse(viewer, vtkCommand::LeftButtonPressEvent, from, shift);
    for (int i = 1; i <= events; ++i)
      mouse(viewer, vtkCommand::MouseMoveEvent,
            {from[0] + (to[0] - from[0]) * i / events, from[1] + (to[1] - from[1]) * i / events}, shift);
    // The last picture may have been left out. It comes with a timer, which runs where the window's loop does.
    for (int i = 0; i < 20; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      viewer.interactor().InvokeEvent(vtkCommand::TimerEvent);
    }
  }

  std::filesystem::path crate = folder.write("crate.off", cube(0.2, 0.2));
  std::filesystem::path floor_mesh = folder.write("floor.off", cube(3, 0.5));
};

TEST_F(HandTest, AnObjectThatIsDraggedStopsAsTheSceneSays)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeSceneContent(options(R"("response": "stop")"));
  Viewer viewer(*content);
  const Pixels before = pixelsOf(viewer.window());
  press(viewer, 'd');
  drag(viewer, seen(viewer, 0, -0.3, 0), seen(viewer, 0.9, -0.3, 0));
  const double x = content->poseOf(1, 0).translation().x();
  EXPECT_GT(x, 0.6);
  EXPECT_LT(x, 0.95 - 0.3 - 0.02 + 0.01) << "before the wall";
  const Pixels during = pixelsOf(viewer.window());
  EXPECT_GT(during.differing(before), 500u);
  EXPECT_GT(during.count(contact_color), 20u) << "arrows";
  EXPECT_GT(during.count(segment_color), 5u) << "the smallest distance";
  mouse(viewer, vtkCommand::LeftButtonReleaseEvent, seen(viewer, 0.9, -0.3, 0));
  EXPECT_EQ(content->poseOf(1, 0).translation().x(), x) << "it stays there";
  EXPECT_EQ(viewer.renderView().collisions().colliding, 0u);
  EXPECT_TRUE(viewer.renderView().collisions().known);
  viewer.showStep(1);
  viewer.showStep(0);
  EXPECT_EQ(content->poseOf(1, 0).translation().x(), 0.0) << "the scene's own steps are as they were";
}

TEST_F(HandTest, AnObjectThatIsDraggedSlidesAsTheSceneSays)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeSceneContent(options(R"("response": "slide")"));
  Viewer viewer(*content);
  pixelsOf(viewer.window());
  press(viewer, 'd');
  drag(viewer, seen(viewer, 0, -0.3, 0), seen(viewer, 0.9, -0.3, 0.5));
  const Eigen::Vector3d there = content->poseOf(1, 0).translation();
  EXPECT_LT(there.x(), 0.64);
  EXPECT_NEAR(there.z(), 0.5, 0.05) << "points hold it a little";
}

TEST_F(HandTest, ABodyThatIsDraggedPushesOthers)
{
#ifndef PCL_BSH_BODIES
  GTEST_SKIP() << "pcl_bsh::physics is not built: install libbullet-dev";
#endif
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeSceneContent(options(R"("bodies": {})"));
  Viewer viewer(*content);
  pixelsOf(viewer.window());
  press(viewer, 'd');
  drag(viewer, seen(viewer, 0, -0.2, 0.201), seen(viewer, 0.8, -0.2, 0.22), 60);
  EXPECT_GT(content->poseOf(1, 0).translation().x(), 0.6);
  EXPECT_GT(content->poseOf(2, 0).translation().x(), content->poseOf(1, 0).translation().x() + 0.399);
  EXPECT_FALSE(content->contacts(0).empty());
  EXPECT_GT(pixelsOf(viewer.window()).count(contact_color), 20u);
}

TEST_F(HandTest, WithShiftTheObjectTurnsWhereItIsHeld)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeSceneContent(options(R"("response": "stop")"));
  Viewer viewer(*content);
  pixelsOf(viewer.window());
  press(viewer, 'd');
  const std::array<int, 2> from = seen(viewer, 0, -0.3, 0);
  drag(viewer, from, {from[0] + 60, from[1]}, 10, true);
  EXPECT_NEAR(Eigen::AngleAxisd(content->poseOf(1, 0).linear()).angle(), 30.0 * 3.14159265 / 180, 1e-3);
}

TEST_F(HandTest, WhatIsFixedAndTheViewAreNotDragged)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeSceneContent(options(R"("response": "stop")"));
  Viewer viewer(*content);
  const Pixels before = pixelsOf(viewer.window());
  drag(viewer, seen(viewer, 0, -0.3, 0), seen(viewer, 0.4, -0.3, 0));
  mouse(viewer, vtkCommand::LeftButtonReleaseEvent, seen(viewer, 0.4, -0.3, 0));
  EXPECT_EQ(content->poseOf(1, 0).translation().x(), 0.0) << "without d the view turns";
  EXPECT_GT(pixelsOf(viewer.window()).differing(before), 200u);
  press(viewer, 'r');
  press(viewer, 'd');
  drag(viewer, seen(viewer, 1, -0.5, 0), seen(viewer, 0, -0.5, 0));
  EXPECT_EQ(content->poseOf(0, 0).translation().x(), 1.0);
}

/// Events come more often than pictures are worth drawing; each moves the object all the same.
TEST_F(HandTest, DrawsNoMoreThanThirtyPicturesASecond)
{
  const Xvfb display;
  const std::unique_ptr<ViewContent> content = makeSceneContent(options(R"("response": "stop")"));
  Viewer viewer(*content);
  pixelsOf(viewer.window());
  press(viewer, 'd');
  int pictures = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&pictures);
  count->SetCallback([](vtkObject*, unsigned long, void* into, void*) { ++*static_cast<int*>(into); });
  viewer.window().AddObserver(vtkCommand::EndEvent, count);
  const auto begin = std::chrono::steady_clock::now();
  drag(viewer, seen(viewer, 0, -0.3, 0), seen(viewer, 0.5, -0.3, 0), 400);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(pictures, 2 + 30 * seconds);
  EXPECT_NEAR(content->poseOf(1, 0).translation().x(), 0.5, 0.01);
}

} // namespace
} // namespace pcl_bsh::viewer
