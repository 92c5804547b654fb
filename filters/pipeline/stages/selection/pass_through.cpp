// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/selection/exact_limits.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/json/nearest_name.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace pcl_bsh::pipeline {
namespace {

/// PCL's own knows float32 fields only, and answers an unknown name with an empty cloud.
struct PassThrough : SelectingStage {
  std::string filter_field_name;
  Limits filter_limits;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    if (areCrossed(filter_limits)) {
      throw OptionError("filter_limits", "has a least above its most: exchange them");
    }
    filteredField(inputs[0]);
    return inputs[0];
  }

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    const pcl::PCLPointCloud2& points = cloud->cloud;
    std::vector<std::uint8_t> passes(std::size_t{points.width} * points.height, 1);
    const pcl::PCLPointField* field = filteredField(points);
    if (field == nullptr) return passes;
    io::withFieldType(field->datatype, [&](auto value) {
      using Number = decltype(value);
      const std::optional<RangeOf<Number>> range = rangeOf<Number>(filter_limits);
      const std::uint8_t* next = points.data.data() + field->offset;
      for (std::uint8_t& pass : passes) {
        std::memcpy(&value, next, sizeof value);
        pass = range && value >= range->least && value <= range->most;
        if constexpr (std::is_floating_point_v<Number>) {
          if (!std::isfinite(value)) pass = negative; // passes neither way
        }
        next += points.point_step;
      }
    });
    return passes;
  }

private:
  /// Null when no field is asked for.
  const pcl::PCLPointField* filteredField(const pcl::PCLPointCloud2& cloud) const
  {
    if (filter_field_name.empty()) return nullptr;
    std::vector<std::string> names;
    for (const pcl::PCLPointField& field : cloud.fields) {
      if (field.name == filter_field_name && field.count <= 1) return &field;
      if (field.count <= 1) names.push_back(field.name);
    }
    throw OptionError("filter_field_name", "is '" + filter_field_name + "', which is no field with one value: " +
                                               io::suggestion(filter_field_name, names));
  }
};

} // namespace

StageType passThrough()
{
  auto description =
      describe<PassThrough>("filters.pass_through", "Keeps points with a field's value between two limits.")
          .alias("pcl::PassThrough")
          .option(&PassThrough::filter_field_name, "filter_field_name",
                  "the field, of any type; empty: only points that are not finite are removed")
          .option(&PassThrough::filter_limits, "filter_limits",
                  "[least, most], both inclusive, in the field's unit; null in place of one: no limit; whole numbers "
                  "keep all of their 64 bits");
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
