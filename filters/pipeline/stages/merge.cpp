// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/one_system.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/search/find_field.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pcl_bsh::pipeline {
namespace {

/// The field with the name, type and size of this one; null when the cloud has none.
const pcl::PCLPointField* fieldLike(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& like)
{
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name == like.name && field.datatype == like.datatype && io::sizeOf(field) == io::sizeOf(like)) {
      return &field;
    }
  }
  return nullptr;
}

/// The points of all inputs in one row, with the first one's layout and frame, and the viewpoint if all have the same.
struct Merge : Stage {
  bool number_scans = false;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      requireFields(inputs[0], inputs[i], i);
      if (inputs[i].fields.size() != inputs[0].fields.size()) requireFields(inputs[i], inputs[0], 0);
    }
    CloudHeader merged = inputs[0];
    if (number_scans && !hasScans(merged)) io::addField(merged, io::scan_field_name, pcl::PCLPointField::UINT32);
    return merged;
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    std::uint64_t points = 0;
    for (const StageCloudPtr& input : inputs) points += std::uint64_t{input->cloud.width} * input->cloud.height;
    io::requirePoints(points);
    const auto output = emptyLike(*inputs[0]);
    pcl::PCLPointCloud2& merged = output->cloud;
    output->scanners.clear();
    std::uint64_t scans = 0;
    if (number_scans && !hasScans(merged)) io::addField(merged, io::scan_field_name, pcl::PCLPointField::UINT32);
    io::allocate(merged, static_cast<std::uint32_t>(points));
    std::uint8_t* next = merged.data.data();
    for (const StageCloudPtr& input : inputs) requireOneSystem(*inputs[0], *input, "inputs", *this);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      StageCloudPtr& input = inputs[i];
      std::uint8_t* const begin = next;
      next = append(input->cloud, merged, next);
      if (number_scans) {
        const std::uint64_t count = numberScans(*input, i, scans, merged, begin, next);
        addScanners(*input, count, output->scanners);
        scans += count;
      }
      if (input->cloud.is_dense == 0) merged.is_dense = 0;
      if (input->viewpoint != output->viewpoint) output->viewpoint = io::no_viewpoint; // some have another
      input.reset();
    }
    if (output->scanners.size() != scans)
      output->scanners.clear(); // some are not known, and others' numbers would be theirs
    return output;
  }

private:
  static bool hasScans(const pcl::PCLPointCloud2& cloud) { return findField(cloud, io::scan_field_name) != nullptr; }

  /// Adds `first` to the numbers of an input's scans: its own, where it has them, or 0. Returns how many scans it has.
  static std::uint64_t numberScans(const StageCloud& input, std::size_t index, std::uint64_t first,
                                   const pcl::PCLPointCloud2& merged, std::uint8_t* record, const std::uint8_t* end)
  {
    const bool several = hasScans(input.cloud);
    std::uint64_t count = several ? input.scanners.size() : 1;
    const pcl::PCLPointField* const field = findField(merged.fields, io::scan_field_name);
    io::withFieldType(field->datatype, [&](auto number) {
      using Number = decltype(number);
      constexpr double most = std::min(static_cast<double>(std::numeric_limits<Number>::max()), 0x1p24); // a float, too
      for (; record != end; record += merged.point_step) {
        if (several) std::memcpy(&number, record + field->offset, sizeof number);
        const double own = several ? static_cast<double>(number) : 0.0, sum = own + static_cast<double>(first);
        if (!(own >= 0.0 && own == std::floor(own) && sum <= most))
          throw OptionError("inputs/" + std::to_string(index),
                            "has scan number " + io::numberText(own) + ", and " + std::to_string(first) +
                                " scans are before it: the field `scan` takes whole numbers from 0 to " +
                                io::numberText(most));
        count = std::max(count, static_cast<std::uint64_t>(own) + 1);
        number = static_cast<Number>(sum);
        std::memcpy(record + field->offset, &number, sizeof number);
      }
    });
    return count;
  }

  /// Appends where the scanners of an input's scans stood, where that is known. A viewpoint stands for one scan.
  static void addScanners(const StageCloud& input, std::uint64_t count, std::vector<io::Viewpoint>& scanners)
  {
    if (input.scanners.size() == count)
      scanners.insert(scanners.end(), input.scanners.begin(), input.scanners.end());
    else if (input.scanners.empty() && count == 1 && io::tellsPlace(input.viewpoint))
      scanners.push_back(input.viewpoint);
  }

  static void requireFields(const CloudHeader& needed, const CloudHeader& cloud, std::size_t input)
  {
    for (const pcl::PCLPointField& field : needed.fields) {
      if (fieldLike(cloud, field) != nullptr) continue;
      throw OptionError("inputs/" + std::to_string(input),
                        "has no field '" + field.name + "' of the type that another has: give clouds alike");
    }
  }

  static std::uint8_t* append(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointCloud2& merged, std::uint8_t* next)
  {
    const std::size_t points = std::size_t{cloud.width} * cloud.height;
    std::vector<std::size_t> from;
    std::vector<const pcl::PCLPointField*> fields; // except numbers of scans, where the input has none
    for (const pcl::PCLPointField& field : merged.fields) {
      const pcl::PCLPointField* const like = fieldLike(cloud, field);
      if (like == nullptr) continue;
      from.push_back(like->offset);
      fields.push_back(&field);
    }
    for (std::size_t i = 0; i < points; ++i, next += merged.point_step) {
      for (std::size_t k = 0; k < fields.size(); ++k) {
        const pcl::PCLPointField& field = *fields[k];
        std::memcpy(next + field.offset, &cloud.data[i * cloud.point_step + from[k]], io::sizeOf(field));
      }
    }
    return next;
  }
};

} // namespace

StageType merge()
{
  return describe<Merge>("filters.merge", "All points of several clouds with the same fields, as one row.")
      .alias("pcl::concatenate")
      .inputs(1, std::numeric_limits<std::size_t>::max())
      .option(&Merge::number_scans, "number_scans",
              "a field `scan` numbers the scans that the points are of, and the cloud keeps where each scanner stood, "
              "which `seen` needs");
}

} // namespace pcl_bsh::pipeline
