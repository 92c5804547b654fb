// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/ros_packages.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>
#include <vector>

namespace pcl_bsh::io {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> partsOf(std::string_view folders)
{
  std::vector<fs::path> parts;
  while (!folders.empty()) {
    const std::size_t end = std::min(folders.find(':'), folders.size());
    if (end > 0) parts.emplace_back(folders.substr(0, end));
    folders.remove_prefix(std::min(end + 1, folders.size()));
  }
  return parts;
}

bool has(const fs::path& folder, const char* file)
{
  std::error_code ignored;
  return fs::is_regular_file(folder / file, ignored);
}

/// The name that a package.xml gives its package, outside of comments; empty: no name.
std::string nameIn(const fs::path& manifest)
{
  std::ifstream in(manifest, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  for (std::size_t at = text.find("<!--"); at != std::string::npos; at = text.find("<!--", at)) {
    const std::size_t end = text.find("-->", at);
    text.erase(at, end == std::string::npos ? end : end + 3 - at);
  }
  constexpr std::string_view tag = "<name>", blanks = " \t\r\n";
  const std::size_t begin = text.find(tag);
  if (begin == std::string::npos) return {};
  std::string name = text.substr(begin + tag.size(), text.find('<', begin + tag.size()) - begin - tag.size());
  name.erase(0, std::min(name.find_first_not_of(blanks), name.size()));
  name.erase(name.find_last_not_of(blanks) + 1);
  return name;
}

/// Looks for a package in folders and below them, each folder once however many links lead to it.
class Search {
public:
  explicit Search(const std::string& name) : name_(name) {}

  std::optional<fs::path> below(const fs::path& folder)
  {
    std::error_code failed;
    const fs::path real = fs::canonical(folder, failed);
    if (failed || !fs::is_directory(real, failed) || !visited_.insert(real).second) return std::nullopt;
    const bool named = has(folder, "package.xml"), old = has(folder, "manifest.xml");
    if (named && nameIn(folder / "package.xml") == name_) return folder;
    if (!named && old && real.filename() == name_) return folder;
    if (named || old || has(folder, "CATKIN_IGNORE") || has(folder, "rospack_nosubdirs")) return std::nullopt;
    std::set<fs::path> children; // in an order that does not depend on the disk
    for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, failed), end;
         !failed && at != end; at.increment(failed))
      if (at->path().filename().string().front() != '.') children.insert(at->path());
    for (const fs::path& child : children)
      if (const auto found = below(child)) return found;
    return std::nullopt;
  }

private:
  const std::string& name_;
  std::set<fs::path> visited_;
};

} // namespace

std::optional<fs::path> packageIn(std::string_view folders, const std::string& name)
{
  if (name.empty()) return std::nullopt;
  const std::vector<fs::path> parts = partsOf(folders);
  Search search(name);
  for (const fs::path& folder : parts)
    if (const auto found = search.below(folder)) return found;
  for (const fs::path& folder : parts) {
    std::error_code ignored;
    if (fs::is_directory(folder / name, ignored)) return folder / name;
    const fs::path itself = folder.has_filename() ? folder : folder.parent_path(); // without a slash at its end
    if (itself.filename() == name && fs::is_directory(itself, ignored)) return itself;
  }
  return std::nullopt;
}

std::string packagePath()
{
  const char* const found = std::getenv("ROS_PACKAGE_PATH");
  return found ? found : "";
}

} // namespace pcl_bsh::io
