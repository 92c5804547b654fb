// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/process_memory.h>

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace pcl_bsh::pipeline {

std::size_t residentBytes()
{
  std::size_t total_pages = 0;
  std::size_t resident_pages = 0;
  std::ifstream("/proc/self/statm") >> total_pages >> resident_pages;
  return resident_pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t peakBytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

} // namespace pcl_bsh::pipeline
