// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/report_origin.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/parse_number.h>
#include <pcl_bsh/version.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

namespace pcl_bsh::io {
namespace {

constexpr std::time_t last_second = 253402300799; ///< of the year 9999

std::time_t secondsSince1970()
{
  const char* const given = std::getenv("SOURCE_DATE_EPOCH");
  if (given == nullptr) return std::time(nullptr);
  const std::string digits = given;
  const bool is_whole = digits.find_first_not_of("0123456789") == std::string::npos;
  const double seconds = is_whole && !digits.empty() ? parseNumber<double>(digits) : -1.0;
  if (!(seconds >= 0 && seconds <= static_cast<double>(last_second)))
    throw std::runtime_error("SOURCE_DATE_EPOCH: '" + digits +
                             "' is no date: give seconds since 1970, up to the year 9999");
  return static_cast<std::time_t>(seconds);
}

} // namespace

std::string reportProgram()
{
  return "pcl_bsh " PCL_BSH_VERSION_TEXT;
}

std::string reportDate()
{
  const std::time_t now = secondsSince1970();
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts);
  return text.data();
}

std::string formatOf(const std::filesystem::path& file, const std::vector<std::string>& known)
{
  reportDate();
  const std::string extension = file.extension().string();
  std::string list;
  for (const std::string& format : known) {
    if (format == extension) return format;
    list += (list.empty() ? "" : &format == &known.back() ? " or " : ", ") + format;
  }
  throw files::FileError(file, "unknown extension '" + extension + "'", "give a " + list + " file");
}

} // namespace pcl_bsh::io
