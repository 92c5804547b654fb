// SPDX-License-Identifier: BSD-3-Clause
// Fields for the results of a stage, one value per point.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// Gives the cloud these fields, of one value each, at the end of its records; those that are there already are used.
/// @return where in a record each of them lies
/// @throws std::invalid_argument when a field of that name is there with another type
std::vector<std::size_t> addFields(pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                                   std::uint8_t datatype);

} // namespace pcl_bsh::pipeline
