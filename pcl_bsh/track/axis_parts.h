// SPDX-License-Identifier: BSD-3-Clause
// The data of an axis: its pieces in order, the planes between them, and a tree of boxes about them.
#pragma once

#include <pcl_bsh/track/axis.h>
#include <pcl_bsh/track/axis_piece.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_bsh {

/// How cant turns a section: by which angle, and how far it moves the middle between the rails.
struct CantTurn {
  double sine, cosine, right = 0.0, above = 0.0;

  CantTurn(const AxisDescription& description, double cant)
  : sine(cant / description.gauge),
    cosine(std::sqrt(1.0 - sine * sine))
  {
    if (description.pivot == CantPivot::centre) return;
    const double half = 0.5 * description.gauge; // the low rail stays
    right = std::copysign(half * (sine * sine / (1.0 + cosine)), sine);
    above = half * std::abs(sine);
  }
};

struct Axis::Parts {
  /// @throws InvalidInput
  Parts(const AxisDescription& from, AxisFit& fit);

  struct Box {
    double low_x, low_y, high_x, high_y;

    bool isNear(double x, double y, double reach) const
    {
      return x >= low_x - reach && x <= high_x + reach && y >= low_y - reach && y <= high_y + reach;
    }
    void add(const Box& other);
  };

  const AxisPiece& pieceAt(double distance) const;

  /// Calls visit(i) for each piece whose box is within reach along both axes, in their order.
  template <class Visit>
  void forPiecesNear(double x, double y, double reach, const Visit& visit) const
  {
    struct Entry {
      std::size_t level, index;
    };
    std::array<Entry, 64> stack;
    std::size_t size = 0;
    stack[size++] = {levels.size() - 1, 0};
    while (size > 0) {
      const Entry entry = stack[--size];
      if (!levels[entry.level][entry.index].isNear(x, y, reach)) continue;
      if (entry.level == 0) {
        visit(entry.index);
        continue;
      }
      const std::size_t child = 2 * entry.index;
      if (child + 1 < levels[entry.level - 1].size()) stack[size++] = {entry.level - 1, child + 1};
      stack[size++] = {entry.level - 1, child};
    }
  }

  AxisDescription description;
  Point3 origin = {}; ///< whole numbers near the beginning: coordinates minus these are exact
  double length = 0.0;
  std::vector<AxisPiece> pieces;
  std::vector<PlanFrame> junctions;     ///< before each piece, and behind the last
  std::vector<std::vector<Box>> levels; ///< of each piece, of two boxes below, ... of all
  Piecewise heights, cants, chainages;  ///< heights above the origin
  double smallest_radius, smallest_radius_at = 0.0;

private:
  void lay(const PlanElement& element, double begin, PlanFrame& at, double& heading);
  void layPlan(AxisFit& fit);
  void makeBoxes();
  void makeHeights();
};

} // namespace pcl_bsh
