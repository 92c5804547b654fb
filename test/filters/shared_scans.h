// SPDX-License-Identifier: BSD-3-Clause
// The real scans beside the project, where they are.
#pragma once

#include <pcl/io/pcd_io.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace pcl_bsh {

inline std::string scanFile(const std::string& name)
{
  std::string path = PCL_BSH_SHARED_DIR "/data/";
  return path.append(name).append(".pcd");
}

inline bool hasScan(const std::string& name)
{
  return std::filesystem::exists(scanFile(name));
}

template <class Cloud>
void readScan(const std::string& name, Cloud& cloud)
{
  if (pcl::PCDReader().read(scanFile(name), cloud) != 0) throw std::runtime_error("cannot read " + scanFile(name));
}

} // namespace pcl_bsh
