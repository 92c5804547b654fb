// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/tools/viewer/content/view_content.h>

#include <vtkLookupTable.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <string>

namespace pcl_bsh::viewer {

/// How the labels of a bar from `low` to `high` are written, for printf(): with as many digits as tell them apart,
/// three at least.
std::string labelFormat(double low, double high, int labels);

/// A bar at the right edge that shows which colour stands for which value, with the unit.
class ValueBar {
public:
  ValueBar(vtkRenderer& renderer, int width); ///< of the picture, in pixels

  /// @param counts the values are whole numbers
  void show(vtkLookupTable& table, const std::string& title, bool counts);
  void hide() { bar_->VisibilityOff(); }

  /// The range of the colours shown; nothing where the bar is hidden.
  std::optional<ColorRange> range() const;

  /// The share of the picture's width that it leaves to all else.
  double freeWidth() const { return bar_->GetVisibility() != 0 ? 1.0 - 1.9 * share_ : 1.0; }

private:
  double share_; ///< of the picture's width, from the bar to the right edge
  vtkSmartPointer<vtkScalarBarActor> bar_;
};

} // namespace pcl_bsh::viewer
