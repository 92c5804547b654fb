// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "palette.h"

#include <vtkLegendBoxActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <string>
#include <vector>

namespace pcl_bsh::viewer {

inline constexpr int text_size = 17;

struct LegendEntry {
  std::string text;
  Color color;
};

/// The words of a picture: a title above, a legend of colours and a note below.
class Caption {
public:
  /// @param width, height of the picture, in pixels
  Caption(vtkRenderer& renderer, int width, int height);

  void setTitle(const std::string& text) { title_->SetInput(text.c_str()); }
  void setNote(const std::string& text) { note_->SetInput(text.c_str()); } ///< empty: none
  void setLegend(const std::vector<LegendEntry>& entries);

private:
  vtkSmartPointer<vtkTextActor> title_, note_;
  vtkSmartPointer<vtkLegendBoxActor> legend_;
  int width_, height_;
};

/// Gives words the font and the colour of all words of a picture.
void setLook(vtkTextProperty& look, int size);

/// Sets a background that hides most of the picture behind the words.
void setBacking(vtkTextProperty& look);

} // namespace pcl_bsh::viewer
