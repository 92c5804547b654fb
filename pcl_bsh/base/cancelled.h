// SPDX-License-Identifier: BSD-3-Clause
// Thrown by a query that its caller has told to stop.
#pragma once

#include <pcl_bsh/export.h>

#include <stdexcept>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Thrown by work that its caller has asked to stop. Every object is as it was before, or gives the right answer when
/// it is asked again.
class Cancelled : public std::runtime_error {
public:
  Cancelled() : std::runtime_error("stopped on request: no result") {}
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
