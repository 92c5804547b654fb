// SPDX-License-Identifier: BSD-3-Clause
#include "json_output.h"

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/json/json_document.h>

namespace pcl_bsh::cli {

void writeJson(std::ostream& out, const nlohmann::ordered_json& report)
{
  out << io::printed(report);
}

void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& report)
{
  files::replaceFile(file, [&](std::ostream& out) { writeJson(out, report); });
}

} // namespace pcl_bsh::cli
