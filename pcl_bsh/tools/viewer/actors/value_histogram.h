// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/tools/viewer/content/view_content.h>

#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <string>
#include <vector>

namespace pcl_bsh::viewer {

/// How many points or triangles have which distance, in the colours of the ValueBar above it, at the lower right.
class ValueHistogram {
public:
  ValueHistogram(vtkRenderer& renderer, int width, int height); ///< of the picture, in pixels

  /// @param distances one per part, NaN where a part has none
  /// @param colors their range ends where the axis ends
  void show(const std::vector<double>& distances, vtkLookupTable& colors, const std::string& axis_title,
            const ViewContent& content);
  void hide() { actor_->VisibilityOff(); }

private:
  vtkNew<vtkContextActor> actor_;
  vtkNew<vtkChartXY> chart_;
};

} // namespace pcl_bsh::viewer
