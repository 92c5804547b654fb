// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/point_masks.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace pcl_bsh::io {
namespace {

std::vector<std::uint8_t> parseMask(std::string_view file)
{
  std::vector<std::uint8_t> mask;
  for (TextCursor text(file, '#'); text.nextLine();) {
    const std::string_view value = text.word();
    if (value != "0" && value != "1")
      text.fail("has '" + std::string(value.substr(0, 40)) + "'", "give 1 where a point does not count, else 0");
    text.requireEndOfLine();
    mask.push_back(value == "1" ? 1 : 0);
  }
  return mask;
}

} // namespace

void readMasks(IgnoredPoints& ignored)
{
  for (IgnoredPoints::Term& term : ignored.terms) {
    if (term.kind != IgnoredPoints::Kind::mask) continue;
    const FileBytes file(term.field);
    naming(term.field, [&] { term.mask = std::make_shared<const std::vector<std::uint8_t>>(parseMask(file.view())); });
  }
}

std::vector<std::filesystem::path> maskFilesOf(const IgnoredPoints& ignored)
{
  std::vector<std::filesystem::path> files;
  for (const IgnoredPoints::Term& term : ignored.terms)
    if (term.kind == IgnoredPoints::Kind::mask) files.emplace_back(term.field);
  return files;
}

} // namespace pcl_bsh::io
