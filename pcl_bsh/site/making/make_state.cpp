// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/site/making/make_state.h>
#include <pcl_bsh/site/tiles/checksum.h>

#include <cstring>

namespace pcl_bsh::site {

namespace fs = std::filesystem;
using io::Json;

namespace {

[[noreturn]] void failAsDamagedState(const fs::path& path)
{
  throw files::FileError(path, "what it says of a site that is not complete is damaged",
                         "remove the folder, and make the site again");
}

Json stateOf(const std::optional<Bounds>& bounds)
{
  return bounds ? Json{bounds->low, bounds->high} : Json(nullptr);
}

std::optional<Bounds> boundsIn(const Json& json)
{
  if (json.is_null()) return std::nullopt;
  return Bounds{json.at(0).get<Point3>(), json.at(1).get<Point3>()};
}

} // namespace

std::string stateText(const MakeState& state, const Json& question)
{
  Json json = {{"question", question},           {"bounds", stateOf(state.bounds)},
               {"plan_crc32", state.plan_crc32}, {"source", state.source},
               {"record", state.record},         {"dealt", state.dealt},
               {"overview", state.overview},     {"files", state.files},
               {"open", Json::array()},          {"measured", Json::array()}};
  for (const auto& file : state.open) json["open"].push_back(file ? Json(*file) : Json(nullptr));
  for (const Tile& tile : state.measured)
    json["measured"].push_back({stateOf(tile.bounds), tile.spacing, tile.crc32, tile.greatest});
  return json.dump();
}

MakeState readState(const fs::path& path, const Json& question)
{
  const io::FileBytes file(path);
  MakeState state;
  try {
    const Json json = Json::parse(file.view());
    if (json.at("question") != question) {
      throw files::FileError(path.parent_path(), "holds a site that is not complete, of other clouds or options",
                             "repeat its command to go on, or remove the folder");
    }
    state.bounds = boundsIn(json.at("bounds"));
    json.at("plan_crc32").get_to(state.plan_crc32);
    json.at("source").get_to(state.source);
    json.at("record").get_to(state.record);
    json.at("dealt").get_to(state.dealt);
    json.at("overview").get_to(state.overview);
    json.at("files").get_to(state.files);
    for (const Json& number : json.at("open")) {
      state.open.push_back(number.is_null() ? std::nullopt : std::optional(number.get<std::size_t>()));
      if (state.open.back() && *state.open.back() >= state.files.size()) failAsDamagedState(path);
    }
    for (const Json& entry : json.at("measured")) {
      Tile tile;
      tile.bounds = boundsIn(entry.at(0));
      entry.at(1).get_to(tile.spacing);
      entry.at(2).get_to(tile.crc32);
      entry.at(3).get_to(tile.greatest);
      state.measured.push_back(tile);
    }
  }
  catch (const Json::exception&) {
    failAsDamagedState(path);
  }
  if (state.measured.size() > state.files.size()) failAsDamagedState(path);
  return state;
}

std::string planBytes(const std::vector<std::uint32_t>& numbers)
{
  std::string bytes(numbers.size() * sizeof numbers[0], '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::vector<std::uint32_t> readPlan(const fs::path& path, std::uint32_t crc32)
{
  const io::FileBytes file(path);
  const std::string bytes(file.view());
  std::vector<std::uint32_t> numbers(bytes.size() / sizeof(std::uint32_t));
  if (crcOf(bytes) != crc32 || bytes.size() % sizeof numbers[0] != 0) failAsDamagedState(path);
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

} // namespace pcl_bsh::site
