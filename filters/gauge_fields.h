// SPDX-License-Identifier: BSD-3-Clause
// A gauging run as fields of its cloud, gathered batch by batch.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/track/gauge.h>

#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// `chainage` (FLOAT64), `offset`, `height` and `clearance` (FLOAT32, NaN without one), `envelope` (INT32, -1 where no
/// envelope counts) and `place` (UINT8, a PlaceState).
class GaugeFields {
public:
  /// Takes the answer of gauge() for the next points.
  void add(const Axis& axis, const GaugedPoints& found);

  /// For withFields(). Borrowed.
  std::vector<NewField> fields() const;

private:
  std::vector<double> chainage_;
  std::vector<float> offset_, height_, clearance_;
  std::vector<std::int32_t> envelope_;
  std::vector<std::uint8_t> place_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
