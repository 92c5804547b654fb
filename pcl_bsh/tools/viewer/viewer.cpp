// SPDX-License-Identifier: BSD-3-Clause
#include "viewer.h"

#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/vtk/display.h>
#include <pcl_bsh/vtk/offscreen_window.h>

#include <vtkCallbackCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkProperty2D.h>
#include <vtkRendererCollection.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <utility>

namespace pcl_bsh::viewer {
namespace {

/// The pause between tiles of a site, and before a picture that was left out is drawn. Events are handled meanwhile.
constexpr unsigned long later_milliseconds = 50;

/// The trackball, with our keys instead of VTK's, and a click that picks.
class Style : public vtkInteractorStyleTrackballCamera {
public:
  using Superclass = vtkInteractorStyleTrackballCamera;

  static Style* New() { VTK_STANDARD_NEW_BODY(Style); }

  Viewer* viewer = nullptr;

  void OnChar() override
  {
    const char key = Interactor->GetKeyCode();
    if (key == 'q' || key == 'e') Superclass::OnChar();
  }

  void OnKeyPress() override
  {
    const char* const symbol = Interactor->GetKeySym();
    if (symbol && viewer->press(symbol)) return;
    viewer->press(std::string(1, Interactor->GetKeyCode()));
  }

  void OnLeftButtonDown() override
  {
    const int* const at = Interactor->GetEventPosition();
    std::copy_n(at, 2, pressed_);
    has_object_ = viewer->grab(at[0], at[1], Interactor->GetShiftKey() != 0);
    if (!has_object_) Superclass::OnLeftButtonDown();
  }

  void OnMouseMove() override
  {
    const int* const at = Interactor->GetEventPosition();
    has_object_ ? viewer->drag(at[0], at[1]) : Superclass::OnMouseMove();
  }

  void OnLeftButtonUp() override
  {
    if (std::exchange(has_object_, false)) return viewer->letGo();
    Superclass::OnLeftButtonUp();
    const int* const at = Interactor->GetEventPosition();
    if (std::abs(at[0] - pressed_[0]) + std::abs(at[1] - pressed_[1]) <= 3) viewer->pick(at[0], at[1]);
  }

  void StartState(int state) override
  {
    viewer->setMoving(true);
    Superclass::StartState(state);
  }

  void StopState() override
  {
    viewer->setMoving(false);
    Superclass::StopState();
    Interactor->Render();
  }

private:
  int pressed_[2] = {0, 0};
  bool has_object_ = false; ///< that the mouse drags
};

void onSlider(vtkObject* slider, unsigned long, void* viewer, void*)
{
  auto* const widget = static_cast<vtkSliderWidget*>(slider);
  const double value = static_cast<vtkSliderRepresentation*>(widget->GetRepresentation())->GetValue();
  static_cast<Viewer*>(viewer)->showStep(static_cast<std::size_t>(std::lround(std::max(0.0, value))));
}

void onSliderMoving(vtkObject*, unsigned long event, void* viewer, void*)
{
  static_cast<Viewer*>(viewer)->setMoving(event == vtkCommand::StartInteractionEvent);
  if (event == vtkCommand::EndInteractionEvent) static_cast<Viewer*>(viewer)->interactor().Render();
}

void onTimer(vtkObject*, unsigned long, void* viewer, void*)
{
  static_cast<Viewer*>(viewer)->drawDragged();
  static_cast<Viewer*>(viewer)->loadTile();
}

} // namespace

void drawFiles(const ViewContent& content)
{
  const Options& options = content.options();
  const auto window = vtk::makeOffscreenWindow(options.width, options.height);
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);
  RenderView view(content, *renderer);
  if (content.site()) {
    cli::Step step("Loading the tiles that the camera sees nearest");
    while (view.loadTile()) {
    }
    step.done(view.tilesText());
  }
  if (options.screenshot) {
    cli::Step step("Drawing " + options.screenshot->string());
    vtk::writePng(*window, *options.screenshot);
    step.done(std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels");
    std::cout << "wrote " << options.screenshot->string() << '\n';
  }
  if (options.export_to) {
    view.exportTo(*options.export_to);
    std::cout << "wrote " << options.export_to->string() << '\n';
  }
}

Viewer::Viewer(const ViewContent& content) : content_(content)
{
  if (!vtk::haveDisplay())
    throw std::runtime_error("DISPLAY: no X server answers there, so no window can open: set DISPLAY, or give "
                             "--screenshot FILE.png, which needs none");
  window_ = vtkSmartPointer<vtkRenderWindow>::New();
  window_->SetSize(content.options().width, content.options().height);
  window_->SetWindowName((std::string(program) + ": " + content.name()).c_str());
  window_->SetMultiSamples(0);
  renderer_ = vtkSmartPointer<vtkRenderer>::New();
  window_->AddRenderer(renderer_);
  render_view_ = std::make_unique<RenderView>(content, *renderer_);
  hand_ = std::make_unique<Hand>(content, *render_view_, *renderer_);

  interactor_ = vtkSmartPointer<vtkRenderWindowInteractor>::New();
  interactor_->SetRenderWindow(window_);
  vtkNew<Style> style;
  style->viewer = this;
  style->SetDefaultRenderer(renderer_);
  interactor_->SetInteractorStyle(style);
  interactor_->Initialize();
  if (content.steps() > 1) addSlider();
  vtkNew<vtkCallbackCommand> later;
  later->SetClientData(this);
  later->SetCallback(onTimer);
  interactor_->AddObserver(vtkCommand::TimerEvent, later);
  if (content.site()) interactor_->CreateRepeatingTimer(later_milliseconds);
}

Viewer::~Viewer()
{
  if (slider_) slider_->SetInteractor(nullptr);
}

void Viewer::addSlider()
{
  vtkNew<vtkSliderRepresentation2D> look;
  look->SetMinimumValue(0.0);
  look->SetMaximumValue(static_cast<double>(content_.steps() - 1));
  look->SetValue(static_cast<double>(render_view_->step()));
  look->SetTitleText(content_.stepName());
  look->SetLabelFormat("%.0f");
  look->GetPoint1Coordinate()->SetCoordinateSystemToNormalizedViewport();
  look->GetPoint1Coordinate()->SetValue(0.35, 0.07);
  look->GetPoint2Coordinate()->SetCoordinateSystemToNormalizedViewport();
  look->GetPoint2Coordinate()->SetValue(0.85, 0.07);
  look->SetSliderLength(0.015);
  look->SetSliderWidth(0.025);
  look->SetTubeWidth(0.006);
  look->SetTitleHeight(0.018);
  look->SetLabelHeight(0.018);
  const std::array<double, 3> knob = fractions(path_color), bar = fractions(scan_color);
  look->GetSliderProperty()->SetColor(knob[0], knob[1], knob[2]);
  look->GetTubeProperty()->SetColor(bar[0], bar[1], bar[2]);
  slider_ = vtkSmartPointer<vtkSliderWidget>::New();
  slider_->SetInteractor(interactor_);
  slider_->SetRepresentation(look);
  slider_->SetAnimationModeToJump();
  vtkNew<vtkCallbackCommand> follow;
  follow->SetClientData(this);
  follow->SetCallback(onSlider);
  slider_->AddObserver(vtkCommand::InteractionEvent, follow);
  vtkNew<vtkCallbackCommand> ease;
  ease->SetClientData(this);
  ease->SetCallback(onSliderMoving);
  slider_->AddObserver(vtkCommand::StartInteractionEvent, ease);
  slider_->AddObserver(vtkCommand::EndInteractionEvent, ease);
  slider_->EnabledOn();
}

void Viewer::run()
{
  window_->Render();
  std::cout << "h shows the keys, q quits" << std::endl;
  interactor_->Start();
}

bool Viewer::press(const std::string& key)
{
  Extras extras = render_view_->extras();
  if (key == "plus" || key == "+" || key == "KP_Add") {
    extras.level = extras.level ? *extras.level + 1 : 0;
    for (const ViewedCloud& viewed : content_.viewedClouds()) // the finest level of any is the last
      if (*extras.level > 0) viewed.hierarchy->buildAll(content_.options().question.threads);
    std::size_t deepest = 0;
    for (const ViewedCloud& viewed : content_.viewedClouds())
      deepest = std::max(deepest, viewed.hierarchy->statistics().depth);
    if (*extras.level > 0) extras.level = std::min(*extras.level, static_cast<unsigned>(deepest));
  }
  else if (key == "minus" || key == "-" || key == "KP_Subtract") {
    if (extras.level && *extras.level > 0)
      --*extras.level;
    else
      extras.level.reset();
  }
  else if (key == "v")
    extras.voxels = !extras.voxels;
  else if (key == "o")
    extras.cells = !extras.cells;
  else if (key == "b") {
    if (content_.options().beams == 0)
      render_view_->setNote("b shows beams of the scanner: give --beams N");
    else
      extras.beams = !extras.beams;
  }
  else if (key == "t") {
    if (!content_.options().question.clearance)
      render_view_->setNote("t shows a query: give an obstacle and --clearance");
    else
      extras.trace = !extras.trace;
  }
  else if (key == "d") {
    drags_ = !drags_;
    render_view_->setNote(drags_ ? "the mouse drags objects; d: it turns the view" : "");
  }
  else if (key == "h") {
    help_ = !help_;
    render_view_->setNote(help_ ? keys : "");
  }
  else if (key == "r")
    render_view_->look(content_.options().camera);
  else if (key == "s")
    save();
  else if (key == "Left" || key == "Right") {
    const std::size_t last = content_.steps() - 1, step = render_view_->step();
    showStep(key == "Right" ? std::min(step + 1, last) : step - (step > 0 ? 1 : 0));
    if (slider_)
      static_cast<vtkSliderRepresentation*>(slider_->GetRepresentation())
          ->SetValue(static_cast<double>(render_view_->step()));
  }
  else
    return false;
  render_view_->setExtras(extras);
  interactor_->Render();
  return true;
}

void Viewer::pick(int x, int y)
{
  picked_ = render_view_->pick(x, y);
  if (!picked_.empty()) std::cout << picked_ << std::endl;
  help_ = false;
  render_view_->setNote(picked_);
  interactor_->Render();
}

bool Viewer::grab(int x, int y, bool turning)
{
  if (!drags_ || !hand_->take(x, y, turning)) return false;
  setMoving(true);
  return true;
}

void Viewer::drag(int x, int y)
{
  hand_->lead(x, y);
  drawDragged();
}

/// Draws now, or soon by a timer. So the object's last place is drawn, though no event comes after it.
void Viewer::drawDragged()
{
  if (!hand_->draw([this] { interactor_->Render(); })) interactor_->CreateOneShotTimer(later_milliseconds);
}

void Viewer::letGo()
{
  hand_->letGo();
  setMoving(false);
  render_view_->refresh();
  interactor_->Render();
}

void Viewer::showStep(std::size_t step)
{
  step = std::min(step, content_.steps() - 1);
  if (step == render_view_->step() || hand_->isFull()) return;
  render_view_->show(step);
  interactor_->Render();
}

void Viewer::loadTile()
{
  if (is_moving_) return;
  try {
    if (!render_view_->loadTile()) return;
  }
  catch (const files::FileError& error) {
    render_view_->setNote(error.what()); // the window stays: other tiles are whole
  }
  interactor_->Render();
}

void Viewer::setMoving(bool moving)
{
  is_moving_ = moving;
  render_view_->setMoving(moving);
}

void Viewer::save()
{
  std::filesystem::path path;
  for (int number = 1; path.empty() || std::filesystem::exists(path); ++number)
    path = std::string(program) + "_" + std::to_string(number) + ".png";
  const bool had_help = help_;
  if (had_help) press("h");
  try {
    vtk::writePng(*window_, path);
    saved_ = path;
    render_view_->setNote("saved " + path.string());
  }
  catch (const std::runtime_error& error) {
    render_view_->setNote(error.what()); // the window stays: another folder may do
  }
}

} // namespace pcl_bsh::viewer
