// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/stl.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <boost/container_hash/hash.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <unordered_map>

namespace pcl_bsh::io {

namespace {

using Place = std::array<float, 3>;

constexpr std::size_t header_bytes = 80, count_bytes = 4, triangle_bytes = 50;

static_assert(std::endian::native == std::endian::little, "STL's numbers are read as they lie in the file");

pcl::PCLPointCloud2 withFields()
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, pcl::PCLPointField::FLOAT32);
  return cloud;
}

/// Names places by number, in the order in which they first come.
class NumberedPlaces {
public:
  std::uint32_t numberOf(const Place& place)
  {
    std::array<std::uint32_t, 3> key;
    for (std::size_t k = 0; k < 3; ++k) key[k] = std::bit_cast<std::uint32_t>(place[k] + 0.0F); // -0 is 0
    const auto [entry, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(places_.size()));
    if (is_new) places_.push_back(place);
    return entry->second;
  }

  pcl::PCLPointCloud2 cloud() const
  {
    requirePoints(places_.size());
    pcl::PCLPointCloud2 cloud = withFields();
    allocate(cloud, static_cast<std::uint32_t>(places_.size()));
    if (!places_.empty()) std::memcpy(cloud.data.data(), places_.data(), places_.size() * sizeof(Place));
    return cloud;
  }

private:
  std::vector<Place> places_;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, boost::hash<std::array<std::uint32_t, 3>>> numbers_;
};

/// How many triangles a binary header counts; nothing where the file is too short for one.
std::optional<std::uint64_t> countOf(std::string_view file)
{
  if (file.size() < header_bytes + count_bytes) return std::nullopt;
  std::uint32_t count;
  std::memcpy(&count, file.data() + header_bytes, sizeof count);
  return count;
}

/// The next word; some programs write capitals, and "end loop" for "endloop".
std::string keyword(TextCursor& text)
{
  const auto next = [&] { return inSmallLetters(std::string(text.word().substr(0, 40))); };
  std::string word = next();
  return word == "end" ? word + next() : word;
}

/// The text without the bytes that some programs write at its end: zeros, and the mark that ends files of DOS.
std::string_view withoutEndMarks(std::string_view text)
{
  constexpr std::string_view marks("\0\x1a", 2);
  return text.substr(0, text.find_last_not_of(marks) + 1);
}

bool isText(std::string_view file)
{
  const auto count = countOf(file);
  if (count && header_bytes + count_bytes + *count * triangle_bytes == file.size()) return false;
  TextCursor text(file.substr(0, 1024));
  return text.nextLine() && keyword(text) == "solid" && withoutEndMarks(file).find('\0') == std::string_view::npos;
}

void readBinary(std::string_view file, NumberedPlaces& places, std::vector<Triangle>& triangles)
{
  const auto count = countOf(file);
  if (!count) throw FormatError("is not an STL file: it is shorter than a header, and does not start with 'solid'");
  const std::size_t left = file.size() - header_bytes - count_bytes;
  const HeaderCount told{*count, "triangle", "triangles"};
  if (left / triangle_bytes < *count) throw otherCount(told, left / triangle_bytes);
  requireNoMoreBytes(told, left - *count * triangle_bytes, triangle_bytes);
  triangles.reserve(*count);
  for (std::size_t t = 0; t < *count; ++t) {
    std::array<Place, 4> values; // a normal and three corners
    std::memcpy(&values, file.data() + header_bytes + count_bytes + t * triangle_bytes, sizeof values);
    triangles.push_back({places.numberOf(values[1]), places.numberOf(values[2]), places.numberOf(values[3])});
  }
}

void expect(TextCursor& text, std::string_view word)
{
  if (keyword(text) != word) text.fail("has no '" + std::string(word) + "' where a facet needs one");
}

void readText(std::string_view file, NumberedPlaces& places, std::vector<Triangle>& triangles,
              std::vector<StlSolid>& solids)
{
  bool in_solid = false;
  for (TextCursor text(file); text.nextLine();) {
    const std::string key = keyword(text);
    if (key == "solid") {
      in_solid = true;
      solids.push_back({std::string(text.line())});
    }
    else if (key == "endsolid") {
      in_solid = false;
    }
    else if (key == "facet" && in_solid) {
      const auto next = [&] {
        if (!text.nextLine()) throw FormatError("is truncated: it ends in a facet");
      };
      next(), expect(text, "outer"), expect(text, "loop");
      Triangle triangle;
      for (std::uint32_t& corner : triangle) {
        next(), expect(text, "vertex");
        Place place;
        for (float& value : place) value = text.number<float>();
        text.requireEndOfLine();
        corner = places.numberOf(place);
      }
      next(), expect(text, "endloop");
      next(), expect(text, "endfacet");
      triangles.push_back(triangle);
      ++solids.back().triangles;
    }
    else {
      text.fail("starts with '" + key + "', which no STL file has there");
    }
  }
  if (in_solid) throw FormatError("is truncated: it ends before 'endsolid'");
}

} // namespace

pcl::PCLPointCloud2 parseStl(std::string_view file, std::vector<Triangle>* triangles)
{
  NumberedPlaces places;
  std::vector<Triangle> found;
  std::vector<StlSolid> solids;
  if (isText(file))
    readText(withoutEndMarks(file), places, found, solids);
  else
    readBinary(file, places, found);
  if (triangles != nullptr) triangles->insert(triangles->end(), found.begin(), found.end());
  return places.cloud();
}

std::vector<StlSolid> parseStlSolids(std::string_view file)
{
  if (!isText(file)) throw FormatError("is a binary STL, whose parts have no names", "save it as text");
  NumberedPlaces places;
  std::vector<Triangle> triangles;
  std::vector<StlSolid> solids;
  readText(withoutEndMarks(file), places, triangles, solids);
  return solids;
}

pcl::PCLPointCloud2 parseStlHeader(std::string_view file)
{
  if (!countOf(file) && !isText(file)) throw FormatError("is not an STL file: it is shorter than a header");
  return withFields();
}

} // namespace pcl_bsh::io
