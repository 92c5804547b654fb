// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/uncertainty.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/points_checksum.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace pcl_bsh {
namespace {

InvalidInput refusal(const std::string& cloud, const std::string& wrong, const std::string& remedy)
{
  return InvalidInput(Input::uncertainty, cloud, wrong, remedy);
}

const RecordField& fieldNamed(const std::string& name, const std::vector<RecordField>& fields, const std::string& cloud)
{
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const RecordField& field) { return field.name == name; });
  if (found == fields.end()) {
    std::string names;
    for (const RecordField& field : fields) names += (names.empty() ? "" : ", ") + field.name;
    throw refusal(cloud, "field '" + name + "' of its points' sigmas is missing",
                  "give a length, or one of its fields: " + names);
  }
  if (found->count > 1) {
    throw refusal(cloud, "field '" + name + "' holds " + counted(found->count, "value") + " per point",
                  "give one that holds one");
  }
  return *found;
}

template <typename T>
double valueAt(const unsigned char* record)
{
  T value;
  std::memcpy(&value, record, sizeof value);
  return static_cast<double>(value);
}

/// How a number of a type is read; a type that nobody knows has no bytes.
struct FieldType {
  std::size_t bytes = 0;
  double (*value)(const unsigned char*) = [](const unsigned char*) { return std::numeric_limits<double>::quiet_NaN(); };
};

FieldType typeOf(const RecordField& field)
{
  static constexpr FieldType types[] = {{},
                                        {1, valueAt<std::int8_t>},
                                        {1, valueAt<std::uint8_t>},
                                        {2, valueAt<std::int16_t>},
                                        {2, valueAt<std::uint16_t>},
                                        {4, valueAt<std::int32_t>},
                                        {4, valueAt<std::uint32_t>},
                                        {4, valueAt<float>},
                                        {8, valueAt<double>}};
  return types[field.datatype < std::size(types) ? field.datatype : 0];
}

/// No less than the product; infinity where no float is.
float productUpward(double x, double y)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double product = x * y;
  return roundUp(std::fma(x, y, -product) > 0.0 ? std::nextafter(product, infinity) : product);
}

/// What a view of uncertain points keeps alive.
struct Owned {
  std::vector<float> lengths;
  std::shared_ptr<const void> points;
};

} // namespace

void checkUncertainty(const std::string& cloud, const Uncertainty& uncertainty)
{
  const auto require = [&](const char* what, double value) {
    if (std::isfinite(value) && value >= 0.0) return;
    throw refusal(cloud, plainText(what, value), "give a finite number >= 0").withValue(value);
  };
  require("uncertainty ", uncertainty.length);
  require("number of sigmas ", uncertainty.sigmas);
}

PointsView withUncertainty(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                           const Uncertainty& uncertainty)
{
  checkUncertainty(cloud, uncertainty);
  PointsView uncertain = view;
  if (uncertainty.field.empty()) {
    uncertain.uncertainty = uncertainty.length;
    return uncertain;
  }
  const RecordField& field = fieldNamed(uncertainty.field, fields, cloud);
  auto owned = std::make_shared<Owned>();
  owned->points = view.owner;
  owned->lengths.resize(view.count);
  const FieldType type = typeOf(field);
  if (view.count > 0 && field.offset + type.bytes > view.stride)
    throw refusal(cloud, "field '" + field.name + "' reaches beyond its record", "mend the cloud's fields");
  const auto* record = static_cast<const unsigned char*>(view.data) + field.offset;
  for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
    if (!isFinite(view.point(static_cast<std::uint32_t>(i)))) continue; // it takes part in nothing
    const double sigma = type.value(record);
    const float length = productUpward(sigma, uncertainty.sigmas);
    if (sigma >= 0.0 && std::isfinite(length)) {
      owned->lengths[i] = length;
      continue;
    }
    throw refusal(cloud, plainText("field '", field.name, "' of point ", i, " is ", sigma),
                  plainText("give finite lengths >= 0, no more than ", std::numeric_limits<float>::max(), " in all"))
        .withValue(sigma)
        .withIndex(i);
  }
  uncertain.uncertainties = owned->lengths.data();
  uncertain.owner = std::move(owned);
  return uncertain;
}

std::uint64_t checksumOf(const PointsView& view, const std::vector<RecordField>& fields, const std::string& name)
{
  std::uint64_t sum = 0;
  for (const RecordField& field : fields) {
    if (name.empty() || field.name != name) continue;
    const std::size_t bytes = typeOf(field).bytes;
    if (field.offset + bytes > view.stride) continue; // it is refused where it is read
    const auto* record = static_cast<const unsigned char*>(view.data) + field.offset;
    for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
      std::uint64_t word = 0;
      std::memcpy(&word, record, bytes);
      sum = mixed(sum, word);
    }
  }
  return sum;
}

} // namespace pcl_bsh
