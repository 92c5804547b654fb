// SPDX-License-Identifier: BSD-3-Clause
// Calls to the kernel about files that must survive a loss of power, in order. A test that is linked with
// disk_calls.cpp has these calls pass through there.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::test {

/// While it lives, write(), pwrite(), fsync(), syncfs() and rename() of this process are noted, by the names of files
/// without folders: "write out.part0", "fsync out.part0", "rename out.part0 out". One at a time.
class DiskCalls {
public:
  DiskCalls();
  ~DiskCalls();
  DiskCalls(const DiskCalls&) = delete;
  DiskCalls& operator=(const DiskCalls&) = delete;

  std::vector<std::string> calls;          ///< of the same ones in a row, the first
  std::size_t made = 0;                    ///< all of them
  std::map<std::string, int> failing;      ///< calls that are not made, and the errno that they fail with
  std::map<std::string, int> failing_once; ///< the same of the next one alone
};

} // namespace pcl_bsh::test
