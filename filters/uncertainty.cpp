// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/uncertainty.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/geometry/rounding.h>

#include <pcl/common/io.h>
#include <pcl/type_traits.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace pcl_bsh {
namespace {

using Field = pcl::PCLPointField;

InvalidInput refusal(const std::string& cloud, const std::string& wrong, const std::string& remedy)
{
  return InvalidInput(Input::uncertainty, cloud, wrong, remedy);
}

const Field& fieldNamed(const std::string& name, const std::vector<Field>& fields, const std::string& cloud)
{
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.name == name; });
  if (found == fields.end()) {
    std::string names;
    for (const Field& field : fields) names += (names.empty() ? "" : ", ") + field.name;
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

double valueOf(const unsigned char* record, std::uint8_t datatype)
{
  switch (datatype) {
  case Field::INT8:
    return valueAt<std::int8_t>(record);
  case Field::UINT8:
    return valueAt<std::uint8_t>(record);
  case Field::INT16:
    return valueAt<std::int16_t>(record);
  case Field::UINT16:
    return valueAt<std::uint16_t>(record);
  case Field::INT32:
    return valueAt<std::int32_t>(record);
  case Field::UINT32:
    return valueAt<std::uint32_t>(record);
  case Field::FLOAT32:
    return valueAt<float>(record);
  case Field::FLOAT64:
    return valueAt<double>(record);
  default:
    return std::numeric_limits<double>::quiet_NaN();
  }
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

PointsView withUncertainty(const PointsView& view, const std::vector<Field>& fields, const std::string& cloud,
                           const Uncertainty& uncertainty)
{
  checkUncertainty(cloud, uncertainty);
  PointsView uncertain = view;
  if (uncertainty.field.empty()) {
    uncertain.uncertainty = uncertainty.length;
    return uncertain;
  }
  const Field& field = fieldNamed(uncertainty.field, fields, cloud);
  auto owned = std::make_shared<Owned>();
  owned->points = view.owner;
  owned->lengths.resize(view.count);
  const auto bytes = static_cast<std::size_t>(pcl::getFieldSize(field.datatype));
  if (view.count > 0 && field.offset + bytes > view.stride)
    throw refusal(cloud, "field '" + field.name + "' reaches beyond its record", "mend the cloud's fields");
  const auto* record = static_cast<const unsigned char*>(view.data) + field.offset;
  for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
    if (!isFinite(view.point(static_cast<std::uint32_t>(i)))) continue; // it takes part in nothing
    const double sigma = valueOf(record, field.datatype);
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

} // namespace pcl_bsh
