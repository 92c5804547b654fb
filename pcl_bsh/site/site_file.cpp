// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/json/json_schema.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/site/making/unfinished_site.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/site/tiles/records.h>

#include <site.schema.json.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pcl_bsh::site {

namespace fs = std::filesystem;
using io::Json;
using io::JsonReader;

namespace {

using Type = pcl::PCLPointField;

constexpr std::array<std::pair<const char*, std::uint8_t>, 11> type_names = {{{"bool", Type::BOOL},
                                                                              {"int8", Type::INT8},
                                                                              {"uint8", Type::UINT8},
                                                                              {"int16", Type::INT16},
                                                                              {"uint16", Type::UINT16},
                                                                              {"int32", Type::INT32},
                                                                              {"uint32", Type::UINT32},
                                                                              {"int64", Type::INT64},
                                                                              {"uint64", Type::UINT64},
                                                                              {"float32", Type::FLOAT32},
                                                                              {"float64", Type::FLOAT64}}};

Json toJson(const std::vector<pcl::PCLPointField>& fields)
{
  Json list = Json::array();
  for (const pcl::PCLPointField& field : fields) {
    Json json = {{"name", field.name}};
    for (const auto& [name, type] : type_names)
      if (type == field.datatype) json["type"] = name;
    if (field.count != 1) json["count"] = field.count;
    list.push_back(std::move(json));
  }
  return list;
}

Json toJson(const Bounds& bounds)
{
  return {{"low", bounds.low}, {"high", bounds.high}};
}

std::vector<pcl::PCLPointField> readFields(const JsonReader& list)
{
  pcl::PCLPointCloud2 layout;
  for (const JsonReader& field : list.elements()) {
    std::uint64_t count = 1;
    io::readCount(field, "count", count);
    const std::string type_name = field.at("type").text();
    for (const auto& [name, type] : type_names)
      if (type_name == name) io::addField(layout, field.at("name").text(), type, count);
  }
  return layout.fields;
}

std::optional<Bounds> readBounds(const JsonReader& object)
{
  if (!object.has("bounds")) return std::nullopt;
  const JsonReader json = object.at("bounds");
  const std::vector<double> low = json.at("low").numbers(3), high = json.at("high").numbers(3);
  for (std::size_t k = 0; k < 3; ++k)
    if (low[k] > high[k]) json.fail("the low corner lies above the high one", "make the site again");
  return Bounds{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

/// A site.json that someone else has written must not make us read elsewhere.
void requireInside(const fs::path& folder, const JsonReader& file)
{
  const fs::path path = file.text();
  bool leaves = path.is_absolute();
  for (const fs::path& step : path) leaves = leaves || step == "..";
  std::error_code error;
  const fs::path target = fs::weakly_canonical(folder / path, error), home = fs::weakly_canonical(folder, error);
  if (error) throw files::FileError(folder / path, "cannot be read (" + error.message() + ")", "ask for the right to");
  const auto [home_end, unused] = std::mismatch(home.begin(), home.end(), target.begin(), target.end());
  if (leaves || home_end != home.end())
    file.fail("'" + path.string() + "' leaves the folder of the site", "move the tile into the folder");
}

Tile readTileEntry(const fs::path& folder, const JsonReader& json)
{
  Tile tile;
  requireInside(folder, json.at("file"));
  tile.file = json.at("file").text();
  io::readCount(json, "points", tile.points);
  tile.bounds = readBounds(json);
  io::read(json, "spacing", tile.spacing);
  if (json.has("greatest"))
    for (const auto& [field, value] : json.at("greatest").json().items()) tile.greatest[field] = value.get<double>();
  io::readCount(json, "crc32", tile.crc32);
  std::error_code error;
  if (!fs::is_regular_file(folder / tile.file, error))
    throw files::FileError(folder / tile.file, "a tile of the site is missing", "copy it back, or make the site again");
  return tile;
}

Source readSourceEntry(const JsonReader& json)
{
  Source source;
  source.file = json.at("file").text();
  io::readCount(json, "points", source.points);
  source.fields = readFields(json.at("fields"));
  io::read(json, "coordinate_system", source.coordinate_system);
  return source;
}

void requireVersion(const JsonReader& json)
{
  if (!json.has("version") || !json.json()["version"].is_number_integer()) return;
  const auto version = json.json()["version"].get<std::int64_t>();
  if (version < 1 || version > site_version) {
    json.at("version").fail("this program reads versions 1 to " + std::to_string(site_version),
                            "make the site again, or take the program that made it");
  }
}

void requireSum(const JsonReader& list, std::uint64_t sum, std::uint64_t points)
{
  if (sum != points) {
    list.fail("they have " + counted(sum, "point") + " together, the site has " + std::to_string(points),
              "make the site again");
  }
}

void requireFolder(const fs::path& folder)
{
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw files::FileError(folder, "is no folder", "name the folder of a site");
  if (fs::exists(folder / site_file_name, error)) return;
  if (error) throw files::FileError(folder, "cannot be read (" + error.message() + ")", "ask for the right to");
  if (isUnfinished(folder))
    throw files::FileError(folder, "is a site that is not complete", "make it again with pcl_bsh_site make");
  throw files::FileError(folder, "is no site: it has no site.json", "make one with pcl_bsh_site make");
}

} // namespace

Site readSite(const fs::path& folder)
{
  requireFolder(folder);
  const fs::path path = folder / site_file_name;
  const io::FileBytes file(path);
  const std::string name = path.string();
  const Json document = io::parseJson(file.view(), name);
  const JsonReader json(document, name);
  requireVersion(json);
  static const io::JsonSchema schema(io::site_schema_json);
  schema.check(json);

  Site site;
  site.folder = folder;
  io::readCount(json, "points", site.points);
  site.bounds = readBounds(json);
  site.fields = readFields(json.at("fields"));
  requireSiteFields(json.at("fields"), site.fields);
  std::uint64_t of_sources = 0, of_tiles = 0;
  for (const JsonReader& source : json.at("sources").elements()) {
    site.sources.push_back(readSourceEntry(source));
    of_sources += site.sources.back().points;
  }
  for (const JsonReader& tile : json.at("tiles").elements()) {
    site.tiles.push_back(readTileEntry(folder, tile));
    of_tiles += site.tiles.back().points;
  }
  requireSum(json.at("sources"), of_sources, site.points);
  requireSum(json.at("tiles"), of_tiles, site.points);
  return site;
}

std::string coordinateSystemOf(const Site& site)
{
  std::vector<std::string> names;
  for (const Source& source : site.sources) {
    const std::string& name = source.coordinate_system;
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : "; ") + name;
  return text;
}

std::string siteText(const Site& site)
{
  Json json = {{"version", site_version}, {"points", site.points}};
  if (site.bounds) json["bounds"] = toJson(*site.bounds);
  json["fields"] = toJson(site.fields);
  json["sources"] = Json::array();
  for (const Source& source : site.sources) {
    json["sources"].push_back({{"file", source.file}, {"points", source.points}, {"fields", toJson(source.fields)}});
    if (!source.coordinate_system.empty()) json["sources"].back()["coordinate_system"] = source.coordinate_system;
  }
  json["tiles"] = Json::array();
  for (const Tile& tile : site.tiles) {
    Json entry = {{"file", tile.file}, {"points", tile.points}};
    if (tile.bounds) entry["bounds"] = toJson(*tile.bounds);
    if (!tile.greatest.empty()) entry["greatest"] = tile.greatest;
    entry["spacing"] = tile.spacing;
    entry["crc32"] = tile.crc32;
    json["tiles"].push_back(std::move(entry));
  }
  return io::printed(json);
}

} // namespace pcl_bsh::site
