// SPDX-License-Identifier: BSD-3-Clause
// The study of pcl_bsh_accuracy, and PCL's ways to the same answers beside it; both clouds must be points.
#include "peer/accuracy_peers.h"
#include <pcl_bsh/tools/accuracy/program.h>

int main(int argc, char** argv)
{
  return pcl_bsh::accuracy::studyProgram("bench_accuracy", argc, argv, pcl_bsh::accuracy::measurePeers);
}
