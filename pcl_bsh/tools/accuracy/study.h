// SPDX-License-Identifier: BSD-3-Clause
// The cost of accuracy in time, measured on a caller's own clouds.
#pragma once

#include <pcl_bsh/collide.h>

#include <functional>
#include <string>
#include <vector>

namespace pcl_bsh::accuracy {

/// Two clouds, and where the second stands in the frame of the first.
struct Subject {
  PointsView a, b;
  double clearance = 0.0;
  std::vector<Eigen::Isometry3d> poses; ///< T_a_b
  double diameter = 0.0;                ///< of a's bounding box
  std::string unit;                     ///< of lengths, for titles; empty: not known
  std::vector<double> tolerances = {};  ///< of the distance, measured beside the usual settings
};

struct Spread {
  double low = 0.0, median = 0.0, high = 0.0; ///< quartiles: a quarter, half and three quarters of the values are below
};

/// One setting of one query, over all poses.
struct Measurement {
  std::string query; ///< any, flags or distance
  std::string knob;  ///< which kind of accuracy is set, or which peer
  std::string setting;
  bool peer = false; ///< another library's
  Spread seconds;    ///< of one query, all built before: spreadOfPoses()
  Spread once;       ///< of one query and of all that is built for it
  Work work;         ///< of all poses together
  bool certified = true;
  double certified_error = 0.0; ///< distance: widest interval of all poses; flags, any: share left undecided
  double actual_error = 0.0;    ///< distance: farthest from exact at any pose; flags, any: share of wrong answers
  std::size_t wrong = 0;        ///< flags, any: answers that differ from exact
  std::size_t poses = 0;
};

/// One way to choose centres of spheres.
struct FitMeasurement {
  std::string fit;
  Spread build;                ///< seconds, both clouds, everything built
  double mean_leaf_radius = 0; ///< of a
  Spread flags, distance;      ///< seconds of an exact query, the mean of the poses
};

struct Study {
  std::size_t colliding = 0; ///< points of a, counted at every pose
  std::vector<Measurement> measurements;
  std::vector<FitMeasurement> fits;
};

/// Called with what is being measured and the share done.
using Progress = std::function<void(const std::string&, double)>;

/// Measures all settings. Repetitions are interleaved, so that disturbances of the machine meet all settings alike.
Study runStudy(const Subject& subject, unsigned repetitions, unsigned threads, const Progress& progress);

Spread spreadOf(std::vector<double> values);

/// The spread over the poses of each pose's median, which an interruption in one repetition does not move. For a single
/// pose, the spread over its repetitions. @param samples for each pose a value of each repetition; no list may be empty
Spread spreadOfPoses(const std::vector<std::vector<double>>& samples);

/// The nearest of 1, 3 and 10 times a power of ten, by logarithms. @param length > 0
double roundLength(double length);

/// The length rounded down to two digits. @param length > 0
double roundLengthDown(double length);

} // namespace pcl_bsh::accuracy
