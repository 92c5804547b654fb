// SPDX-License-Identifier: BSD-3-Clause
// A program as an MPI job of two ranks.
#pragma once

#include "tools/programs/program_run.h"

namespace pcl_bsh::site {

inline bool hasMpirun()
{
  return std::system("mpirun --version > /dev/null 2>&1") == 0;
}

/// Not in this process' environment: where MPI has begun in it, mpirun would take itself for a part of that job. Nor
/// with hwloc's component that opens X displays, which other tests begin and end: tile_visitor.cpp. Open MPI 5 needs
/// HOME.
/// @param arguments as a shell reads them. @param place the folder to run in
inline Outcome runOnTwoRanks(const std::string& arguments, const std::filesystem::path& place,
                             const std::string& program = "pcl_bsh_site")
{
  const io::TemporaryFolder folder;
  const std::string out = (folder / "out").string(), err = (folder / "err").string();
  const std::string command = "cd " + place.string() + " && env -i PATH=\"$PATH\" HOME=" + (folder / "").string() +
                              " HWLOC_COMPONENTS=-gl "
                              "OMPI_MCA_btl=^tcp " // which warns of networks that lead nowhere
                              "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                              "mpirun --oversubscribe -n 2 " PCL_BSH_PROGRAM_DIR "/" +
                              program + ' ' + arguments + " >" + out + " 2>" + err;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::contentOf(out), io::contentOf(err)};
}

} // namespace pcl_bsh::site
