// SPDX-License-Identifier: BSD-3-Clause
// Where labels of marks in a chart go so that none covers another, a mark or a line.
#pragma once

#include <pcl_bsh/export.h>

#include <array>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// Pixels, from the lower left corner of the picture.
struct PixelBox {
  double left = 0.0, bottom = 0.0, right = 0.0, top = 0.0;
};

struct PixelSegment {
  std::array<double, 2> from = {}, to = {};
};

struct Label {
  std::array<double, 2> at = {};    ///< the middle of its mark
  double width = 0.0, height = 0.0; ///< of its text
};

struct LabelSpace {
  PixelBox frame;                  ///< no label leaves it
  std::vector<PixelBox> taken;     ///< no label touches these; marks belong here, also those of the labels
  std::vector<PixelSegment> lines; ///< nor these
  double gap = 6.0;                ///< between a label and anything else
  double mark_radius = 8.0;
};

/// A box for each label beside its mark, in any of eight directions. Earlier labels choose first; a label that finds no
/// free place gets none.
std::vector<std::optional<PixelBox>> placeLabels(const std::vector<Label>& labels, const LabelSpace& space);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
