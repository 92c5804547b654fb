// SPDX-License-Identifier: BSD-3-Clause
// Extra bytes of LAS points (section 2.6.5 of the specification): fields that a record describes.
#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/records.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pcl_bsh::io {

namespace {

using Type = pcl::PCLPointField;

/// data_type 1 to 10; 11 to 20 are two of these, 21 to 30 three (tables 25 and 26).
constexpr std::array<std::uint8_t, 10> types = {Type::UINT8, Type::INT8,   Type::UINT16, Type::INT16,   Type::UINT32,
                                                Type::INT32, Type::UINT64, Type::INT64,  Type::FLOAT32, Type::FLOAT64};

enum Option : std::uint8_t { has_no_data = 1, has_scale = 8, has_offset = 16 };

constexpr std::size_t type_at = 2, options_at = 3, name_at = 4, no_data_at = 40, scale_at = 112, offset_at = 136,
                      description_at = 160, text_bytes = 32;

/// Bytes per point.
std::size_t sizeOfExtra(std::string_view descriptor)
{
  const auto type = lasNumber<std::uint8_t>(descriptor, type_at);
  if (type == 0) return lasNumber<std::uint8_t>(descriptor, options_at);
  return sizeOf(types[(type - 1U) % types.size()]) * ((type - 1U) / types.size() + 1);
}

std::string nameOf(std::string_view descriptor)
{
  std::string name(descriptor.substr(name_at, text_bytes));
  name.resize(std::min(name.find('\0'), name.size()));
  for (char& c : name)
    if (c <= ' ' || c > '~') c = '_';
  return name.empty() ? "extra_bytes" : name;
}

/// Names that are free, however many ask for the same one.
class FreeNames {
public:
  explicit FreeNames(const std::vector<LasField>& fields)
  {
    for (const LasField& field : fields) taken_.emplace(field.name, 1);
    taken_.emplace("_", 1); // PCL's name of padding
  }

  std::string operator()(const std::string& name)
  {
    if (taken_.emplace(name, 1).second) return name;
    const std::string extra = "extra_" + name;
    unsigned& number = taken_[extra];
    for (;;) {
      ++number;
      std::string numbered = number == 1 ? extra : extra + '_' + std::to_string(number);
      if (number == 1 || taken_.emplace(numbered, 1).second) return numbered;
    }
  }

private:
  std::map<std::string, unsigned> taken_; ///< and how often it was asked for
};

LasField describedField(std::string_view descriptor, std::size_t at)
{
  LasField field;
  field.at = at;
  field.descriptor = descriptor;
  field.name = nameOf(descriptor);
  const auto type = lasNumber<std::uint8_t>(descriptor, type_at);
  const auto options = lasNumber<std::uint8_t>(descriptor, options_at);
  if (type == 0) {
    field.datatype = field.stored = Type::UINT8;
    field.count = options;
    return field;
  }
  field.stored = types[(type - 1U) % types.size()];
  field.count = static_cast<std::uint32_t>((type - 1U) / types.size() + 1);
  const bool long_integer = field.stored == Type::UINT64 || field.stored == Type::INT64;
  const bool scaled =
      (options & (has_scale | has_offset)) != 0 || ((options & has_no_data) != 0 && !long_integer); // double is shorter
  field.kind = scaled ? LasField::Kind::scaled : LasField::Kind::plain;
  field.datatype = scaled ? std::uint8_t{Type::FLOAT64} : field.stored;
  for (std::size_t k = 0; scaled && k < field.count; ++k) {
    LasScaling& scaling = field.scaling[k];
    if ((options & has_scale) != 0) scaling.scale = lasNumber<double>(descriptor, scale_at + 8 * k);
    if ((options & has_offset) != 0) scaling.offset = lasNumber<double>(descriptor, offset_at + 8 * k);
    if ((options & has_no_data) != 0) scaling.no_data = lasNumber<std::uint64_t>(descriptor, no_data_at + 8 * k);
    if (!std::isfinite(scaling.scale) || scaling.scale == 0 || !std::isfinite(scaling.offset)) {
      throw FormatError("its extra bytes '" + field.name + "' are scaled by " + std::to_string(scaling.scale) +
                        " and moved by " + std::to_string(scaling.offset));
    }
  }
  return field;
}

} // namespace

void addExtraBytes(std::vector<LasField>& fields, std::string_view descriptors, std::size_t first_byte,
                   std::size_t record_length)
{
  std::vector<std::string_view> known; // behind a type that is not known, no place is known
  std::size_t described = 0;
  for (; descriptors.size() >= las_descriptor_bytes; descriptors.remove_prefix(las_descriptor_bytes)) {
    if (lasNumber<std::uint8_t>(descriptors, type_at) > 3 * types.size()) break;
    known.push_back(descriptors.substr(0, las_descriptor_bytes));
    described += sizeOfExtra(known.back());
  }
  if (described > record_length - first_byte) known.clear();
  FreeNames free_name(fields);
  std::size_t at = first_byte;
  for (const std::string_view descriptor : known) {
    if (sizeOfExtra(descriptor) == 0) continue;
    LasField field = describedField(descriptor, at);
    field.name = free_name(field.name);
    at += sizeOfExtra(descriptor);
    fields.push_back(std::move(field));
  }
  if (at == record_length) return;
  LasField rest;
  rest.name = free_name("extra_bytes");
  rest.datatype = rest.stored = Type::UINT8;
  rest.count = static_cast<std::uint32_t>(record_length - at);
  rest.at = at;
  fields.push_back(std::move(rest));
}

std::string newDescriptor(const std::string& name, std::uint8_t datatype, const std::string& description)
{
  const auto type = std::find(types.begin(), types.end(), datatype);
  std::string descriptor(las_descriptor_bytes, '\0');
  descriptor[type_at] = static_cast<char>(type - types.begin() + 1);
  descriptor.replace(name_at, name.size(), name);
  descriptor.replace(description_at, description.size(), description);
  return descriptor;
}

} // namespace pcl_bsh::io
