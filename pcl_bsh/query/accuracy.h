// SPDX-License-Identifier: BSD-3-Clause
// The dial: what a caller gives up for time, and what stays guaranteed.
//
//   request.accuracy = Accuracy::time(0.001); // the best certified answer that a millisecond buys
//
// Every answer is proven, whatever the setting: what is not known is Undecided, or an interval that holds the truth.
#pragma once

#include <pcl_bsh/export.h>

#include <cstdint>
#include <string>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// How sure an answer has to be. Lengths in the clouds' unit.
struct Accuracy {
  /// One for each function below that makes an Accuracy.
  enum class Mode : std::uint8_t { exact, tolerance, level, node_pairs, time };

  Mode mode = Mode::exact;
  double value = 0.0; ///< what the mode counts; 0 where it counts nothing

  /// The answer of exact arithmetic on the given numbers.
  static Accuracy exact() noexcept { return {Mode::exact, 0.0}; }

  /// Pairs at distances in (clearance, clearance + length] may go either way, all others are right; a distance is found
  /// to within `length`. @param length finite, >= 0
  static Accuracy tolerance(double length) noexcept { return {Mode::tolerance, length}; }

  /// The descent opens the sphere trees below the voxels down to this level: 0 compares the voxels' spheres, each level
  /// more opens nodes of eight children. Pairs that spheres do not decide are left undecided. At level 0 flags and
  /// distances of points build nothing. anyCollision() and closestPair() open the nearest pair of nodes first. They end
  /// when its node is below this level, but a descent that has begun goes on to the points, for a near pair.
  static Accuracy level(unsigned depth) noexcept { return {Mode::level, static_cast<double>(depth)}; }

  /// Stops after about so many sphere tests: the same answer on every machine. Where points of both clouds are flagged,
  /// both clouds share the tests.
  static Accuracy nodePairs(std::uint64_t count) noexcept { return {Mode::node_pairs, static_cast<double>(count)}; }

  /// Stops when the seconds are spent; all parts of one call share them. In anyCollision() 15/16 of them go to the
  /// search of exact(), so it decides all that exact() decides in this time. @param seconds finite, >= 0
  static Accuracy time(double seconds) noexcept { return {Mode::time, seconds}; }

  /// `exact`, `tolerance=LENGTH`, `level=N`, `pairs=N` or `time=SECONDS`.
  /// @throws std::invalid_argument quoting the text when parse() cannot read it
  static Accuracy parse(const std::string& text);

  /// The text that parse() reads.
  std::string text() const;

  bool isExact() const noexcept { return mode == Mode::exact; } ///< the default

  /// Whether answers may stay undecided: the modes that stop before the end.
  bool stopsEarly() const noexcept { return mode == Mode::level || mode == Mode::node_pairs || mode == Mode::time; }
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
