// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/vtk/block_files.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <system_error>

namespace pcl_bsh::vtk {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<char, std::string_view>, 5> entities = {
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}}};

/// As the value of an attribute in XML, which has no place for control characters.
std::string escaped(const std::string& text)
{
  std::string xml;
  for (const char c : text) {
    const auto* const entity =
        std::find_if(entities.begin(), entities.end(), [&](const auto& e) { return e.first == c; });
    if (entity != entities.end())
      xml += entity->second;
    else
      xml += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  }
  return xml;
}

/// STEM_<digits>.vtp or STEM_<digits>_<digits>.vtp: VTK's own writer has the first, this one the second.
bool isBlockOf(const std::string& stem, const std::string& name)
{
  const std::string end = ".vtp";
  if (name.size() <= stem.size() + end.size() || name.compare(0, stem.size(), stem) != 0) return false;
  if (name.compare(name.size() - end.size(), end.size(), end) != 0) return false;
  bool digit = true; // what came last
  std::size_t numbers = 0;
  for (const char c : name.substr(stem.size(), name.size() - stem.size() - end.size())) {
    if (c == '_' ? !digit : !(c >= '0' && c <= '9') || numbers == 0) return false;
    numbers += c == '_' ? 1 : 0;
    digit = c != '_';
  }
  return digit && (numbers == 1 || numbers == 2);
}

/// The blocks that a .vtm lists in its folder, by their names.
std::vector<std::string> listedIn(const fs::path& vtm, const std::string& stem)
{
  std::ifstream file(vtm, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string begin = "file=\"" + escaped(stem) + "/" + escaped(stem);
  std::vector<std::string> names;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    const std::size_t rest = at + begin.size();
    const std::string name = stem + text.substr(rest, text.find('"', rest) - rest);
    if (isBlockOf(stem, name)) names.push_back(name);
  }
  return names;
}

} // namespace

BlockFiles::BlockFiles(const fs::path& vtm) : folder_(vtm.parent_path() / vtm.stem()), stem_(vtm.stem().string())
{
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder_, error))) return;
  const auto refuse = [&](const std::string& wrong) {
    throw files::FileError(folder_, wrong, "name another .vtm, or move that away");
  };
  if (!fs::is_directory(folder_, error)) refuse("is in the way of the folder for the blocks of " + vtm.string());
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    names.push_back(entry.path().filename().string());
    if (!isBlockOf(stem_, names.back()))
      refuse("is the folder for the blocks of " + vtm.string() + ", and holds " + names.back() + ", which is none");
  }
  const auto taken = [&](const std::string& name) {
    return name.rfind(stem_ + "_" + std::to_string(generation_) + "_", 0) == 0;
  };
  while (std::any_of(names.begin(), names.end(), taken)) ++generation_;
  for (const std::string& name : listedIn(vtm, stem_)) earlier_.push_back(folder_ / name);
}

BlockFiles::~BlockFiles()
{
  const auto lock = files::lockUnfinished();
  std::error_code ignored;
  for (const auto& [file, block] : made_) {
    fs::remove(file, ignored);
    files::dropUnfinished(file);
  }
}

void BlockFiles::makeFolder()
{
  made_folder_.emplace(folder_);
}

fs::path BlockFiles::next() const
{
  return folder_ / (stem_ + "_" + std::to_string(generation_) + "_" + std::to_string(made_.size()) + ".vtp");
}

void BlockFiles::commit(files::FileReplacement& file, const fs::path& name, const std::string& block)
{
  {
    const auto lock = files::lockUnfinished();
    made_.emplace_back(name, block);
    files::addUnfinished(name);
  }
  file.commit();
}

std::string BlockFiles::list() const
{
  std::ostringstream xml;
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\">\n  <vtkMultiBlockDataSet>\n";
  for (std::size_t i = 0; i < made_.size(); ++i) {
    xml << "    <DataSet index=\"" << i << "\" name=\"" << escaped(made_[i].second) << "\" file=\"" << escaped(stem_)
        << '/' << escaped(made_[i].first.filename().string()) << "\"/>\n";
  }
  xml << "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
  return xml.str();
}

void BlockFiles::keep()
{
  for (const auto& made : made_) files::dropUnfinished(made.first);
  made_.clear();
}

void BlockFiles::removeEarlier() const
{
  std::error_code ignored;
  for (const fs::path& file : earlier_) fs::remove(file, ignored);
}

} // namespace pcl_bsh::vtk
