// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/off_header.h>
#include <pcl_bsh/io/clouds/records.h>

#include <optional>
#include <string>

namespace pcl_bsh::io {

namespace {

/// The parts of a keyword.
struct OffKeyword {
  std::string_view name;   ///< all of it: NCOFF
  std::string_view behind; ///< the first count, where no blank stands before it
  std::string_view prefix;
};

std::optional<OffKeyword> offKeyword(std::string_view word)
{
  constexpr std::string_view off = "OFF";
  const std::size_t at = word.find(off);
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t end = at + off.size();
  const OffKeyword keyword{word.substr(0, end), word.substr(end), word.substr(0, at)};
  if (keyword.prefix.find_first_not_of("STCN4n") != std::string_view::npos) return std::nullopt;
  if (keyword.behind.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  return keyword;
}

/// Takes a prefix's letters off it. @return whether they are there
bool takeOff(std::string& prefix, std::string_view letters)
{
  const std::size_t at = prefix.find(letters);
  if (at == std::string::npos) return false;
  prefix.erase(at, letters.size());
  return true;
}

} // namespace

OffHeader::OffHeader(TextCursor& text)
{
  constexpr auto not_off = "is not an OFF file: it does not start with 'OFF'";
  constexpr auto save_as_off = "save it as text OFF with three coordinates to a vertex";
  if (!text.nextLine()) throw FormatError(not_off, save_as_off);
  std::string_view first = TextCursor(text).word();
  if (const auto keyword = offKeyword(first)) {
    text.word();
    const std::string name(keyword->name);
    std::string prefix(keyword->prefix);
    normals_named_first = prefix.find('N') < prefix.find('C');
    texture = takeOff(prefix, "ST");
    colours = takeOff(prefix, "C");
    normals = takeOff(prefix, "N");
    if (!prefix.empty()) {
      const bool other = prefix.find_first_of("4n") != std::string::npos;
      throw FormatError(not_off, "its keyword is " + name +
                                     (other ? ", of vertices that have not three coordinates: " : ", unknown: ") +
                                     save_as_off);
    }
    if (text.line().starts_with("BINARY")) throw FormatError("is a binary OFF file", save_as_off);
    first = keyword->behind;
    if (first.empty()) {
      if (text.line().empty() && !text.nextLine()) throw FormatError("is truncated: it has no counts");
      first = text.word();
    }
  }
  else if (numberOf<std::uint64_t>(first)) { // the keyword may be missing
    text.word();
  }
  else {
    throw FormatError(not_off, save_as_off);
  }
  vertices = text.naming([&] { return parseNumber<std::uint64_t>(first); });
  faces = text.number<std::uint64_t>();
}

void OffHeader::requireRoom(const TextCursor& text) const
{
  constexpr std::uint64_t least_bytes = 6; // three digits and their separators
  requireBytes(vertices, least_bytes, text.rest().size() + 1);
}

bool beginsAsOff(std::string_view file)
{
  return offKeyword(file.substr(0, file.find_first_of(" \t\r\n"))).has_value();
}

} // namespace pcl_bsh::io
