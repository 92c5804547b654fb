// SPDX-License-Identifier: BSD-3-Clause
// Clouds in the unit or the coordinate system that the settings of their reading want.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/systems/system_transform.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Converts a file's points to the unit or the coordinate system that is wanted.
class Conversion {
public:
  /// @param facts of the file: system, unit and remarks become those of the converted points
  /// @param box of the points as the file has them, where another system is wanted
  /// @throws FormatError as scaleOf(), systemOf() and SystemTransform do
  Conversion(CloudFacts& facts, const ReadSettings& settings, const Eigen::AlignedBox3d& box);

  /// Whether records stay as they are, types too.
  bool isNothing() const { return !transform_ && scale_.isOne(); }

  /// @pre usable x y z. @param first the number of the first record, for errors
  /// @throws FormatError as scaleLengths() and transformPlaces() do
  void operator()(pcl::PCLPointCloud2& records, std::uint64_t first = 0) const;

  /// Converts the places of the file's scanners. A place at the origin stays: it says that the place is not known.
  void moveScanners(CloudFacts& facts) const;

private:
  std::vector<std::string> length_fields_;
  LengthScale scale_;
  std::optional<SystemTransform> transform_;
};

/// Converts a cloud, where its scanners stood, and what is told of it. @pre usable x y z; facts have the file's own
/// @throws FormatError as Conversion does
void convert(pcl::PCLPointCloud2& cloud, CloudFacts& facts, const ReadSettings& settings);

/// Gives a header without points the types that convert() gives. @param told unit and system that the file names
void convertHeader(pcl::PCLPointCloud2& header, const CloudFacts& told, const ReadSettings& settings);

} // namespace pcl_bsh::io
