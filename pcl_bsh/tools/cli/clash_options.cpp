// SPDX-License-Identifier: BSD-3-Clause
#include "clash_options.h"

#include "command_line.h"

#include <pcl_bsh/io/files/replace_file.h>

#include <cmath>
#include <utility>

namespace pcl_bsh::cli {

void ClashOptions::addTo(CLI::App& app, const std::string& unit_of)
{
  app.add_option("--clashes", clashes,
                 "list of the places that collide, to .json, .csv, .html, .bcf (3.0) or\n"
                 ".bcfzip (2.1); may be given more than once")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option("--cluster-distance", cluster_distance,
                 "colliding points no farther apart belong to one clash (default: the\n"
                 "greater of the clearance and four spacings of the points, rounded up to\n"
                 "a power of two)")
      ->type_name("L")
      ->transform(number<double>("give a finite length > 0", [](double d) { return d > 0 && std::isfinite(d); }));
  app.add_option("--previous", previous,
                 "earlier list, .json or BCF, of the same question; swept motion and what\n"
                 "was seen may differ: clashes are new, persisting, resolved, or not\n"
                 "visited by the path or not scanned any more; BCF brings comments and\n"
                 "topics' states")
      ->type_name("FILE");
  app.add_option("--unit", unit, "name of the clouds' unit, for " + unit_of)->type_name("NAME");
}

void ClashOptions::requireConsistent() const
{
  if (clashes.empty() && (cluster_distance > 0 || previous))
    throw UsageError(std::string(previous ? "--previous" : "--cluster-distance") +
                     ": no clash report is written: give --clashes FILE");
}

void ClashOptions::addTo(CommandFiles& files) const
{
  files.reads("--previous", previous.value_or(""));
  for (const std::filesystem::path& list : clashes) files.writes("--clashes", list, "--previous"); // may replace it
}

void ClashOptions::requireWritable() const
{
  for (const std::filesystem::path& list : clashes) {
    try {
      io::requireClashFormat(list);
    }
    catch (const files::FileError& error) {
      throw UsageError(std::string("--clashes: ") + error.what());
    }
    files::requireWritable(list);
  }
}

void ClashOptions::write(const io::ClashLists& lists, std::vector<std::string>& warnings) const
{
  for (const std::filesystem::path& file : clashes)
    for (std::string& remark : io::writeClashes(file, lists)) warnings.push_back(std::move(remark));
}

} // namespace pcl_bsh::cli
