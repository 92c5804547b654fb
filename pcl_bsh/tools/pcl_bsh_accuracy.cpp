// SPDX-License-Identifier: BSD-3-Clause
// The cost of accuracy in time, on two clouds. A table, a plot, and which setting to choose.
#include <pcl_bsh/tools/accuracy/program.h>

int main(int argc, char** argv)
{
  return pcl_bsh::accuracy::studyProgram("pcl_bsh_accuracy", argc, argv);
}
