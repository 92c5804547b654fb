// SPDX-License-Identifier: BSD-3-Clause
#include "surface_options.h"

#include "command_line.h"

#include <cmath>

namespace pcl_bsh::cli {

void addSurfaceOptions(CLI::App& app, std::optional<double>& tolerance, bool& vertices_only)
{
  CLI::Option* const length =
      app.add_option("--surface-tolerance", tolerance,
                     "files with faces are surfaces: free is farther than D from one, for\n"
                     "certain, and colliding is within D + T; less takes more time and\n"
                     "memory (default: a tenth of D; of 0, the size / 10,000)")
          ->type_name("T")
          ->transform(number<double>("give a finite length > 0", [](double d) { return d > 0 && std::isfinite(d); }));
  app.add_flag("--vertices-only", vertices_only, "files with faces are their vertices alone")->excludes(length);
}

} // namespace pcl_bsh::cli
