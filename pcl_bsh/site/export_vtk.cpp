// SPDX-License-Identifier: BSD-3-Clause
// VTK's XML file formats: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/new_file.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/export_vtk.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <sstream>
#include <type_traits>

namespace pcl_bsh::site {

namespace fs = std::filesystem;

namespace {

std::string escapedForXml(const std::string& text)
{
  std::string xml;
  for (const char c : text) {
    switch (c) {
    case '&':
      xml += "&amp;";
      break;
    case '<':
      xml += "&lt;";
      break;
    case '>': // VTK's reader ends an element at it, wherever it is
      xml += "&gt;";
      break;
    case '"':
      xml += "&quot;";
      break;
    default:
      xml += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return xml;
}

std::string vtkTypeOf(std::uint8_t datatype)
{
  return io::withFieldType(datatype, [](auto value) -> std::string {
    using Value = decltype(value);
    const std::string bits = std::to_string(8 * sizeof value);
    return (std::is_floating_point_v<Value> ? "Float" : std::is_signed_v<Value> ? "Int" : "UInt") + bits;
  });
}

std::string describe(const std::string& type, const std::string& name, std::uint32_t components)
{
  return "type=\"" + type + "\" Name=\"" + escapedForXml(name) + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\"";
}

std::string describePoints(const Fields& fields)
{
  return describe(vtkTypeOf(findField(fields, "x")->datatype), "Points", 3);
}

std::string describe(const pcl::PCLPointField& field)
{
  return describe(vtkTypeOf(field.datatype), field.name, field.count);
}

std::string inBase64(const std::string& bytes)
{
  using namespace boost::archive::iterators;
  using Letters = base64_from_binary<transform_width<const char*, 6, 8>>;
  std::string text(Letters(bytes.data()), Letters(bytes.data() + bytes.size()));
  text.append((3 - bytes.size() % 3) % 3, '=');
  return text;
}

/// Writes the arrays of a tile one after the other into a file. Memory holds the tile, and only the array that is being
/// written.
class PieceWriter {
public:
  PieceWriter(const pcl::PCLPointCloud2& cloud, files::NewFile& file) : cloud_(cloud), file_(file)
  {
    const PointsView view = viewOf(cloud);
    for (std::uint32_t i = 0; i < view.count; ++i)
      if (isFinite(view.point(i))) points_.push_back(i);
  }

  void write()
  {
    const std::string count = std::to_string(points_.size());
    file_.append("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                 "header_type=\"UInt64\">\n  <PolyData>\n    <Piece NumberOfPoints=\"" +
                 count + "\" NumberOfVerts=\"" + (points_.empty() ? "0" : "1") +
                 "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n      <Points>\n");
    writeArray(describePoints(cloud_.fields), valuesOf({axis("x"), axis("y"), axis("z")}));
    file_.append("      </Points>\n      <PointData>\n");
    for (const auto& field : cloud_.fields)
      if (!isAxis(field.name)) writeArray(describe(field), valuesOf({field}));
    file_.append("      </PointData>\n      <Verts>\n");
    std::vector<std::int64_t> numbers(points_.size());
    std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
    writeArray(describe("Int64", "connectivity", 1), bytesOf(numbers));
    const auto end = static_cast<std::int64_t>(points_.size());
    writeArray(describe("Int64", "offsets", 1), points_.empty() ? "" : bytesOf({end}));
    file_.append("      </Verts>\n    </Piece>\n  </PolyData>\n</VTKFile>\n");
  }

private:
  const pcl::PCLPointField& axis(const char* name) const { return *findField(cloud_, name); }

  /// Writes an array in base64, with its size before it. Raw bytes behind the document would be a quarter less, but
  /// expat refuses them since its corrections of 2024.
  void writeArray(const std::string& description, const std::string& bytes)
  {
    file_.append("        <DataArray " + description + " format=\"binary\">\n");
    file_.append(inBase64(bytesOf({static_cast<std::int64_t>(bytes.size())})));
    file_.append(inBase64(bytes));
    file_.append("\n        </DataArray>\n");
  }

  static std::string bytesOf(const std::vector<std::int64_t>& numbers)
  {
    std::string bytes(8 * numbers.size(), '\0');
    if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
  }

  /// The values of some fields, point by point.
  std::string valuesOf(const std::vector<pcl::PCLPointField>& fields) const
  {
    std::string bytes;
    for (const std::uint32_t i : points_) {
      const auto* const record = reinterpret_cast<const char*>(cloud_.data.data()) + std::size_t{i} * cloud_.point_step;
      for (const auto& field : fields) bytes.append(record + field.offset, io::sizeOf(field));
    }
    return bytes;
  }

  const pcl::PCLPointCloud2& cloud_;
  files::NewFile& file_;
  std::vector<std::uint32_t> points_; ///< the finite ones
};

/// The document that lists the pieces.
std::string listOfPieces(const Site& site, const std::vector<std::string>& pieces)
{
  std::ostringstream xml;
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n  <PPolyData GhostLevel=\"0\">\n    <PPoints>\n      <PDataArray "
      << describePoints(site.fields) << "/>\n    </PPoints>\n    <PPointData>\n";
  for (const auto& field : site.fields)
    if (!isAxis(field.name)) xml << "      <PDataArray " << describe(field) << "/>\n";
  xml << "    </PPointData>\n";
  for (const std::string& piece : pieces) xml << "    <Piece Source=\"" << escapedForXml(piece) << "\"/>\n";
  xml << "  </PPolyData>\n</VTKFile>\n";
  return xml.str();
}

} // namespace

void exportPieces(const Site& site, const fs::path& file,
                  const std::function<bool(std::uint64_t, std::uint64_t)>& progress)
{
  const fs::path folder = file.parent_path() / file.stem();
  std::error_code error;
  if (fs::exists(folder, error) && !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw files::FileError(folder, "is in the way of the folder for the pieces", "name another file, or move it away");
  files::FileReplacement document(file);
  const files::OutputFolder made(folder);
  std::vector<std::unique_ptr<files::NewFile>> written;
  std::vector<std::string> pieces;
  std::uint64_t done = 0;
  pcl::PCLPointCloud2 cloud;
  for (const Tile& tile : site.tiles) {
    const std::string name = fs::path(tileFileName(pieces.size())).stem().string() + ".vtp";
    written.push_back(std::make_unique<files::NewFile>(folder / name));
    pieces.push_back(folder.filename().string() + "/" + name);
    cloud = readTile(site, tile, std::move(cloud));
    PieceWriter(cloud, *written.back()).write();
    if (progress && !progress(done += tile.points, site.points)) throw Cancelled();
  }
  document.stream() << listOfPieces(site, pieces);
  document.commit([&] {
    for (const auto& piece : written) piece->keep();
  });
}

} // namespace pcl_bsh::site
