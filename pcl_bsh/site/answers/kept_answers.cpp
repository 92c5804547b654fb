// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/site/answers/kept_answers.h>
#include <pcl_bsh/site/tiles/checksum.h>
#include <pcl_bsh/site/tiles/tile_file.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

namespace pcl_bsh::site {

namespace fs = std::filesystem;
using io::Json;

namespace {

std::uint32_t crcOfNumbers(const std::vector<double>& numbers)
{
  Checksum checksum;
  checksum.add(numbers.data(), numbers.size() * sizeof(double));
  return checksum.value();
}

} // namespace

KeptAnswers::KeptAnswers(const fs::path& folder, const std::string& question)
: folder_(folder),
  question_(crcOf(question))
{
}

const std::vector<double>* KeptAnswers::known(std::size_t tile) const
{
  const auto found = known_.find(tile);
  return found == known_.end() ? nullptr : &found->second;
}

void KeptAnswers::keep(std::size_t tile, const std::vector<double>& numbers)
{
  // CBOR keeps doubles as they are, infinity and NaN too.
  const auto bytes = Json::to_cbor({{"question", question_},
                                    {"crc32", checksums_.at(tile)},
                                    {"crc32_of_numbers", crcOfNumbers(numbers)},
                                    {"numbers", numbers}});
  files::replaceFile(folder_ / answerFileName(tile), [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  });
  has_kept_ = true;
}

std::optional<KeptAnswers::Answer> KeptAnswers::read(std::size_t tile) const
{
  const fs::path file = folder_ / answerFileName(tile);
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::is_empty(file, error)) return std::nullopt;
  const io::FileBytes bytes(file);
  const Json json = Json::from_cbor(bytes.view(), true, false);
  if (json.is_discarded() || !json.is_object()) return std::nullopt;
  try {
    if (json.at("question").get<std::uint32_t>() != question_) {
      throw files::FileError(folder_, "holds what another question has found, or one about other clouds",
                             "repeat that one, begin anew without --resume, or name a new folder");
    }
    Answer answer{json.at("crc32").get<std::uint32_t>(), json.at("numbers").get<std::vector<double>>()};
    if (json.at("crc32_of_numbers").get<std::uint32_t>() != crcOfNumbers(answer.numbers)) return std::nullopt;
    return answer;
  }
  catch (const Json::exception&) {
    return std::nullopt; // not ours: the tile is asked about again
  }
}

std::optional<std::uint32_t> KeptAnswers::checksumKept(std::size_t tile) const
{
  const auto answer = read(tile);
  return answer ? std::optional(answer->crc32) : std::nullopt;
}

void KeptAnswers::share(const std::vector<std::size_t>& mine)
{
  std::vector<double> own;
  for (const std::size_t tile : mine) {
    const auto answer = read(tile);
    if (!answer) continue;
    own.insert(own.end(), {static_cast<double>(tile), static_cast<double>(answer->numbers.size())});
    own.insert(own.end(), answer->numbers.begin(), answer->numbers.end());
  }
  const std::vector<double> all = gatheredFromAllRanks(own);
  for (auto number = all.begin(); number != all.end();) {
    const auto tile = static_cast<std::size_t>(*number++);
    const auto count = static_cast<std::ptrdiff_t>(*number++);
    known_[tile].assign(number, number + count);
    number += count;
  }
}

std::set<std::size_t> KeptAnswers::all() const
{
  std::set<std::size_t> tiles;
  for (const auto& [tile, numbers] : known_) tiles.insert(tile);
  return tiles;
}

} // namespace pcl_bsh::site
