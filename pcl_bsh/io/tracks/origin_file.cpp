// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/origin_file.h>

#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/tracks/number_table.h>

#include <utility>
#include <vector>

namespace pcl_bsh::io {

OriginPath readOriginPath(const std::filesystem::path& path)
{
  const FileBytes file(path);
  return namingFile(path, "give a place in each line, in columns time, x, y and z", [&] {
    const NumberTable table =
        numberTable(file.view(), {{{"time", "gps_time", "t"}}, x_column, y_column, z_column}, false);
    std::vector<TimedOrigin> places;
    for (const std::vector<double>& row : table.rows) places.push_back({row[0], {row[1], row[2], row[3]}});
    try {
      return OriginPath(std::move(places));
    }
    catch (const InvalidInput& error) {
      if (error.index()) table.lines[*error.index()].fail("is no place of a path: " + error.wrong(), error.remedy());
      throw;
    }
  });
}

} // namespace pcl_bsh::io
