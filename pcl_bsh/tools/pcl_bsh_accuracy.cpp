// SPDX-License-Identifier: BSD-3-Clause
// Measures what accuracy costs in time, on two clouds: a table, a plot, and which setting to choose.
#include <pcl_bsh/tools/accuracy/program.h>

int main(int argc, char** argv)
{
  return pcl_bsh::accuracy::studyProgram("pcl_bsh_accuracy", argc, argv);
}
