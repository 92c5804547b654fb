// SPDX-License-Identifier: BSD-3-Clause
// How far the points of a cloud may truly be from where they were measured: one length for all, or a field of sigmas.
//
//   filter.setInputUncertainty({0.004});                      // k sigma of the scanner, in the clouds' unit
//   filter.setObstacleUncertainty(Uncertainty("sigma", 3.0)); // three times each point's field `sigma`
//
// A verdict is as sure as this length is: a point whose error exceeds it is misjudged. It is the radius of a ball. Add
// all errors: k sigma of the range, the angles' error times the range, and the registration's error. This one moves all
// points of a scan together (PoseUncertainty). Lague, Brodu, Leroux (Accurate 3D comparison of complex topography with
// terrestrial laser scanner, 2013) add it to the noise, too. If errors are normal and alike in all directions, 2.9 %
// exceed 3 sigma and 0.1 % exceed 4. Bias, mixed pixels at edges, glass and water are no noise: no sigma covers them.
//
// Phase-based terrestrial scanner: ranging noise in the data sheet, a sigma by distance and reflectance, mostly below
// some millimetres, and the ranging error beside it. Noise grows where signals are weak, on dark, far and slanting
// surfaces (FARO, Quality Setting Function on the Focus3D). A field of sigmas computed from the intensity is better
// than one length (Schmitz et al., How to Efficiently Determine the Range Precision of 3D Terrestrial Laser Scanners,
// Sensors 19, 1466, 2019). The thickness of a scanned flat wall shows whether the number is right.
//
// Spinning lidar: centimetres, by signal. The data sheet of Ouster's OS1 has named 1.5 cm (1 sigma) for strong returns,
// 3 cm for weaker and 10 cm for the weakest, and 0.01 degrees for its angles. Use the data sheet of your sensor and
// year. A vehicle's own motion and its estimate come on top and are often larger.
//
// Photogrammetry: no sensor's number. The error differs from place to place, with overlap, angles and texture. Take
// precision maps where the software makes them, else the error at independent check points. James, Robson, Smith
// describe these maps (3-D uncertainty-based topographic change detection with structure-from-motion photogrammetry:
// precision maps, 2017). Control points that took part in the adjustment say too little (Sanz-Ablanedo et al., Remote
// Sensing 10, 1606, 2018).
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/question/pose_uncertainty.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Each point is within this of where it was measured: within a ball, whichever way the measurement errs.
struct Uncertainty {
  Uncertainty() = default;

  /// @param of_all_points in the cloud's unit; finite and >= 0
  Uncertainty(double of_all_points) : length(of_all_points) {} // NOLINT: a length is the common one

  /// @param of_sigmas the field that holds each point's standard deviation, in the cloud's unit; finite and >= 0 where
  ///   the point is finite. @param times how many of these deviations a point is off at most; finite and >= 0
  Uncertainty(std::string of_sigmas, double times) : field(std::move(of_sigmas)), sigmas(times) {}

  double length = 0.0;
  std::string field; ///< of each point's sigma; empty: `length` counts
  double sigmas = 1.0;
  PoseUncertainty pose = {}; ///< on top: all points may move together

  /// Points are where they were measured.
  bool isZero() const { return field.empty() && length == 0.0 && pose.isZero(); }
  /// Whether both say the same.
  bool operator==(const Uncertainty& other) const
  {
    return length == other.length && field == other.field && sigmas == other.sigmas && pose == other.pose;
  }
};

/// A number, or several, of each record of a cloud.
struct RecordField {
  std::string name;
  std::uint32_t offset = 0;  ///< bytes from a record's start
  std::uint8_t datatype = 7; ///< as PCL and ROS number types: 1 int8, 2 uint8, ... 7 float32, 8 float64
  std::uint32_t count = 1;   ///< numbers
};

/// Refuses numbers that are not finite and >= 0. @param cloud its name in errors. @throws InvalidInput
void checkUncertainty(const std::string& cloud, const Uncertainty& uncertainty);

/// Returns the view with these uncertainties added to those that it has. It also keeps alive what the given view keeps.
/// @param fields of the view's records. @param cloud its name in errors
/// @throws InvalidInput naming the value, the point or the field: a number that is negative or not finite, a field that
///   is missing or holds more than one number a point
PointsView withUncertainty(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                           const Uncertainty& uncertainty);

/// Returns a checksum of a field's numbers; bytes beside them do not count. @param name empty, or of no field: 0
std::uint64_t checksumOf(const PointsView& view, const std::vector<RecordField>& fields, const std::string& name);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
