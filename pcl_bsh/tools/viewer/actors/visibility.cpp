// SPDX-License-Identifier: BSD-3-Clause
#include "visibility.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace pcl_bsh::viewer {

namespace {

constexpr vtkIdType most_places = 300000;
constexpr int columns = 240, rows = 160;

struct Cell {
  std::size_t index;
  double away; ///< from the eye, along the view
};

std::optional<Cell> cellOf(const Gaze& gaze, const Eigen::Vector3d& place)
{
  const Eigen::Vector3d from_eye = place - gaze.at;
  const double away = -from_eye.dot(gaze.toward);
  if (!(away > 0.0)) return std::nullopt;
  const double x = 0.5 + 0.5 * from_eye.dot(gaze.right) / (away * gaze.wide);
  const double y = 0.5 + 0.5 * from_eye.dot(gaze.up) / (away * gaze.tall);
  if (!(x >= 0.0 && x < 1.0 && y >= 0.0 && y < 1.0)) return std::nullopt;
  return Cell{static_cast<std::size_t>(y * rows) * columns + static_cast<std::size_t>(x * columns), away};
}

/// The nearest place of a thing in each cell.
std::vector<double> frontOf(const Gaze& gaze, const std::vector<Eigen::Vector3d>& places)
{
  std::vector<double> front(static_cast<std::size_t>(columns) * rows, std::numeric_limits<double>::infinity());
  for (const Eigen::Vector3d& place : places)
    if (const auto cell = cellOf(gaze, place)) front[cell->index] = std::min(front[cell->index], cell->away);
  return front;
}

} // namespace

std::vector<Eigen::Vector3d> placesOf(vtkPolyData& drawn, const Eigen::Isometry3d& pose, double step,
                                      const std::function<bool(const Eigen::Vector3d&)>& left_out)
{
  std::vector<Eigen::Vector3d> places;
  const auto add = [&](const Eigen::Vector3d& own) {
    const Eigen::Vector3d place = pose * own;
    if (place.allFinite() && !(left_out && left_out(place))) places.push_back(place);
  };
  const auto pointOf = [&](vtkIdType id) {
    Eigen::Vector3d p;
    drawn.GetPoint(id, p.data());
    return p;
  };
  const vtkIdType triangles = drawn.GetNumberOfPolys(), points = drawn.GetNumberOfPoints();
  if (triangles == 0) {
    const vtkIdType stride = points / most_places + 1;
    for (vtkIdType id = 0; id < points; id += stride) add(pointOf(id));
    return places;
  }
  const vtkIdType stride = triangles / most_places + 1;
  const double most_steps = std::clamp(std::sqrt(2.0 * most_places / static_cast<double>(triangles)), 1.0, 400.0);
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < triangles; cell += stride) {
    drawn.GetPolys()->GetCellAtId(cell, corners);
    if (corners->GetNumberOfIds() < 3) continue;
    const std::array<Eigen::Vector3d, 3> at = {pointOf(corners->GetId(0)), pointOf(corners->GetId(1)),
                                               pointOf(corners->GetId(2))};
    const double longest = std::max({(at[1] - at[0]).norm(), (at[2] - at[0]).norm(), (at[2] - at[1]).norm()});
    const int steps = static_cast<int>(std::clamp(std::ceil(longest / step), 1.0, most_steps));
    for (int i = 0; i < steps; ++i) // in the middle of small triangles, so that none lies on an edge
      for (int k = 0; i + k < steps; ++k)
        add(at[0] + ((i + 1.0 / 3) * (at[1] - at[0]) + (k + 1.0 / 3) * (at[2] - at[0])) / steps);
  }
  return places;
}

double shareSeen(const Gaze& gaze, std::span<const Drawn> things)
{
  constexpr double own_cells = 4.0, rounding = 1e-6;
  std::vector<std::vector<double>> fronts;
  for (const Drawn& thing : things) fronts.push_back(frontOf(gaze, thing.places));
  std::size_t all = 0, seen = 0;
  for (std::size_t of = 0; of < things.size(); ++of) {
    all += things[of].marks.size();
    for (const Eigen::Vector3d& mark : things[of].marks) {
      const auto cell = cellOf(gaze, mark);
      if (!cell) continue;
      const double own = cell->away * (1.0 - own_cells * 2.0 * gaze.tall / rows),
                   others = cell->away * (1.0 - rounding);
      bool hidden = false;
      for (std::size_t i = 0; i < things.size(); ++i) hidden |= fronts[i][cell->index] < (i == of ? own : others);
      seen += hidden ? 0 : 1;
    }
  }
  return all > 0 ? static_cast<double>(seen) / static_cast<double>(all) : 0.0;
}

} // namespace pcl_bsh::viewer
