// SPDX-License-Identifier: BSD-3-Clause
// Where a cloud's fields go in the points of a LAS file.
#pragma once

#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/header.h>

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// The records of a cloud that LAS has a place for: those with finite coordinates.
class LasPoints {
public:
  /// @throws FormatError when the cloud has not one each of x y z, float32 or float64
  explicit LasPoints(const pcl::PCLPointCloud2& cloud);

  const std::vector<pcl::PCLPointField>& fields() const { return fields_; }
  const pcl::PCLPointField* field(const std::string& name) const;
  std::uint64_t size() const { return size_; }
  std::size_t step() const { return cloud_.point_step; }
  double least(std::size_t axis) const { return least_[axis]; }
  double greatest(std::size_t axis) const { return greatest_[axis]; }

  /// Hands out the records, some thousands at a time.
  void forEachBatch(const std::function<void(const std::uint8_t* records, std::size_t points)>& use) const;

private:
  const pcl::PCLPointCloud2& cloud_;
  std::vector<pcl::PCLPointField> fields_;
  std::uint64_t size_ = 0;
  std::array<double, 3> least_, greatest_;
};

/// A field of the file, and where in a cloud's record its values are; without a datatype they are 0, or 1 for returns
/// of a pulse.
struct LasTarget {
  LasField field;
  std::size_t from = 0;
  std::uint8_t datatype = 0;
  bool packed_colour = false; ///< red, green, blue from rgb or rgba
};

struct LasPlan {
  std::uint8_t minor = 4;
  std::uint8_t format = 6;
  std::size_t record_length = 0;
  std::array<double, 3> scale{}, offset{};
  std::vector<LasTarget> targets;
  std::optional<std::string> descriptors; ///< of extra bytes; none: as the header has them

  /// Fills the records of a batch.
  void encode(const std::uint8_t* in, std::size_t step, std::size_t points, std::string& records) const;
};

/// As writeLas() says. @throws FormatError
LasPlan planLas(const LasPoints& points, const LasHeader* header);

} // namespace pcl_bsh::io
