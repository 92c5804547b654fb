// SPDX-License-Identifier: BSD-3-Clause
#include "harness.h"

#include <pcl_bsh/base/retained_memory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <stdexcept>
#include <sys/resource.h>

namespace pcl_bsh::bench {
namespace {

std::string cpuModel()
{
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

std::string machine()
{
  return cpuModel() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

/// The commit of the sources this was compiled from; "-dirty" when they have changed since.
std::string commit()
{
  const std::string command = "git -C '" PCL_BSH_SOURCE_DIR "' describe --always --dirty --abbrev=12 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 128> line{};
  if (!pipe || !std::fgets(line.data(), line.size(), pipe.get())) return "unknown";
  std::string name(line.data());
  name.erase(name.find_last_not_of(" \n") + 1);
  return name;
}

std::size_t statusBytes(const std::string& key)
{
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind(key + ":", 0) == 0) return std::stoul(line.substr(key.size() + 1)) * 1024;
  throw std::runtime_error("/proc/self/status: has no " + key + ": memory can only be measured on Linux");
}

std::string csvCell(const std::string& cell)
{
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string result = "\"";
  for (const char c : cell) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

} // namespace

double quantile(std::vector<double> values, double fraction)
{
  if (values.empty()) throw std::invalid_argument("quantile: of no values");
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

MemoryPeak::MemoryPeak()
{
  releaseRetainedMemory(); // what earlier measurements freed must not be lent to this one
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5; // sets the peak back to the present
  before_ = statusBytes("VmRSS");
}

std::size_t MemoryPeak::bytes() const
{
  const std::size_t peak = statusBytes("VmHWM");
  return peak > before_ ? peak - before_ : 0;
}

double minorFaults()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_minflt);
}

void Table::add(std::vector<std::string> row)
{
  if (row.size() != headings_.size())
    throw std::invalid_argument("Table: a row of " + std::to_string(row.size()) + " cells under " +
                                std::to_string(headings_.size()) + " headings");
  rows_.push_back(std::move(row));
}

void Table::print() const
{
  std::vector<std::size_t> width;
  for (const auto& heading : headings_) width.push_back(heading.size());
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      std::printf("%s%*s", i == 0 ? "" : "  ", static_cast<int>(width[i]), cells[i].c_str());
    std::printf("\n");
  };
  line(headings_);
  for (const auto& row : rows_) line(row);
  std::fflush(stdout);
}

void Table::writeCsv(const std::string& file) const
{
  const std::string unfinished = file + ".part";
  {
    std::ofstream out(unfinished);
    const auto line = [&](std::vector<std::string> front, const std::vector<std::string>& cells) {
      front.insert(front.end(), cells.begin(), cells.end());
      for (std::size_t i = 0; i < front.size(); ++i) out << (i == 0 ? "" : ",") << csvCell(front[i]);
      out << '\n';
    };
    line({"machine", "compiler", "commit", "clock"}, headings_);
    const std::vector<std::string> here = {machine(), PCL_BSH_COMPILER, commit(), Stopwatch::name()};
    for (const auto& row : rows_) line(here, row);
    if (!out.flush()) throw std::runtime_error(file + ": cannot be written: choose another --csv");
  }
  std::filesystem::rename(unfinished, file);
}

std::string text(double value, int digits)
{
  std::array<char, 64> buffer;
  const int before = value == 0.0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  std::snprintf(buffer.data(), buffer.size(), "%.*f", std::max(0, std::min(digits - before, 12)), value);
  return buffer.data();
}

void useFreshMemory()
{
  mallopt(M_MMAP_THRESHOLD, 128 * 1024); // glibc's own beginning; set, it no longer grows
  mallopt(M_TRIM_THRESHOLD, 128 * 1024);
}

void requireVectorUnits()
{
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2"))
    throw std::runtime_error("this processor has no AVX2, which the peers were compiled for: remove -mavx2 in "
                             "test/benchmark/CMakeLists.txt");
#endif
}

void progress(const std::string& line)
{
  std::fprintf(stderr, "[%s]\n", line.c_str());
}

} // namespace pcl_bsh::bench
