// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkLookupTable.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include <string>

namespace pcl_bsh::view {

/// Which colour stands for which value, with the unit, at the right edge.
class ValueBar {
public:
  explicit ValueBar(vtkRenderer& renderer);

  /// @param counts the values are whole numbers
  void show(vtkLookupTable& table, const std::string& title, bool counts);
  void hide() { bar_->VisibilityOff(); }

  /// The share of the picture's width that it leaves to all else.
  double freeWidth() const { return bar_->GetVisibility() != 0 ? 0.78 : 1.0; }

private:
  vtkSmartPointer<vtkScalarBarActor> bar_;
};

} // namespace pcl_bsh::view
