// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/sampling/record_mean.h>
#include <pcl_bsh/io/clouds/records.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <type_traits>

namespace pcl_bsh::pipeline {
namespace {

bool isCoordinate(const std::string& name)
{
  return name == "x" || name == "y" || name == "z";
}

bool isColour(const pcl::PCLPointField& field)
{
  return (field.name == "rgb" || field.name == "rgba") && io::sizeOf(field.datatype) == 4;
}

} // namespace

RecordMeans::RecordMeans(const StageCloud& cloud, bool all_fields) : cloud_(cloud.cloud), output_(emptyLike(cloud))
{
  for (const pcl::PCLPointField& field : cloud_.fields) {
    if (!all_fields && !isCoordinate(field.name)) continue;
    const bool real = field.datatype == pcl::PCLPointField::FLOAT32 || field.datatype == pcl::PCLPointField::FLOAT64;
    const How how = isColour(field) ? How::channels : real ? How::mean : How::most_frequent;
    for (std::uint32_t i = 0; i < std::max(field.count, 1U); ++i) {
      parts_.push_back({field.offset + i * io::sizeOf(field.datatype), field.datatype, how});
    }
    const bool normal = field.name == "normal_x" || field.name == "normal_y" || field.name == "normal_z";
    if (normal && field.datatype == pcl::PCLPointField::FLOAT32) normal_offsets_.push_back(field.offset);
  }
  if (normal_offsets_.size() != 3) normal_offsets_.clear();
}

void RecordMeans::add(const std::vector<std::uint32_t>& records)
{
  const std::size_t step = cloud_.point_step;
  std::vector<std::uint8_t>& out = output_->cloud.data;
  const std::uint8_t* const first = &cloud_.data[records[0] * step];
  out.insert(out.end(), first, first + step);
  if (records.size() == 1) return;
  std::uint8_t* const record = out.data() + out.size() - step;
  for (const Part& part : parts_) combine(part, records, record);
  if (!normal_offsets_.empty()) normalise(record);
}

StageCloudPtr RecordMeans::finished()
{
  pcl::PCLPointCloud2& cloud = output_->cloud;
  cloud.width = static_cast<std::uint32_t>(cloud.data.size() / std::max(cloud.point_step, 1U));
  cloud.row_step = cloud.width * cloud.point_step;
  io::setDense(cloud);
  return std::move(output_);
}

void RecordMeans::combine(const Part& part, const std::vector<std::uint32_t>& records, std::uint8_t* record) const
{
  const auto bytesOf = [&](std::uint32_t i) { return &cloud_.data[std::size_t{i} * cloud_.point_step + part.offset]; };
  const auto count = static_cast<double>(records.size());
  if (part.how == How::channels) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      double sum = 0;
      for (const std::uint32_t i : records) sum += bytesOf(i)[channel];
      record[part.offset + channel] = static_cast<std::uint8_t>(sum / count); // PCL cuts off fractions, too
    }
    return;
  }
  io::withFieldType(part.datatype, [&](auto value) {
    using T = decltype(value);
    const auto valueOf = [&](std::uint32_t i) {
      std::memcpy(&value, bytesOf(i), sizeof value);
      return value;
    };
    if constexpr (std::is_floating_point_v<T>) {
      const double first = valueOf(records[0]);
      double sum = 0;
      for (const std::uint32_t i : records) sum += static_cast<double>(valueOf(i)) - first;
      value = static_cast<T>(first + sum / count);
    }
    else {
      std::map<T, std::size_t> occurrences;
      for (const std::uint32_t i : records) ++occurrences[valueOf(i)];
      value = std::max_element(occurrences.begin(), occurrences.end(), [](const auto& a, const auto& b) {
                return a.second < b.second;
              })->first;
    }
    std::memcpy(record + part.offset, &value, sizeof value);
  });
}

void RecordMeans::normalise(std::uint8_t* record) const
{
  std::array<float, 3> normal;
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::memcpy(&normal[k], record + normal_offsets_[k], sizeof(float));
    squared += static_cast<double>(normal[k]) * normal[k];
  }
  if (!(squared > 0)) return;
  for (std::size_t k = 0; k < 3; ++k) {
    normal[k] = static_cast<float>(normal[k] / std::sqrt(squared));
    std::memcpy(record + normal_offsets_[k], &normal[k], sizeof(float));
  }
}

} // namespace pcl_bsh::pipeline
