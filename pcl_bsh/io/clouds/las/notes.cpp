// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

namespace {

constexpr std::uint16_t keys_id = 34735, texts_id = 34737;
constexpr std::uint16_t is_wkt = 16; ///< of the global encoding

/// The content of the record of the coordinate system with that number; empty where the file has no such record.
std::string projectionRecord(const LasHeader& header, std::uint16_t id)
{
  for (const LasRecord& record : lasRecordsOf(header.before_points, header.block).records)
    if (record.user() == las_projection && record.id() == id) return std::string(record.content());
  const std::string_view behind = header.behind_points;
  const std::uint64_t end = header.block.endOfPoints();
  if (header.block.extended_records == 0 || header.block.extended_at < end) return {};
  std::uint64_t at = header.block.extended_at - end;
  for (std::uint32_t i = 0; i < header.block.extended_records; ++i) {
    if (at > behind.size() || behind.size() - at < las_extended_head) return {};
    const std::string_view record = behind.substr(static_cast<std::size_t>(at));
    const auto bytes = lasNumber<std::uint64_t>(record, 20);
    if (bytes > record.size() - las_extended_head) return {};
    const std::string_view user(record.data() + 2, strnlen(record.data() + 2, 16));
    if (user == las_projection && lasNumber<std::uint16_t>(record, 18) == id)
      return std::string(record.substr(las_extended_head, static_cast<std::size_t>(bytes)));
    at += las_extended_head + bytes;
  }
  return {};
}

/// As it may stand in a report: a line of ASCII, not too long.
std::string plain(std::string_view text)
{
  constexpr std::size_t most = 200;
  std::string line(text.substr(0, most));
  for (char& c : line) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    if (c < ' ' || c > '~') c = '?';
  }
  const std::size_t from = std::min(line.find_first_not_of(' '), line.size());
  return line.substr(from, line.find_last_not_of(' ') + 1 - from);
}

/// GeoTIFF 1.0: a directory of keys, four numbers each, some of whose values are parts of a text.
class GeoKeys {
public:
  explicit GeoKeys(const LasHeader& header)
  : keys_(projectionRecord(header, keys_id)),
    texts_(projectionRecord(header, texts_id))
  {
  }

  /// The first of these citations.
  std::string citation(std::initializer_list<std::uint16_t> keys) const
  {
    for (const std::uint16_t key : keys) {
      const auto entry = find(key, texts_id);
      if (!entry || entry->value > texts_.size()) continue;
      std::string_view text = std::string_view(texts_).substr(entry->value, entry->count);
      text = text.substr(0, std::min(text.find('|'), text.find('\0')));
      if (std::string name = plain(text); !name.empty()) return name;
    }
    return {};
  }

  /// The code, if it is one of EPSG's.
  std::optional<unsigned> code(std::uint16_t key) const
  {
    constexpr std::uint16_t user_defined = 32767;
    const auto entry = find(key, 0);
    return entry && entry->value > 0 && entry->value < user_defined ? std::optional<unsigned>(entry->value)
                                                                    : std::nullopt;
  }

private:
  struct Entry {
    std::uint16_t key, record, count, value;
  };

  std::optional<Entry> find(std::uint16_t key, std::uint16_t record) const
  {
    constexpr std::size_t bytes = 8;
    for (std::size_t at = bytes; at + bytes <= keys_.size(); at += bytes) { // the first tells their number
      const auto number = [&](std::size_t i) { return lasNumber<std::uint16_t>(keys_, at + 2 * i); };
      if (number(0) == key && number(1) == record) return Entry{number(0), number(1), number(2), number(3)};
    }
    return std::nullopt;
  }

  std::string keys_, texts_;
};

std::string withCode(const std::string& name, std::optional<unsigned> code)
{
  if (!code) return name;
  const std::string epsg = "EPSG:" + std::to_string(*code);
  return name.empty() ? epsg : name + " (" + epsg + ")";
}

namespace geo_key {
constexpr std::uint16_t model = 1024, citation = 1026, geographic = 2048, geographic_citation = 2049, projected = 3072,
                        projected_citation = 3073, places = 3076, vertical = 4096, vertical_citation = 4097,
                        heights = 4099;
}
constexpr unsigned metres_code = 9001;

/// EPSG's code of the system of places.
std::optional<unsigned> systemCode(const GeoKeys& keys)
{
  constexpr unsigned projected_model = 1;
  const bool flat = keys.code(geo_key::projected) || keys.code(geo_key::model) == projected_model;
  return keys.code(flat ? geo_key::projected : geo_key::geographic);
}

std::string nameOfKeys(const GeoKeys& keys)
{
  const std::string name = withCode(
      keys.citation({geo_key::projected_citation, geo_key::citation, geo_key::geographic_citation}), systemCode(keys));
  const std::string height = withCode(keys.citation({geo_key::vertical_citation}), keys.code(geo_key::vertical));
  return name.empty() || height.empty() ? name + height : name + " + " + height;
}

/// EPSG's code of a system of heights. GeoTIFF 1.0 has codes of datums for some of these systems.
unsigned heightSystem(unsigned code)
{
  constexpr unsigned first_datum = 5101, last_datum = 5106, yellow_sea_datum = 5104, yellow_sea = 5736, apart = 600;
  if (code == yellow_sea_datum) return yellow_sea;
  return code >= first_datum && code <= last_datum ? code + apart : code;
}

std::string definitionOfKeys(const GeoKeys& keys)
{
  const auto code = systemCode(keys), heights = keys.code(geo_key::vertical);
  if (!code) return {};
  const std::string places = "EPSG:" + std::to_string(*code);
  const bool in_metres = keys.code(geo_key::heights).value_or(metres_code) == metres_code;
  return heights && in_metres ? places + '+' + std::to_string(heightSystem(*heights)) : places;
}

std::optional<LengthUnit> unitOfKeys(const GeoKeys& keys)
{
  const auto unitOfCode = [&](std::uint16_t key) -> std::optional<LengthUnit> {
    switch (keys.code(key).value_or(0)) { // of EPSG's units
    case 1025:
      return LengthUnit::mm;
    case 1033:
      return LengthUnit::cm;
    case metres_code:
      return LengthUnit::m;
    case 9002:
      return LengthUnit::ft;
    case 9003:
      return LengthUnit::us_ft;
    default:
      return std::nullopt;
    }
  };
  const auto unit = unitOfCode(geo_key::places);
  return !keys.code(geo_key::heights) || unitOfCode(geo_key::heights) == unit ? unit : std::nullopt;
}

bool isAny(std::string_view word, std::initializer_list<std::string_view> words)
{
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The number behind the first comma, as in "metre",1
double factorOf(std::string_view text)
{
  text.remove_prefix(std::min(text.find(',') + 1, text.size()));
  text.remove_prefix(std::min(text.find_first_not_of(" \n\r\t"), text.size()));
  double factor = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), factor);
  return factor;
}

/// Whether a unit is that of places or of heights: it stands in the system itself, or in one of its axes.
bool isOf(std::initializer_list<std::string_view> systems, const std::vector<std::string>& around)
{
  const std::size_t depth = around.size();
  if (depth > 0 && isAny(around[depth - 1], systems)) return true;
  return depth > 1 && around[depth - 1] == "axis" && isAny(around[depth - 2], systems);
}

/// The WKT of the coordinate system; empty where the record of GeoTIFF's keys counts instead.
std::string wktOf(const LasHeader& header)
{
  std::string wkt = projectionRecord(header, las_wkt_id);
  const bool wkt_first = (header.block.global_encoding & is_wkt) != 0 || nameOfKeys(GeoKeys(header)).empty();
  return wkt_first && !wkt.empty() && !nameOfWkt(wkt).empty() ? wkt : std::string();
}

} // namespace

/// The first name in quotes.
std::string nameOfWkt(std::string_view text)
{
  const std::size_t from = std::min(text.find('"'), text.size() - 1) + 1;
  const std::size_t to = text.find('"', from);
  return to == std::string_view::npos ? std::string() : plain(text.substr(from, to - from));
}

std::optional<LengthUnit> unitOfWkt(std::string_view text)
{
  std::vector<std::string> around; // keywords of the brackets that are open
  std::string word;
  double places = 0.0, heights = 0.0; // in metres; 0: not known
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '(') {
      word = inSmallLetters(word);
      if (isAny(word, {"unit", "lengthunit"})) {
        if (isOf({"projcs", "projcrs", "projectedcrs"}, around)) places = factorOf(text.substr(at + 1));
        if (isOf({"vert_cs", "vertcs", "vertcrs", "verticalcrs"}, around)) heights = factorOf(text.substr(at + 1));
      }
      around.push_back(std::move(word));
      word.clear();
    }
    else if (c == ']' || c == ')') {
      if (!around.empty()) around.pop_back();
      word.clear();
    }
    else if (c == ',' || c == '"') {
      word.clear();
    }
    else if (std::string_view(" \n\r\t").find(c) == std::string_view::npos) {
      word += c;
    }
  }
  const auto unit = lengthUnitOfMetres(places);
  return heights == 0.0 || lengthUnitOfMetres(heights) == unit ? unit : std::nullopt;
}

std::string coordinateSystemOf(const LasHeader& header)
{
  const std::string wkt = wktOf(header);
  return wkt.empty() ? nameOfKeys(GeoKeys(header)) : nameOfWkt(wkt);
}

CoordinateSystem systemOf(const LasHeader& header)
{
  const std::string wkt = wktOf(header);
  return {coordinateSystemOf(header), wkt.empty() ? definitionOfKeys(GeoKeys(header)) : wkt.substr(0, wkt.find('\0'))};
}

std::optional<LengthUnit> unitOf(const LasHeader& header)
{
  const std::string wkt = wktOf(header);
  return wkt.empty() ? unitOfKeys(GeoKeys(header)) : unitOfWkt(wkt);
}

std::vector<std::string> remarksOn(const LasBlock& block, std::uint64_t file_bytes)
{
  if (block.compressed) return {}; // whose points end where its chunks do
  const std::uint64_t points_end = block.endOfPoints();
  std::uint64_t end = file_bytes; // of what can be records
  if (block.extended_records > 0) end = std::min(end, block.extended_at);
  if (block.waveforms_at >= points_end) end = std::min(end, block.waveforms_at);
  const HeaderCount told{block.points, "record", "records"};
  constexpr std::string_view any = "any"; // zeros are records, too
  const auto more = remarkOnMoreBytes(told, end - points_end, any, block.record_length);
  return more ? std::vector<std::string>{*more} : std::vector<std::string>();
}

} // namespace pcl_bsh::io
