// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/io/clouds/meshes/stl.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/search/selected_records.h>
#include <pcl_bsh/search/used_vertices.h>

#include <algorithm>
#include <limits>
#include <map>

namespace pcl_bsh::io {
namespace {

constexpr std::uint32_t nameless = std::numeric_limits<std::uint32_t>::max();

/// Triangles by the names that stand before them.
class NamedTriangles {
public:
  /// @param unique whether each name may stand only once
  void begin(std::string_view name, bool unique)
  {
    const auto [entry, is_new] = numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(numbers_.size()));
    if (!is_new && unique) throw FormatError("names two parts '" + entry->first + "'", "give each a name of its own");
    if (name.empty()) throw FormatError("has a part without a name", "give it one");
    current_ = entry->second;
  }

  void add(std::size_t triangles) { part_of_.insert(part_of_.end(), triangles, current_); }

  MeshParts finished() &&
  {
    std::vector<std::size_t> counts(numbers_.size(), 0);
    std::size_t without = 0;
    for (const std::uint32_t part : part_of_) ++(part == nameless ? without : counts[part]);
    std::vector<std::string> names(numbers_.size());
    for (const auto& [name, number] : numbers_) names[number] = name;

    MeshParts parts;
    std::vector<std::uint32_t> kept(names.size(), nameless);
    std::vector<std::string> empty;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (counts[i] == 0) {
        empty.push_back(std::move(names[i]));
        continue;
      }
      kept[i] = static_cast<std::uint32_t>(parts.names.size());
      parts.names.push_back(std::move(names[i]));
    }
    if (parts.names.empty())
      throw FormatError("has no parts with names", "give it objects (o), groups (g) or solids, or leave out `parts`");
    if (!empty.empty())
      parts.remarks.push_back(counted(empty.size(), "part") + " without faces, '" + empty.front() +
                              "' first: left out");
    if (without > 0) parts.remarks.push_back(counted(without, "triangle") + " before the first part's name: left out");
    for (std::uint32_t& part : part_of_)
      if (part != nameless) part = kept[part];
    parts.part_of = std::move(part_of_);
    return parts;
  }

private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::uint32_t> part_of_;
  std::uint32_t current_ = nameless;
};

bool hasObjects(std::string_view file)
{
  for (TextCursor text = objText(file); text.nextLine();)
    if (text.word() == "o") return true;
  return false;
}

NamedTriangles partsOfStl(std::string_view file)
{
  NamedTriangles named;
  for (const StlSolid& solid : parseStlSolids(file)) {
    named.begin(solid.name, true);
    named.add(solid.triangles);
  }
  return named;
}

NamedTriangles partsOfObj(std::string_view file)
{
  const bool objects = hasObjects(file);
  NamedTriangles named;
  for (TextCursor text = objText(file); text.nextLine();) {
    const std::string_view kind = text.word();
    if (kind == (objects ? "o" : "g")) named.begin(text.line().empty() && !objects ? "default" : text.line(), objects);
    if (kind != "f" && kind != "fo") continue;
    std::size_t corners = 0;
    for (; !text.line().empty(); ++corners) text.word();
    named.add(std::max<std::size_t>(corners, 2) - 2);
  }
  return named;
}

} // namespace

MeshParts readMeshParts(const std::filesystem::path& file)
{
  const std::string extension = extensionOf(file);
  if (extension != ".obj" && extension != ".stl")
    throw files::FileError(file, "has no parts with names", "give an .obj, an .stl that is text, or leave out `parts`");
  const FileBytes bytes(file);
  return naming(file, [&] {
    MeshParts parts = (extension == ".obj" ? partsOfObj : partsOfStl)(bytes.view()).finished();
    parts.file = file;
    return parts;
  });
}

std::string MeshParts::nameOf(std::size_t part, const std::string& whole) const
{
  return whole.empty() ? names[part] : whole + '/' + names[part];
}

std::vector<Mesh> meshesOf(const MeshParts& parts, const pcl::PCLPointCloud2& vertices,
                           const std::vector<Triangle>& triangles)
{
  if (triangles.size() != parts.part_of.size())
    throw files::FileError(parts.file, "changed while it was read", "run this again");
  std::vector<Mesh> meshes(parts.names.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (parts.part_of[i] != nameless) meshes[parts.part_of[i]].triangles.push_back(triangles[i]);
  UsedVertices used(std::size_t{vertices.width} * vertices.height);
  for (Mesh& mesh : meshes)
    mesh.vertices = selectedRecords(vertices, used.keep(
                                                  mesh.triangles, [](Triangle & face) -> auto& { return face; }));
  return meshes;
}

} // namespace pcl_bsh::io
