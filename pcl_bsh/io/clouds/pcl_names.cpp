// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>

namespace pcl_bsh::io {

namespace {

using PointField = pcl::PCLPointField;

constexpr std::array<ChannelNames, 3> channel_names = {
    {ply_channels, text_channels, {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}}};
constexpr std::array<std::array<const char*, 2>, 3> normal_names = {
    {{"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}}};
constexpr std::array plain_names = {"x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "curvature"};

bool isReal(const PointField& field)
{
  return field.datatype == PointField::FLOAT32 || field.datatype == PointField::FLOAT64;
}

bool isByte(const PointField& field)
{
  return field.datatype == PointField::UINT8 && field.count == 1;
}

/// The place of the only field of that name; nothing where no field or several have it.
std::optional<std::size_t> placeOf(const Fields& fields, std::string_view name)
{
  const auto is_it = [&](const PointField& field) { return field.name == name; };
  const auto found = std::find_if(fields.begin(), fields.end(), is_it);
  if (found == fields.end() || std::any_of(found + 1, fields.end(), is_it)) return std::nullopt;
  return static_cast<std::size_t>(found - fields.begin());
}

/// Case does not matter, because it does not matter to a reader.
bool has(const Fields& fields, std::string_view name)
{
  return std::any_of(fields.begin(), fields.end(),
                     [&](const PointField& field) { return inSmallLetters(field.name) == name; });
}

/// Gives normals the names of that column of normal_names, if all three are there, alike, and the names are free.
void renameNormals(Fields& fields, std::size_t from, std::size_t to)
{
  std::array<std::size_t, 3> places{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto place = placeOf(fields, normal_names[k][from]);
    if (!place || has(fields, normal_names[k][to])) return;
    places[k] = *place;
  }
  const PointField& first = fields[places[0]];
  for (const std::size_t place : places)
    if (!isReal(first) || fields[place].count != 1 || fields[place].datatype != first.datatype) return;
  for (std::size_t k = 0; k < 3; ++k) fields[places[k]].name = normal_names[k][to];
}

/// Places of three or four channels that can be packed.
std::vector<std::size_t> channelsIn(const Fields& values)
{
  for (const ChannelNames& names : channel_names) {
    std::vector<std::size_t> places;
    for (const char* name : names) {
      const auto place = placeOf(values, name);
      if (!place || !isByte(values[*place])) break;
      places.push_back(*place);
    }
    if (places.size() >= 3 && !has(values, places.size() == 3 ? "rgb" : "rgba")) return places;
  }
  return {};
}

/// Where in a packed colour 0xaarrggbb the byte of red, green, blue or opacity is.
std::uint32_t byteOf(std::size_t channel)
{
  const std::size_t significance = channel == 3 ? 3 : 2 - channel;
  return static_cast<std::uint32_t>(std::endian::native == std::endian::little ? significance : 3 - significance);
}

} // namespace

bool isPackedColour(const PointField& field)
{
  return (field.name == "rgb" || field.name == "rgba") && field.count <= 1 && sizeOf(field.datatype) == 4;
}

std::vector<std::uint32_t> layOutForPcl(const Fields& values, pcl::PCLPointCloud2& cloud)
{
  Fields named = values;
  for (PointField& value : named) value.name = inSmallLetters(value.name);
  const std::vector<std::size_t> channels = channelsIn(named);
  renameNormals(named, 0, 1);
  Fields fields = values;
  for (const char* name : plain_names)
    if (const auto place = placeOf(named, name)) fields[*place].name = name;

  std::vector<std::uint32_t> offsets(values.size());
  std::optional<std::uint32_t> packed;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto channel = std::find(channels.begin(), channels.end(), i);
    if (channel == channels.end()) {
      offsets[i] = cloud.point_step;
      if (fields[i].count > 0) addField(cloud, fields[i].name, fields[i].datatype, fields[i].count);
      continue;
    }
    if (!packed) {
      packed = cloud.point_step;
      const bool opaque = channels.size() == 3;
      addField(cloud, opaque ? "rgb" : "rgba", opaque ? PointField::FLOAT32 : PointField::UINT32);
    }
    offsets[i] = *packed + byteOf(static_cast<std::size_t>(channel - channels.begin()));
  }
  return offsets;
}

Fields namedForFiles(Fields fields, const ChannelNames& channels)
{
  for (PointField& field : fields) field.count = std::max(field.count, 1U);
  renameNormals(fields, 1, 0);
  const auto packed = std::find_if(fields.begin(), fields.end(), isPackedColour);
  if (packed == fields.end()) return fields;
  const std::size_t count = packed->name == "rgb" ? 3 : 4;
  for (std::size_t k = 0; k < 4; ++k)
    if (has(fields, channels[k])) return fields;
  Fields bytes(count, *packed);
  for (std::size_t k = 0; k < count; ++k) {
    bytes[k].name = channels[k];
    bytes[k].datatype = PointField::UINT8;
    bytes[k].offset += byteOf(k);
  }
  const auto next = fields.erase(packed);
  fields.insert(next, bytes.begin(), bytes.end());
  return fields;
}

std::string remarkOnColours(const pcl::PCLPointCloud2& cloud)
{
  if (std::any_of(cloud.fields.begin(), cloud.fields.end(), isPackedColour)) return {}; // beside channels of LAS
  for (const ChannelNames& names : channel_names) {
    const auto is_channel = [&](const PointField& field) {
      return std::find(names.begin(), names.begin() + 3, inSmallLetters(field.name)) != names.begin() + 3;
    };
    const auto channel = std::find_if(cloud.fields.begin(), cloud.fields.end(), is_channel);
    if (std::count_if(cloud.fields.begin(), cloud.fields.end(), is_channel) != 3) continue;
    return "field '" + channel->name +
           "' and the other two channels of its colour are not of type UINT8: they stay three fields, and PCL's tools "
           "do not see a colour";
  }
  return {};
}

} // namespace pcl_bsh::io
