// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
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
  bool digit = true; // whether the last character was one
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

/// The files of a .vtm's blocks: which are ours to write, and which to remove. A generation of blocks of NAME.vtm is
/// NAME/NAME_<generation>_<number>.vtp; no earlier block has this generation. The destructor removes the blocks, as
/// does a request to stop the program, unless keep() was called.
class BlockFiles {
public:
  /// @throws FileError when NAME is no folder, or holds what is named otherwise
  explicit BlockFiles(const fs::path& vtm) : folder_(vtm.parent_path() / vtm.stem()), stem_(vtm.stem().string())
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
        refuse("is the folder for the blocks of " + vtm.string() + ", and holds " + names.back() +
               ", which is not a block");
    }
    const auto taken = [&](const std::string& name) {
      return name.rfind(stem_ + "_" + std::to_string(generation_) + "_", 0) == 0;
    };
    while (std::any_of(names.begin(), names.end(), taken)) ++generation_;
    for (const std::string& name : listedIn(vtm, stem_)) earlier_.push_back(folder_ / name);
  }

  ~BlockFiles()
  {
    const auto lock = files::lockUnfinished();
    std::error_code ignored;
    for (const auto& [file, block] : made_) {
      fs::remove(file, ignored);
      files::dropUnfinished(file);
    }
  }

  BlockFiles(const BlockFiles&) = delete;
  BlockFiles& operator=(const BlockFiles&) = delete;

  /// Makes NAME, unless it is there. @throws FileError
  void makeFolder() { made_folder_.emplace(folder_); }

  /// The file of the next block.
  fs::path next() const
  {
    return folder_ / (stem_ + "_" + std::to_string(generation_) + "_" + std::to_string(made_.size()) + ".vtp");
  }

  /// Puts the file of the next block in place.
  void commit(files::FileReplacement& file, const fs::path& name, const std::string& block)
  {
    {
      const auto lock = files::lockUnfinished();
      made_.emplace_back(name, block);
      files::addUnfinished(name);
    }
    file.commit();
  }

  /// The content of NAME.vtm.
  std::string list() const
  {
    std::ostringstream xml;
    xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\">\n  "
           "<vtkMultiBlockDataSet>\n";
    for (std::size_t i = 0; i < made_.size(); ++i) {
      xml << "    <DataSet index=\"" << i << "\" name=\"" << escaped(made_[i].second) << "\" file=\"" << escaped(stem_)
          << '/' << escaped(made_[i].first.filename().string()) << "\"/>\n";
    }
    xml << "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
    return xml.str();
  }

  /// Keeps the blocks, which are complete. To be called under lockUnfinished().
  void keep()
  {
    for (const auto& made : made_) files::dropUnfinished(made.first);
    made_.clear();
  }

  /// Removes the blocks that an earlier NAME.vtm listed.
  void removeEarlier() const
  {
    std::error_code ignored;
    for (const fs::path& file : earlier_) fs::remove(file, ignored);
  }

private:
  fs::path folder_;
  std::optional<files::OutputFolder> made_folder_; ///< removed after the blocks in it
  std::string stem_;
  std::vector<fs::path> earlier_;
  std::size_t generation_ = 0;
  std::vector<std::pair<fs::path, std::string>> made_; ///< file and block
};

/// Requires an ordinary file: an export is read by name, and has files of its own beside it, so it is no pipe or
/// device.
void requireFile(const fs::path& path)
{
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw files::FileError(path, "is no ordinary file", "name another file");
}

/// VTK writes into a text, since its writer of files crashes where a disk is full (9.1: vtkXMLUnstructuredDataWriter
/// frees what it has not set).
void fill(files::FileReplacement& file, vtkPolyData& data)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  writer->WriteToOutputStringOn();
  writer->SetDataModeToBinary(); // expat refuses appended data since its corrections of 2024
  writer->SetCompressorTypeToNone();
  if (writer->Write() != 1) throw std::runtime_error("VTK: could not write poly data as XML");
  file.stream() << writer->GetOutputString();
}

} // namespace

void writeVtp(vtkPolyData& data, const fs::path& path)
{
  requireFile(path);
  files::FileReplacement file(path);
  fill(file, data);
  file.commit();
}

void writeVtm(const std::vector<NamedData>& blocks, const fs::path& path)
{
  requireFile(path);
  files::FileReplacement list(path);
  BlockFiles pieces(path);
  pieces.makeFolder();
  for (const NamedData& block : blocks) {
    const fs::path name = pieces.next();
    files::FileReplacement file(name);
    fill(file, *block.second);
    pieces.commit(file, name, block.first);
  }
  list.stream() << pieces.list();
  list.commit([&] { pieces.keep(); }); // a program that is stopped here leaves either list with its blocks
  pieces.removeEarlier();
}

void requireWritableData(const fs::path& path)
{
  requireFile(path);
  files::requireWritable(path);
  if (path.extension() == ".vtm") static_cast<void>(BlockFiles(path));
}

} // namespace pcl_bsh::vtk
