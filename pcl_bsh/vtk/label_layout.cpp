// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/label_layout.h>

#include <algorithm>

namespace pcl_bsh::vtk {
namespace {

bool overlap(const PixelBox& a, const PixelBox& b)
{
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

bool isInside(const PixelBox& box, const PixelBox& frame)
{
  return box.left >= frame.left && box.right <= frame.right && box.bottom >= frame.bottom && box.top <= frame.top;
}

/// Clips the segment by the box's four sides in turn (Liang, Barsky 1984).
bool crosses(const PixelSegment& segment, const PixelBox& box)
{
  double first = 0.0, last = 1.0;
  const std::array<double, 2> low = {box.left, box.bottom}, high = {box.right, box.top};
  for (std::size_t k = 0; k < 2; ++k) {
    const double from = segment.from[k], step = segment.to[k] - from;
    if (step == 0.0) {
      if (from <= low[k] || from >= high[k]) return false;
      continue;
    }
    const double enter = (low[k] - from) / step, leave = (high[k] - from) / step;
    first = std::max(first, std::min(enter, leave));
    last = std::min(last, std::max(enter, leave));
  }
  return first < last;
}

PixelBox grown(const PixelBox& box, double by)
{
  return {box.left - by, box.bottom - by, box.right + by, box.top + by};
}

bool isFree(const PixelBox& box, const LabelSpace& space)
{
  const PixelBox wide = grown(box, 0.5 * space.gap);
  return isInside(box, space.frame) &&
         std::none_of(space.taken.begin(), space.taken.end(), [&](const PixelBox& b) { return overlap(wide, b); }) &&
         std::none_of(space.lines.begin(), space.lines.end(), [&](const PixelSegment& s) { return crosses(s, wide); });
}

/// The box whose middle lies in this direction from the mark.
PixelBox beside(const Label& label, const std::array<double, 2>& direction, double reach)
{
  const double x = label.at[0] + direction[0] * (reach + 0.5 * label.width);
  const double y = label.at[1] + direction[1] * (reach + 0.5 * label.height);
  return {x - 0.5 * label.width, y - 0.5 * label.height, x + 0.5 * label.width, y + 0.5 * label.height};
}

} // namespace

std::vector<std::optional<PixelBox>> placeLabels(const std::vector<Label>& labels, const LabelSpace& given)
{
  constexpr std::array<std::array<double, 2>, 8> directions = {
      {{1, 1}, {1, 0}, {-1, -1}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}};
  LabelSpace space = given;
  std::vector<std::optional<PixelBox>> places(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (const std::array<double, 2>& direction : directions) {
      const bool slanted = direction[0] != 0.0 && direction[1] != 0.0; // may be a little nearer
      const PixelBox box = beside(labels[i], direction, space.mark_radius + (slanted ? 0.5 : 1.0) * space.gap);
      if (!isFree(box, space)) continue;
      places[i] = box;
      space.taken.push_back(box);
      break;
    }
  }
  return places;
}

} // namespace pcl_bsh::vtk
