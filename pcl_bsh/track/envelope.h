// SPDX-License-Identifier: BSD-3-Clause
// The room that must stay free along an axis: a polygon in section, which may widen along it.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/track/axis.h>
#include <pcl_bsh/track/section_polygon.h>

#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A rigid vehicle on two pivots: how far it leaves the axis in a curve.
struct Vehicle {
  double pivots = 0.0;   ///< from one pivot to the other
  double overhang = 0.0; ///< from a pivot to the vehicle's end
};

/// By how much a vehicle on a circle needs more room, at its middle and at its ends. For a radius R and pivots 2p
/// apart, the middle is R - sqrt(R^2 - p^2) to the inner side. The ends are sqrt(R^2 - p^2 + (p + overhang)^2) - R to
/// the outer side, of the vehicle's own axis.
struct Overthrow {
  double inner = 0.0, outer = 0.0;
};
/// @param radius > 0; infinity: 0. @throws InvalidInput where the pivots cannot both stand on the circle
Overthrow overthrowOf(const Vehicle& vehicle, double radius);

/// Chainages from the first to the second, both inclusive.
struct ChainageRange {
  double from = 0.0, to = 0.0;
};

/// More room to either side. Corners right of the axis move to the right, those left of it to the left.
struct Widening {
  double left = 0.0, right = 0.0;
};

/// All that an envelope is made of.
struct EnvelopeDescription {
  std::string name;
  std::vector<SectionPoint> corners;
  std::vector<ChainageRange> ranges = {};        ///< where it counts; none: everywhere
  Piecewise left = {}, right = {};               ///< widening at distances along the axis, >= 0
  std::optional<Vehicle> vehicle = std::nullopt; ///< its overthrow at the axis' radius is added
};

/// Room about an axis that must stay free. Never changes.
class Envelope {
public:
  /// @throws InvalidInput naming the envelope: a polygon that simplePolygon() refuses, a widening below 0, a range that
  ///   ends before it begins, a vehicle without meaning
  explicit Envelope(EnvelopeDescription description);

  /// As the description has it.
  const std::string& name() const { return description_.name; }
  /// Its polygon before it widens.
  const std::vector<SectionPoint>& corners() const { return description_.corners; }
  /// Whether it counts at a chainage: in one of its ranges or, without ranges, everywhere.
  bool countsAt(double chainage) const;
  /// Whether a table or a vehicle widens it.
  bool widens() const;

  /// How much its tables and its vehicle widen it at a distance along the axis.
  Widening wideningAt(const Axis& axis, double distance) const;

  /// The polygon at a distance along the axis: made in `room` if the envelope widens, else corners().
  const std::vector<SectionPoint>& outlineAt(const Axis& axis, double distance, std::vector<SectionPoint>& room) const;

  /// Where about the envelope a place is, going round its box from its lower left corner: [0, 1) at its left, [1, 2)
  /// above, [2, 3) at its right, [3, 4) below. Diagonals of the box divide the four.
  double aroundOf(const SectionPoint& place) const;

private:
  EnvelopeDescription description_;
  SectionPoint middle_, half_; ///< of the box about the corners
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
