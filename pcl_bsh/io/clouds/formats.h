// SPDX-License-Identifier: BSD-3-Clause
// The formats of clouds, once: from this table come what is read and written, the lists in errors and in --help, and
// which files may have faces.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/compressor.h>
#include <pcl_bsh/io/clouds/meshes/off_header.h>

#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Files of a format have its extension. All are read.
struct CloudFormat {
  std::string_view extension; ///< with its dot, in small letters
  bool has_faces = false;
  bool is_written = true;                           ///< as a cloud; see isWritten()
  bool (*begins)(std::string_view bytes) = nullptr; ///< whether bytes of a pipe begin so; null: no way to tell
};

/// In the order of lists for users. A pipe that begins as no other format is a .txt.
inline constexpr CloudFormat cloud_formats[] = {
    {".pcd", false, true,
     [](std::string_view bytes) {
       return bytes.starts_with("# .PCD") || bytes.starts_with("VERSION") || bytes.starts_with("FIELDS");
     }},
    {".ply", true, true, [](std::string_view bytes) { return bytes.starts_with("ply"); }},
    {".las", false, true, [](std::string_view bytes) { return bytes.starts_with("LASF"); }},
    {".laz"},
    {".e57", false, false, [](std::string_view bytes) { return bytes.starts_with("ASTM-E57"); }},
    {".obj", true, true},
    {".off", true, false, [](std::string_view bytes) { return beginsAsOff(bytes); }},
    {".stl", true, false},
    {".pts"},
    {".ptx"},
    {".csv"},
    {".xyz"},
    {".asc"},
    {".txt"}};

/// The format with that extension; null for any other.
inline const CloudFormat* cloudFormat(std::string_view extension)
{
  for (const CloudFormat& format : cloud_formats)
    if (format.extension == extension) return &format;
  return nullptr;
}

/// The extensions of the chosen formats, with `between` as separator, and `last` before the last one.
inline std::string extensionsOf(bool (*chosen)(const CloudFormat&), const std::string& between = " ",
                                const std::string& last = " ")
{
  std::vector<std::string_view> names;
  for (const CloudFormat& format : cloud_formats)
    if (chosen(format)) names.push_back(format.extension);
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list.append(i == 0 ? "" : i + 1 < names.size() ? between : last).append(names[i]);
  return list;
}

inline bool isRead(const CloudFormat&)
{
  return true;
}

/// A .laz is written where LASzip is.
inline bool isWritten(const CloudFormat& format)
{
  return format.is_written && (format.extension != ".laz" || writesLaz());
}

inline bool isNotWritten(const CloudFormat& format)
{
  return !isWritten(format);
}

/// A help text in which {read} and {unwritten} stand for the extensions.
inline std::string withFormats(std::string text)
{
  const auto put = [&](std::string_view what, const std::string& list) {
    const std::size_t at = text.find(what);
    if (at != std::string::npos) text.replace(at, what.size(), list);
  };
  put("{read}", extensionsOf(isRead));
  put("{unwritten}", extensionsOf(isNotWritten));
  return text;
}

} // namespace pcl_bsh::io
