// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/record_numbers.h>

#include <pcl_bsh/base/counted.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>

namespace pcl_bsh {
namespace {

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

} // namespace

std::size_t bytesOf(const RecordField& field)
{
  return typeOf(field).bytes;
}

RecordNumbers::RecordNumbers(const PointsView& view, const std::vector<RecordField>& fields, const std::string& name,
                             const std::string& cloud, const Purpose& purpose)
: first_(static_cast<const unsigned char*>(view.data)),
  stride_(view.stride)
{
  const auto field = std::find_if(fields.begin(), fields.end(), [&](const RecordField& f) { return f.name == name; });
  if (field == fields.end()) {
    std::string names;
    for (const RecordField& other : fields) names += (names.empty() ? "" : ", ") + other.name;
    throw InvalidInput(purpose.code, cloud, "field '" + name + "' " + purpose.of + " is missing",
                       purpose.remedy + (": " + names));
  }
  if (field->count > 1)
    throw InvalidInput(purpose.code, cloud,
                       "field '" + name + "' holds " + counted(field->count, "value") + " per point",
                       "give one that holds one");
  const FieldType type = typeOf(*field);
  if (view.count > 0 && field->offset + type.bytes > view.stride)
    throw InvalidInput(purpose.code, cloud, "field '" + name + "' reaches beyond its record",
                       "mend the cloud's fields");
  value_ = type.value;
  if (view.count > 0) first_ += field->offset;
}

} // namespace pcl_bsh
