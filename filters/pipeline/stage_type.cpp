// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

namespace pcl_bsh::pipeline {
namespace {

/// In the order of the documentation.
std::deque<StageType> builtInStages()
{
  std::deque<StageType> all = fileReaders();
  for (const auto& stage : {voxelGrid, approximateVoxelGrid, uniformSampling, passThrough, cropBox,
                            statisticalOutlierRemoval, radiusOutlierRemoval, transform, normalEstimation,
                            euclideanCluster, merge, bshCollision, bshFlag, bshDistance, gaugeStage})
    all.push_back(stage());
  const std::deque<StageType> writers = fileWriters();
  all.insert(all.end(), writers.begin(), writers.end());
  for (const auto& stage : {clashWriter, distanceWriter}) all.push_back(stage());
  return all;
}

std::deque<StageType>& table()
{
  static std::deque<StageType> types = builtInStages(); // a deque: pointers to its rows stay valid when more are added
  return types;
}

bool isNamed(const StageType& type, const std::string& name)
{
  return type.name == name || std::find(type.aliases.begin(), type.aliases.end(), name) != type.aliases.end();
}

void requireRegistrable(const StageType& type)
{
  const std::string stage = "stage '" + type.name + "': ";
  const auto begins = [&](const char* prefix) {
    return type.name.rfind(prefix, 0) == 0 && type.name.size() > std::string(prefix).size();
  };
  if (!begins("readers.") && !begins("filters.") && !begins("writers.")) {
    throw std::invalid_argument(stage + "begin its name with readers., filters. or writers.");
  }
  std::vector<std::string> names = type.aliases;
  names.push_back(type.name);
  for (const std::string& name : names) {
    if (findStageType(name) != nullptr) throw std::invalid_argument(stage + "'" + name + "' is taken: rename it");
  }
  std::vector<std::string> keys = {"type", "tag", "inputs", "user_data"};
  for (const Option& option : type.options) {
    if (std::find(keys.begin(), keys.end(), option.name) != keys.end()) {
      throw std::invalid_argument(stage + "option '" + option.name + "' is taken: rename it");
    }
    keys.push_back(option.name);
  }
}

} // namespace

const Option* StageType::findOption(const std::string& option) const
{
  const auto found = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == option; });
  return found == options.end() ? nullptr : &*found;
}

void StageType::addOption(Option option)
{
  option.standard = option.get(*make());
  option.nullable = !option.required && std::holds_alternative<std::monostate>(option.standard);
  options.push_back(std::move(option));
}

bool registerStage(StageType type)
{
  requireRegistrable(type);
  table().push_back(std::move(type));
  return true;
}

const std::deque<StageType>& stageTypes()
{
  return table();
}

const StageType* findStageType(const std::string& name)
{
  const auto found =
      std::find_if(table().begin(), table().end(), [&](const StageType& type) { return isNamed(type, name); });
  return found == table().end() ? nullptr : &*found;
}

} // namespace pcl_bsh::pipeline
