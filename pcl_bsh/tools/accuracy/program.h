// SPDX-License-Identifier: BSD-3-Clause
// All of pcl_bsh_accuracy except its main().
#pragma once

#include "study.h"

namespace pcl_bsh::accuracy {

/// Measures how other libraries get the answers, at the poses of the subject.
using Peers = std::vector<Measurement>(const Subject& subject, unsigned repetitions, const Progress& progress);

/// Reads the command line, measures, writes the reports. @param measure_peers null: ours alone
int studyProgram(const char* program, int argc, char** argv, Peers* measure_peers = nullptr);

} // namespace pcl_bsh::accuracy
