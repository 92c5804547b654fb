// SPDX-License-Identifier: BSD-3-Clause
// The mouse as a hand: it takes an object, leads it as far as it can go, and tells what it touches.
#pragma once

#include "render_view.h"

#include <Eigen/Geometry>
#include <vtkRenderer.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace pcl_bsh::viewer {

class Hand {
public:
  Hand(const ViewContent& content, RenderView& view, vtkRenderer& renderer)
  : content_(content),
    view_(view),
    renderer_(renderer)
  {
  }

  /// Takes the object that is seen at a pixel. @return whether there is one that can be led
  /// @param turning whether it turns about the place that was taken, instead of moving
  bool take(int x, int y, bool turning);

  /// Leads it towards a pixel.
  void lead(int x, int y);

  /// Shows where it has come to, unless that is shown already. Pictures are thinned, since events come more often: at
  /// most 30 in a second, and they take half of the time. @param render draws one @return whether it is shown now
  bool draw(const std::function<void()>& render);
  void letGo();
  bool isFull() const { return object_ != nullptr; }

private:
  Eigen::Isometry3d wanted(int x, int y) const;
  std::string note() const;

  const ViewContent& content_;
  RenderView& view_;
  vtkRenderer& renderer_;
  DraggedCloud* object_ = nullptr; ///< in the hand
  bool turns_ = false;
  int x_ = 0, y_ = 0; ///< where it was taken
  double depth_ = 0.0;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity(); ///< of the object then
  const DragStep* now_ = nullptr;                          ///< not drawn yet; null: there is nothing new
  double response_ = 0.0;                                  ///< seconds of the last move
  double pause_ = 0.0;                                     ///< seconds from one picture to the next, at least
  std::chrono::steady_clock::time_point begin_, drawn_;
  std::size_t events_ = 0, pictures_ = 0;
};

} // namespace pcl_bsh::viewer
