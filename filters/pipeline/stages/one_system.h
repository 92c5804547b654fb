// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/filters/pipeline/stage_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/naming_option.h>
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>

#include <string>

namespace pcl_bsh::pipeline {

/// Refuses a cloud whose coordinate system is known to be another than that of a stage's input.
/// @param option the option that gives the other cloud. @param stage the stage that warns where a system is not known
inline void requireOneSystem(const StageCloud& input, const StageCloud& other, const std::string& option, Stage& stage)
{
  if (input.system_definition.empty() || other.system_definition.empty()) return;
  const auto warning = namingOption(option, [&] {
    return io::requireOneSystem("the input", {input.coordinate_system, input.system_definition},
                                {other.coordinate_system, other.system_definition},
                                "give the readers of both `to_crs`, or give one \"crs\": \"none\" where poses lead "
                                "from the one to the other");
  });
  if (warning) stage.warn(option + ' ' + *warning);
}

} // namespace pcl_bsh::pipeline
