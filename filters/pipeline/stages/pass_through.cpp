// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/field_type.h>
#include <pcl_bsh/filters/io/nearest_name.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace pcl_bsh::pipeline {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// PCL's own knows float32 fields only, and answers an unknown name with an empty cloud.
struct PassThrough : SelectingStage {
  std::string filter_field_name;
  Numbers<2> filter_limits = {-infinity, infinity};

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    if (filter_limits[0] > filter_limits[1]) {
      throw OptionError("filter_limits", "has a least above its most: exchange them");
    }
    findField(inputs[0]);
    return inputs[0];
  }

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    const pcl::PCLPointCloud2& points = cloud->cloud;
    std::vector<std::uint8_t> passes(std::size_t{points.width} * points.height, 1);
    const pcl::PCLPointField* field = findField(points);
    if (field == nullptr) return passes;
    io::withFieldType(field->datatype, [&](auto value) {
      // As PCL has it, float fields are compared with the limits as floats: 0.3 is then the same number on both sides.
      using Number = std::conditional_t<std::is_same_v<decltype(value), float>, float, double>;
      const auto least = static_cast<Number>(filter_limits[0]);
      const auto most = static_cast<Number>(filter_limits[1]);
      const std::uint8_t* next = points.data.data() + field->offset;
      for (std::uint8_t& pass : passes) {
        std::memcpy(&value, next, sizeof value);
        const auto number = static_cast<Number>(value);
        // A value that is not finite passes neither way.
        pass = std::isfinite(number) ? number >= least && number <= most : negative;
        next += points.point_step;
      }
    });
    return passes;
  }

private:
  /// Null when no field is asked for.
  const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud) const
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
                  "[least, most], both inclusive, in the field's unit; null in place of one: no limit");
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
