// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/column_names.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <array>
#include <set>

namespace pcl_bsh::io {

namespace {

constexpr auto give_columns = "give one name for each column, as x,y,z,_,intensity: _ is not read";

struct Axis {
  std::string_view name;
  std::array<std::string_view, 6> others;
};

constexpr std::array<Axis, 3> surveyed = {{
    {"x", {"e", "east", "easting", "", "", ""}},
    {"y", {"n", "north", "northing", "", "", ""}},
    {"z", {"h", "height", "elevation", "elev", "altitude", ""}},
}};

} // namespace

ColumnNames columnNamesOf(std::string_view text)
{
  ColumnNames names;
  std::set<std::string> seen;
  for (bool last = false; !last;) {
    const std::size_t end = std::min(text.find(','), text.size());
    last = end == text.size();
    const std::size_t from = std::min(text.find_first_not_of(" \t"), end);
    std::string name(text.substr(from, end - from));
    name.resize(name.find_last_not_of(" \t") + 1);
    if (name.empty()) throw FormatError("has a column without a name", give_columns);
    if (name != skipped_column && !seen.insert(name).second)
      throw FormatError("names two columns " + name, give_columns);
    names.push_back(std::move(name));
    if (!last) text.remove_prefix(end + 1);
  }
  return names;
}

ColumnNames withAxes(ColumnNames names)
{
  std::vector<std::string> small;
  for (const std::string& name : names) small.push_back(inSmallLetters(name));
  for (const Axis& axis : surveyed) {
    const auto is_other = [&](const std::string& name) {
      return std::find(axis.others.begin(), axis.others.end(), name) != axis.others.end();
    };
    if (std::find(small.begin(), small.end(), axis.name) != small.end()) continue;
    if (std::count_if(small.begin(), small.end(), is_other) != 1) continue;
    names[static_cast<std::size_t>(std::find_if(small.begin(), small.end(), is_other) - small.begin())] = axis.name;
  }
  return names;
}

bool isColumnText(std::string_view extension)
{
  return extension == ".xyz" || extension == ".asc" || extension == ".txt" || extension == ".csv";
}

void ColumnChoice::add(const std::string& text)
{
  const std::size_t at = text.rfind('='); // a file's name may have others
  ColumnNames names = columnNamesOf(std::string_view(text).substr(at == std::string::npos ? 0 : at + 1));
  const std::string file = at == std::string::npos ? "" : text.substr(0, at);
  const bool first = at == std::string::npos ? !all_ : files_.count(file) == 0;
  if (!first) throw FormatError("is given twice" + (file.empty() ? "" : " for " + file), "give it once");
  if (at == std::string::npos)
    all_ = std::move(names);
  else
    files_[file] = std::move(names);
}

ColumnNames ColumnChoice::of(const std::filesystem::path& file) const
{
  if (const auto own = files_.find(file); own != files_.end()) return own->second;
  return all_ && (isColumnText(extensionOf(file)) || isPipe(file)) ? *all_ : ColumnNames();
}

void ColumnChoice::requireUsed(const std::vector<std::filesystem::path>& files) const
{
  for (const auto& [file, names] : files_)
    if (std::find(files.begin(), files.end(), file) == files.end())
      throw FormatError("names columns of " + file.string() + ", which is not read",
                        "give the file's name as it stands");
  const auto is_text = [&](const std::filesystem::path& file) {
    return isColumnText(extensionOf(file)) || isPipe(file);
  };
  if (all_ && std::none_of(files.begin(), files.end(), is_text))
    throw FormatError("names columns, and no .xyz, .asc, .txt or .csv file is read", "leave it out");
}

} // namespace pcl_bsh::io
