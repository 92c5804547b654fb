// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/zip_archive.h>
#include <pcl_bsh/io/text/format_error.h>

#include <zip.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t most_unzipped = std::size_t{1} << 28;

struct CloseZip {
  void operator()(zip_t* zip) const noexcept { zip_discard(zip); } // writes nothing
  void operator()(zip_file_t* file) const noexcept { zip_fclose(file); }
  void operator()(zip_source_t* source) const noexcept { zip_source_free(source); }
};
using Zip = std::unique_ptr<zip_t, CloseZip>;
using ZipEntry = std::unique_ptr<zip_file_t, CloseZip>;
using ZipSource = std::unique_ptr<zip_source_t, CloseZip>;

/// Whether a name stays in the folder that an archive is unpacked into.
bool staysInside(std::string name)
{
  std::replace(name.begin(), name.end(), '\\', '/');
  return !name.empty() && name[0] != '/' && name.find(':') == std::string::npos &&
         ('/' + name + '/').find("/../") == std::string::npos;
}

[[noreturn]] void refuseSize()
{
  throw FormatError("unpacks to more than " + std::to_string(most_unzipped >> 20U) + " MiB",
                    "give an archive that holds less");
}

std::string contentOfEntry(zip_t* zip, zip_uint64_t index, const std::string& name, std::size_t most)
{
  const ZipEntry entry(zip_fopen_index(zip, index, 0));
  if (!entry) throw FormatError("has '" + name + "', which cannot be unpacked: " + zip_strerror(zip));
  std::string content;
  std::array<char, 1 << 16> block;
  for (;;) {
    const zip_int64_t bytes = zip_fread(entry.get(), block.data(), block.size());
    if (bytes < 0)
      throw FormatError("is damaged at '" + name +
                        "': " + std::string(zip_error_strerror(zip_file_get_error(entry.get()))));
    if (bytes == 0) return content;
    if (static_cast<std::size_t>(bytes) > most - content.size()) refuseSize();
    content.append(block.data(), static_cast<std::size_t>(bytes));
  }
}

/// A date as zip files have it: seven bits of years since 1980, then month and day.
zip_uint16_t dosDate(const std::string& date)
{
  const auto part = [&](std::size_t at, std::size_t digits) { return std::stoi(date.substr(at, digits)); };
  return static_cast<zip_uint16_t>(std::clamp(part(0, 4) - 1980, 0, 127) << 9 | part(5, 2) << 5 | part(8, 2));
}

} // namespace

std::string zipped(const ZipFiles& files, const std::string& date)
{
  const auto fail = [] { throw std::runtime_error("a zip archive could not be made"); };
  zip_error_t error;
  zip_error_init(&error);
  const ZipSource archive(zip_source_buffer_create(nullptr, 0, 0, &error));
  if (!archive) fail();
  zip_source_keep(archive.get()); // of which the zip takes one
  Zip zip(zip_open_from_source(archive.get(), ZIP_TRUNCATE, &error));
  if (!zip) {
    zip_source_free(archive.get());
    fail();
  }
  for (const auto& [name, content] : files) {
    zip_source_t* const source = zip_source_buffer(zip.get(), content.data(), content.size(), 0);
    const zip_int64_t index = source ? zip_file_add(zip.get(), name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) {
      zip_source_free(source);
      fail();
    }
    zip_file_set_dostime(zip.get(), static_cast<zip_uint64_t>(index), 0, dosDate(date), 0);
  }
  if (zip_close(zip.get()) != 0) fail();
  static_cast<void>(zip.release());
  if (zip_source_open(archive.get()) != 0) fail();
  zip_stat_t facts;
  zip_source_stat(archive.get(), &facts);
  std::string bytes(static_cast<std::size_t>(facts.size), '\0');
  if (zip_source_read(archive.get(), bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size())) fail();
  zip_source_close(archive.get());
  return bytes;
}

ZipFiles unzipped(std::string_view archive, const std::function<bool(const std::string&)>& wanted)
{
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(archive.data(), archive.size(), 0, &error);
  const Zip zip(source ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr);
  if (!zip) {
    zip_source_free(source);
    const std::string wrong = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw FormatError("is no whole zip archive: " + wrong);
  }
  ZipFiles files;
  std::size_t left = most_unzipped;
  const zip_int64_t entries = zip_get_num_entries(zip.get(), 0);
  for (zip_int64_t i = 0; i < entries; ++i) {
    const auto index = static_cast<zip_uint64_t>(i);
    const char* const given = zip_get_name(zip.get(), index, ZIP_FL_ENC_GUESS);
    const std::string name = given ? given : "";
    if (!staysInside(name)) throw FormatError("has a file named '" + name + "', which leads out of the archive");
    if (name.back() == '/' || !wanted(name)) continue;
    zip_stat_t facts;
    const bool says = zip_stat_index(zip.get(), index, 0, &facts) == 0 && (facts.valid & ZIP_STAT_SIZE) != 0;
    if (says && facts.size > left) refuseSize(); // before it is unpacked
    if (files.contains(name)) throw FormatError("has two files named '" + name + "'");
    left -= (files[name] = contentOfEntry(zip.get(), index, name, left)).size();
  }
  return files;
}

} // namespace pcl_bsh::io
