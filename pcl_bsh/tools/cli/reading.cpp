// SPDX-License-Identifier: BSD-3-Clause
#include "reading.h"

#include "program.h"

#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>

namespace pcl_bsh::cli {

void ReadOptions::addTo(CLI::App& app)
{
  app.add_option("--columns", given_,
                 "names of the columns of .xyz, .txt and .csv, as x,y,z,_,intensity (_ is\n"
                 "not read), in place of what they say; FILE=NAMES: of that file alone;\n"
                 "may be given more than once")
      ->type_name("NAMES")
      ->allow_extra_args(false);
  app.add_flag("--allow-scale", allow_scale_,
               "transforms of .ptx files may scale uniformly; they are refused\notherwise, and whatever else is no "
               "rigid motion always");
  app.add_option("--scan", scan_, "of a .ptx or .e57 file only that scan, from 0; all otherwise")->type_name("N");
}

io::ReadSettings ReadChoice::of(const std::filesystem::path& file) const
{
  return {columns.of(file), allow_scale, io::mayHaveScans(io::extensionOf(file)) ? scan : std::nullopt};
}

ReadChoice ReadOptions::read(const std::vector<std::filesystem::path>& files) const
{
  io::ColumnChoice choice;
  std::string text;
  try {
    for (const std::string& given : given_) choice.add(text = given);
    choice.requireUsed(files);
  }
  catch (const io::FormatError& error) {
    throw UsageError("--columns: " + text + ": " + error.what() + ": " + error.remedy());
  }
  const auto may = [](const std::filesystem::path& file) { return io::mayHaveScans(io::extensionOf(file)); };
  if (scan_ && std::none_of(files.begin(), files.end(), may))
    throw UsageError("--scan: none of the clouds is a .ptx or .e57 file, which may have several scans: leave it out");
  return {choice, allow_scale_, scan_};
}

} // namespace pcl_bsh::cli
