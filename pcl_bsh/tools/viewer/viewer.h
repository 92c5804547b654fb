// SPDX-License-Identifier: BSD-3-Clause
// The window: mouse, keys, a slider along the steps, picking; and pictures without one.
#pragma once

#include "hand.h"
#include "render_view.h"

#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSliderWidget.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <memory>
#include <string>

namespace pcl_bsh::viewer {

inline constexpr auto keys = R"(+ -    spheres one level finer, coarser (none)
v  o    voxels, octree cells
t  b    what the query tested and pruned, beams of the scanner
left right   step before, after
d      drag objects of a scene with the mouse, or turn the view again;
       shift: turn the object
click   point or triangle: number, place, distance, first pose
r  s    reset the camera, save a picture
h  q    hide this, quit)";

/// Writes what --screenshot and --export ask for; needs no display. @throws std::runtime_error naming the file
void drawFiles(const ViewContent& content);

class Viewer {
public:
  /// @throws std::runtime_error when there is no display
  explicit Viewer(const ViewContent& content);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Shows the window until the user leaves.
  void run();

  vtkRenderWindow& window() { return *window_; }
  vtkRenderWindowInteractor& interactor() { return *interactor_; }
  vtkSliderWidget* slider() { return slider_; } ///< null where there is one pose
  RenderView& renderView() { return *render_view_; }

  // Called by events.
  bool press(const std::string& key); ///< @return false for a key that means nothing here
  void pick(int x, int y);
  bool grab(int x, int y, bool turning); ///< @return false where nothing can be dragged
  void drag(int x, int y);
  void drawDragged(); ///< unless a picture was drawn just now; then in a moment
  void letGo();
  void showStep(std::size_t step);
  void setMoving(bool moving);
  void loadTile(); ///< draws one more tile of a site, while nothing moves
  const std::string& picked() const { return picked_; }
  const std::filesystem::path& saved() const { return saved_; } ///< the last picture that was saved

private:
  void addSlider();
  void save();

  const ViewContent& content_;
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> renderer_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<vtkSliderWidget> slider_;
  std::unique_ptr<RenderView> render_view_;
  std::unique_ptr<Hand> hand_;
  std::string picked_;
  std::filesystem::path saved_;
  bool help_ = false;
  bool drags_ = false; ///< the mouse drags objects
  bool is_moving_ = false;
};

} // namespace pcl_bsh::viewer
