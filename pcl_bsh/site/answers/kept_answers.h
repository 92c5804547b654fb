// SPDX-License-Identifier: BSD-3-Clause
// A question's answers about tiles, in a file beside each tile of a site of results that is not complete.
#pragma once

#include <pcl_bsh/site/ask_site.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh::site {

class KeptAnswers : public TileAnswers {
public:
  /// @param question whose answers they are
  KeptAnswers(const std::filesystem::path& folder, const std::string& question);

  const std::vector<double>* known(std::size_t tile) const override;
  void keep(std::size_t tile, const std::vector<double>& numbers) override;

  /// To be called before keep(): the checksum of the tile's file, which is complete.
  void setChecksum(std::size_t tile, std::uint32_t crc32) { checksums_[tile] = crc32; }

  /// Returns the checksum that an earlier run has kept with an answer; nothing where no answer can be read.
  /// @throws files::FileError for an answer to another question
  std::optional<std::uint32_t> checksumKept(std::size_t tile) const;

  /// Sends the answers about these tiles, which this rank has read, to all ranks.
  void share(const std::vector<std::size_t>& mine);

  std::set<std::size_t> all() const;

  /// Whether any was kept, by an earlier run or by this one.
  bool any() const noexcept { return has_kept_ || !known_.empty(); }

private:
  struct Answer {
    std::uint32_t crc32 = 0;
    std::vector<double> numbers;
  };
  std::optional<Answer> read(std::size_t tile) const;

  std::filesystem::path folder_;
  std::uint32_t question_ = 0; ///< its checksum
  bool has_kept_ = false;
  std::map<std::size_t, std::uint32_t> checksums_;
  std::map<std::size_t, std::vector<double>> known_;
};

} // namespace pcl_bsh::site
