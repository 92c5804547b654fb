// SPDX-License-Identifier: BSD-3-Clause
// The window, driven by events as a mouse and a keyboard make them.
#include "pixels.h"
#include "support/verdicts.h"

#include <pcl_bsh/tools/viewer/content/clouds_content.h>
#include <pcl_bsh/tools/viewer/viewer.h>

#include <pcl_bsh/vtk/display.h>

#include <gmock/gmock.h>

#include <vtkCommand.h>
#include <vtkRendererCollection.h>
#include <vtkSliderRepresentation2D.h>

#include <stdexcept>

namespace pcl_bsh::viewer {
namespace {

using testing::HasSubstr;

class ViewerTest : public ViewTest {
protected:
  Options options() const
  {
    Options made;
    made.clouds = {floor};
    made.model = ball;
    made.trajectory = path;
    made.question.clearance = 0.1;
    made.width = 500;
    made.height = 400;
    made.question.threads = 1;
    return made;
  }

  static void press(Viewer& viewer, char key, const char* symbol)
  {
    viewer.interactor().SetKeyEventInformation(0, 0, key, 1, symbol);
    viewer.interactor().InvokeEvent(vtkCommand::KeyPressEvent);
    viewer.interactor().InvokeEvent(vtkCommand::CharEvent);
    viewer.interactor().InvokeEvent(vtkCommand::KeyReleaseEvent);
  }

  static void mouse(Viewer& viewer, unsigned long event, int x, int y)
  {
    viewer.interactor().SetEventInformation(x, y);
    viewer.interactor().InvokeEvent(event);
  }
};

TEST_F(ViewerTest, KeysChangeWhatIsShown)
{
  const Xvfb display;
  const CloudsContent content(options());
  Viewer viewer(content);
  const Pixels plain = pixelsOf(viewer.window());
  press(viewer, '+', "plus");
  ASSERT_EQ(viewer.renderView().extras().level, 0u);
  const Pixels level_0 = pixelsOf(viewer.window());
  EXPECT_GT(level_0.differing(plain), 200u);
  press(viewer, '+', "plus");
  EXPECT_EQ(viewer.renderView().extras().level, 1u);
  EXPECT_GT(pixelsOf(viewer.window()).differing(level_0), 200u);
  for (int i = 0; i < 6; ++i) press(viewer, '+', "KP_Add");
  const std::optional<unsigned> last = viewer.renderView().extras().level;
  EXPECT_LT(*last, 5u) << "there is an end";
  for (unsigned i = 0; i < *last + 1; ++i) press(viewer, '-', "minus");
  EXPECT_FALSE(viewer.renderView().extras().level);
  EXPECT_EQ(pixelsOf(viewer.window()).bytes, plain.bytes);
  for (const char key : {'v', 'o', 't', 'h'}) {
    const char symbol[] = {key, '\0'};
    press(viewer, key, symbol);
    EXPECT_GT(pixelsOf(viewer.window()).differing(plain), 100u) << key;
    press(viewer, key, symbol);
    EXPECT_EQ(pixelsOf(viewer.window()).bytes, plain.bytes) << key;
  }
}

TEST_F(ViewerTest, TheSliderMovesTheModelAndFlagsFollow)
{
  const Xvfb display;
  const CloudsContent content(options());
  Viewer viewer(content);
  ASSERT_NE(viewer.slider(), nullptr);
  EXPECT_EQ(viewer.renderView().collisions().colliding, 0u);
  const Pixels before = pixelsOf(viewer.window());
  auto* const knob = vtkSliderRepresentation2D::SafeDownCast(viewer.slider()->GetRepresentation());
  knob->SetValue(2.0);
  viewer.slider()->InvokeEvent(vtkCommand::InteractionEvent);
  EXPECT_EQ(viewer.renderView().step(), 2u);
  EXPECT_EQ(viewer.renderView().collisions().flags, content.collisions(2).flags);
  EXPECT_GT(viewer.renderView().collisions().colliding, 0u);
  EXPECT_GT(pixelsOf(viewer.window()).differing(before), 100u);

  // The mouse, on the slider's bar: near its right end is the last pose.
  const int* const size = viewer.window().GetSize();
  const int x = static_cast<int>(0.845 * size[0]), y = static_cast<int>(0.07 * size[1]);
  mouse(viewer, vtkCommand::MouseMoveEvent, x, y);
  mouse(viewer, vtkCommand::LeftButtonPressEvent, x, y);
  mouse(viewer, vtkCommand::MouseMoveEvent, x, y);
  mouse(viewer, vtkCommand::LeftButtonReleaseEvent, x, y);
  EXPECT_EQ(viewer.renderView().step(), 3u);
  EXPECT_EQ(viewer.renderView().collisions().colliding, 0u);
  press(viewer, 0, "Left");
  EXPECT_EQ(viewer.renderView().step(), 2u);
  EXPECT_EQ(knob->GetValue(), 2.0);
  for (int i = 0; i < 9; ++i) press(viewer, 0, "Right");
  EXPECT_EQ(viewer.renderView().step(), 3u) << "there is an end";
}

TEST_F(ViewerTest, AClickTellsOfThePoint)
{
  const Xvfb display;
  Options from_above = options();
  from_above.camera.kind = Camera::Kind::top;
  const CloudsContent content(from_above);
  Viewer viewer(content);
  pixelsOf(viewer.window());
  vtkRenderer* const renderer = viewer.window().GetRenderers()->GetFirstRenderer();
  const std::uint32_t record = 60 * 81 + 30;
  const Point3 p = content.scan().points().point(record);
  renderer->SetWorldPoint(p[0], p[1], p[2], 1.0);
  renderer->WorldToDisplay();
  const int x = static_cast<int>(std::lround(renderer->GetDisplayPoint()[0]));
  const int y = static_cast<int>(std::lround(renderer->GetDisplayPoint()[1]));
  testing::internal::CaptureStdout();
  mouse(viewer, vtkCommand::LeftButtonPressEvent, x, y);
  mouse(viewer, vtkCommand::LeftButtonReleaseEvent, x, y);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("point " + std::to_string(record) + " of floor.ply"));
  EXPECT_THAT(viewer.picked(), HasSubstr("distance "));
  EXPECT_THAT(viewer.picked(), HasSubstr("first pose "));
  mouse(viewer, vtkCommand::LeftButtonPressEvent, 3, 390);
  mouse(viewer, vtkCommand::LeftButtonReleaseEvent, 3, 390);
  EXPECT_EQ(viewer.picked(), "") << "nothing there";
}

TEST_F(ViewerTest, DraggingTurnsTheCameraAndResetBringsItBack)
{
  const Xvfb display;
  const CloudsContent content(options());
  Viewer viewer(content);
  const Pixels before = pixelsOf(viewer.window());
  mouse(viewer, vtkCommand::LeftButtonPressEvent, 200, 250);
  mouse(viewer, vtkCommand::MouseMoveEvent, 260, 270);
  mouse(viewer, vtkCommand::LeftButtonReleaseEvent, 260, 270);
  EXPECT_GT(pixelsOf(viewer.window()).differing(before), 500u);
  press(viewer, 'r', "r");
  EXPECT_LT(pixelsOf(viewer.window()).differing(before), 20u);
}

TEST_F(ViewerTest, SavesPictures)
{
  const Xvfb display;
  const CloudsContent content(options());
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  Viewer viewer(content);
  pixelsOf(viewer.window());
  press(viewer, 's', "s");
  press(viewer, 's', "s");
  EXPECT_EQ(viewer.saved(), "pcl_bsh_view_2.png");
  EXPECT_GT(readPng(folder / "pcl_bsh_view_1.png").count(ground), 100u);
  std::filesystem::current_path(before);
}

/// A server begins anew when its only client has gone, and lets nobody in meanwhile.
TEST_F(ViewerTest, TheServerStaysBetweenTheQuestionAndTheWindow)
{
  const Xvfb display;
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(vtk::haveDisplay()) << i;
}

TEST_F(ViewerTest, OpensAfterAPictureThatNeededNoDisplay)
{
  const CloudsContent content(options());
  unsetenv("DISPLAY");
  const auto drawn = vtk::makeOffscreenWindow(100, 100);
  drawn->Render();
  for (int i = 0; i < 2; ++i) { // one after the other
    const Xvfb display;
    Viewer viewer(content);
    EXPECT_GT(pixelsOf(viewer.window()).count(ground), 100u);
  }
}

TEST_F(ViewerTest, NoDisplayIsAnErrorNotAnEnd)
{
  const CloudsContent content(options());
  for (const char* display : {"", ":987"}) {
    setenv("DISPLAY", display, 1);
    EXPECT_THROW(Viewer{content}, std::runtime_error);
  }
}

} // namespace
} // namespace pcl_bsh::viewer
