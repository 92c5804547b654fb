// SPDX-License-Identifier: BSD-3-Clause
// One run of one racer in a process of its own.
#pragma once

#include "workload/points.h"

#include <string>
#include <vector>

namespace pcl_bsh::bench {

/// Two clouds where new processes find them: in anonymous memory that a descriptor stands for. Linux only.
class CloudsInMemory {
public:
  CloudsInMemory(const Points& a, const Points& b);
  ~CloudsInMemory();
  CloudsInMemory(const CloudsInMemory&) = delete;
  CloudsInMemory& operator=(const CloudsInMemory&) = delete;

  int descriptor() const { return descriptor_; }

private:
  int descriptor_;
};

struct OneShot {
  std::string racer;    ///< one of kFlagsRacers
  std::string question; ///< flags or any
  double d = 0.0;
  std::vector<double> tuning; ///< FlagsRacer::tuning()
};

struct OneShotResult {
  double wall_ms = 0.0;
  double cpu_ms = 0.0; ///< user and system
  double build_cpu_ms = 0.0;
  double faults = 0.0; ///< minor ones
  double build_faults = 0.0;
  double peak_bytes = 0.0; ///< resident, above the clouds
  std::size_t found = 0;   ///< points flagged; 1 or 0 for any
  std::string remark;
};

/// Runs this program again. @throws std::runtime_error when that fails
OneShotResult runInNewProcess(const OneShot& shot, const CloudsInMemory& clouds);

/// Whether this process was started by runInNewProcess().
bool isOneShot(int argc, char** argv);

/// Runs one question in this process. @return its exit code
int runOneShot(int argc, char** argv);

} // namespace pcl_bsh::bench
