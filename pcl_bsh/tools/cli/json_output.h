// SPDX-License-Identifier: BSD-3-Clause
// Reports for programs: in a file, or on standard output, where --json asks for it.
#pragma once

#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/query/work.h>

#include <exception>
#include <iostream>

namespace pcl_bsh::cli {

using io::writeJson; // in a file

inline void writeJson(std::ostream& out, const nlohmann::ordered_json& report)
{
  out << io::printed(report);
}

inline nlohmann::ordered_json workJson(const Work& work)
{
  return {{"node_pairs", work.node_pairs},           {"volumes_carried", work.volumes_carried},
          {"volumes_built", work.volumes_built},     {"leaf_pairs", work.leaf_pairs},
          {"exact_decisions", work.exact_decisions}, {"voxels_built", work.voxels_built}};
}

/// Returns the result of `check`. Where it throws, and `json` is set, standard output gets `failure` with the text as
/// `error`.
template <class Check>
auto checkTold(bool json, nlohmann::ordered_json failure, const Check& check)
{
  try {
    return check();
  }
  catch (const std::exception& error) {
    failure["error"] = error.what();
    if (json) writeJson(std::cout, failure);
    throw;
  }
}

} // namespace pcl_bsh::cli
