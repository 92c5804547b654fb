// SPDX-License-Identifier: BSD-3-Clause
// Readers and writers of all formats that pcl_bsh/io/clouds reads and writes.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/naming_option.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/text/column_names.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <optional>

namespace pcl_bsh::pipeline {
namespace {

/// The format is told by the extension, so a stage refuses the extensions of others.
void requireExtension(const std::string& file, const std::vector<std::string>& extensions)
{
  if (std::find(extensions.begin(), extensions.end(), io::extensionOf(file)) != extensions.end()) return;
  std::string known;
  for (const std::string& valid : extensions) known += (known.empty() ? "" : " or ") + valid;
  throw OptionError("filename", "is \"" + file + "\": give a " + known + " file, or leave out the type");
}

struct FileReader : Stage {
  InputFile filename;
  std::string unit, to_unit, length_fields, crs, to_crs;
  std::vector<std::string> extensions;

  CloudHeader plan(const std::vector<CloudHeader>&) override
  {
    requireExtension(filename.path, extensions);
    CloudHeader header = io::readCloudHeader(filename.path, settings());
    if (const std::string remark = io::remarkOnColours(header); !remark.empty()) warn(filename.path + ": " + remark);
    return header;
  }

  StageCloudPtr run(StageClouds&&) override
  {
    auto cloud = std::make_shared<StageCloud>();
    io::CloudFacts facts;
    io::Mesh mesh = io::readMeshOrCorners(filename.path, &facts, settings());
    take(facts, *cloud);
    if (!mesh.corners_alone.empty()) cloud->corners_alone = filename.path + ": " + mesh.corners_alone;
    cloud->cloud = std::move(mesh.vertices);
    if (!mesh.triangles.empty())
      cloud->triangles = std::make_shared<const std::vector<Triangle>>(std::move(mesh.triangles));
    return cloud;
  }

protected:
  io::ReadSettings settings() const
  {
    io::ReadSettings settings = settingsOfFormat();
    settings.unit = unitOf("unit", unit);
    settings.to_unit = unitOf("to_unit", to_unit);
    settings.crs = systemOf("crs", crs);
    settings.to_crs = systemOf("to_crs", to_crs);
    for (std::size_t at = 0; at < length_fields.size();) {
      const std::size_t comma = std::min(length_fields.find(',', at), length_fields.size());
      settings.length_fields.push_back(length_fields.substr(at, comma - at));
      at = comma + 1;
    }
    return settings;
  }

  virtual io::ReadSettings settingsOfFormat() const { return {}; }

  void take(const io::CloudFacts& facts, StageCloud& cloud)
  {
    for (const std::string& remark : facts.remarks) warn(filename.path + ": " + remark);
    cloud.viewpoint = facts.viewpoint;
    cloud.scanners = facts.scanners;
    cloud.las_header = facts.las;
    cloud.coordinate_system = facts.coordinate_system.name;
    cloud.system_definition = facts.coordinate_system.definition;
  }

private:
  static std::string systemOf(const char* option, const std::string& text)
  {
    namingOption(option, [&] { io::requireSystem(text); });
    return text;
  }

  static std::optional<io::LengthUnit> unitOf(const char* option, const std::string& name)
  {
    return namingOption(option, [&] { return name.empty() ? std::nullopt : std::optional(io::lengthUnitOf(name)); });
  }
};

/// Columns may have other names than the file says.
struct TextReader : FileReader {
  std::string columns;

protected:
  io::ReadSettings settingsOfFormat() const override
  {
    return namingOption("columns", [&] { return columns.empty() ? io::ColumnNames() : io::columnNamesOf(columns); });
  }
};

/// Files of these formats may hold several scans.
struct ScanReader : FileReader {
  std::optional<int> scan;

protected:
  io::ReadSettings settingsOfFormat() const override { return {io::ColumnNames(), false, number()}; }
  std::optional<std::size_t> number() const
  {
    return scan ? std::optional<std::size_t>(static_cast<std::size_t>(*scan)) : std::nullopt;
  }
};

struct E57Reader : ScanReader {
  bool beams = false;

protected:
  io::ReadSettings settingsOfFormat() const override
  {
    io::ReadSettings settings = ScanReader::settingsOfFormat();
    settings.beams = beams;
    return settings;
  }
};

struct PtxReader : ScanReader {
  bool allow_scale = false;

protected:
  io::ReadSettings settingsOfFormat() const override { return {io::ColumnNames(), allow_scale, number()}; }
};

struct FileWriter : Stage {
  OutputFile filename;
  std::vector<std::string> extensions;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    requireExtension(filename.path, extensions);
    io::requireWritableCloud(filename.path, written(inputs[0]));
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    if (inputs[0]->triangles)
      warn("faces are not written, but to a .ply: " + filename.path + " holds their vertices alone");
    write(*inputs[0]);
    return inputs[0];
  }

protected:
  virtual CloudHeader written(const CloudHeader& cloud) const { return cloud; }
  virtual void write(const StageCloud& cloud)
  {
    io::writeCloud(filename.path, cloud.cloud, cloud.viewpoint, cloud.las_header);
  }
};

/// Writes faces, too, if the cloud has them, with their properties.
struct PlyWriter : FileWriter {
  StageCloudPtr run(StageClouds&& inputs) override
  {
    const StageCloud& mesh = *inputs[0];
    if (!mesh.triangles) return FileWriter::run(std::move(inputs));
    std::vector<io::FaceField> fields;
    for (const FaceProperty& property : mesh.face_properties)
      std::visit([&](const auto& values) { fields.push_back({property.name, &values}); }, property.values);
    io::writeMesh(filename.path, mesh.cloud, *mesh.triangles, fields, mesh.viewpoint);
    return inputs[0];
  }
};

/// Formats without a place for some fields, or for points that are not finite.
struct NarrowWriter : FileWriter {
protected:
  CloudHeader written(const CloudHeader& cloud) const override
  {
    CloudHeader narrow = cloud;
    narrow.fields = fieldsHeld(cloud);
    return narrow;
  }

  void write(const StageCloud& cloud) override
  {
    const std::vector<pcl::PCLPointField> held = fieldsHeld(cloud.cloud);
    const std::string extension = io::extensionOf(filename.path);
    std::string lost;
    for (const pcl::PCLPointField& field : cloud.cloud.fields) {
      const auto is_it = [&](const pcl::PCLPointField& other) { return other.name == field.name; };
      const bool kept = std::any_of(held.begin(), held.end(), is_it);
      if (!kept && field.name != "_") lost += " " + field.name;
    }
    const std::string no_place = (extension == ".obj" ? "an " : "a ") + extension + " has no place for ";
    if (!lost.empty()) warn(no_place + "the fields" + lost + ": they are left out");
    if (extension == ".las" || extension == ".pts") {
      const PointsView points = viewOf(cloud.cloud);
      std::size_t left_out = 0;
      for (std::uint32_t i = 0; i < points.count; ++i)
        if (!isFinite(points.point(i))) ++left_out;
      if (left_out > 0)
        warn(no_place + "points that are not finite: " + std::to_string(left_out) + nounOf(left_out, " is", " are") +
             " left out");
    }
    if (held.size() == cloud.cloud.fields.size()) return FileWriter::write(cloud); // no copy of the points
    io::writeCloud(filename.path, written(cloud.cloud), cloud.viewpoint, cloud.las_header);
  }

private:
  std::vector<pcl::PCLPointField> fieldsHeld(const CloudHeader& cloud) const
  {
    const std::string extension = io::extensionOf(filename.path);
    if (extension == ".obj") return io::fieldsForObj(cloud);
    if (extension == ".pts" || extension == ".ptx") return io::fieldsForScans(cloud, extension == ".ptx");
    return cloud.fields;
  }
};

template <typename S>
StageType ofFiles(const std::string& name, const std::vector<std::string>& extensions, const std::string& doc)
{
  StageDescription<S> description = describe<S>(name, doc);
  description.extensions(extensions)
      .option(&S::filename, "filename",
              std::is_base_of_v<FileWriter, S> ? "the file to write; it appears complete or not at all"
                                               : "the file to read")
      .required();
  if constexpr (std::is_base_of_v<FileReader, S>) {
    const std::string units = io::length_units;
    description
        .option(&S::unit, "unit",
                "the unit of the file's lengths: " + units + "; without it, that of a .las file's coordinate system")
        .option(&S::to_unit, "to_unit",
                "the unit that lengths are read in, as float64; without it, they stay as they are")
        .option(&S::length_fields, "length_fields", "with `to_unit`: more fields that are lengths, as \"sigma,radius\"")
        .option(&S::crs, "crs",
                "the coordinate system of the file, as \"EPSG:25832\" or WKT; \"none\": of no system; without it, as a "
                ".las or .e57 names it")
        .option(
            &S::to_crs, "to_crs",
            "the projected coordinate system that PROJ transforms coordinates to, as float64; without it, they stay "
            "as they are");
  }
  if constexpr (std::is_base_of_v<ScanReader, S>) {
    constexpr bool is_ptx = std::is_same_v<S, PtxReader>;
    description
        .option(&S::scan, "scan",
                is_ptx ? "only that scan, from 0, as an organised cloud; all when it is not given"
                       : "only that scan, from 0; all when it is not given")
        .atLeast(0);
  }
  if constexpr (std::is_same_v<S, E57Reader>) {
    description.option(
        &S::beams, "beams",
        "directions of beams without a return are read, as fields beam_x beam_y beam_z: for seen_beyond");
  }
  if constexpr (std::is_same_v<S, PtxReader>) {
    description.option(
        &S::allow_scale, "allow_scale",
        "the scans' transforms may scale uniformly; they are refused otherwise, and whatever else is no rigid "
        "motion always");
  }
  if constexpr (std::is_same_v<S, TextReader>) {
    description.option(&S::columns, "columns",
                       "the columns' names in place of what the file says, as \"x,y,z,_,intensity\"; _ is not read");
  }
  StageType type = description;
  type.make = [extensions] {
    auto stage = std::make_unique<S>();
    stage->extensions = extensions;
    return stage;
  };
  return type;
}

} // namespace

std::deque<StageType> fileReaders()
{
  StageType mesh = ofFiles<FileReader>(
      "readers.mesh", {".stl", ".obj", ".off", ".ply"},
      "A mesh, .stl, .obj, .off or .ply: its vertices, and its faces, cut into triangles. As the obstacle of a "
      "stage it is a surface, and as the input of filters.bsh_flag and filters.bsh_collision, which ask about its "
      "triangles. Faces go on through stages that keep all points; writers.ply writes them.");
  mesh.extensions = {".stl"}; // the others have readers of their own
  return {ofFiles<FileReader>("readers.pcd", {".pcd"},
                              "PCL's own format, every field in its type, with the sensor's viewpoint."),
          ofFiles<FileReader>("readers.ply", {".ply"},
                              "The vertices of a PLY file and its faces, every property in its type. Renamed are nx ny "
                              "nz (normal_x normal_y normal_z) and uchar red green blue [alpha] (packed as rgb or "
                              "rgba). An element camera gives the sensor's viewpoint."),
          ofFiles<FileReader>("readers.obj", {".obj"},
                              "The vertices of a Wavefront OBJ file, as float64, with their colours packed as rgb and "
                              "their normals, and its "
                              "faces."),
          ofFiles<FileReader>("readers.off", {".off"},
                              "The vertices of an OFF file, as float64, with their normals, and their colours packed "
                              "as rgba or rgb, and its "
                              "faces."),
          std::move(mesh),
          ofFiles<FileReader>(
              "readers.las", {".las", ".laz"},
              "LAS 1.0 to 1.4, point formats 0 to 10, and LAZ, .copc.laz too: x y z as float64, every field and the "
              "extra bytes by their descriptions. Scale, offset and all records, as of the coordinate system, go on to "
              "writers.las."),
          ofFiles<E57Reader>("readers.e57", {".e57"},
                             "E57 (ASTM E2807): x y z as float64, of all scans in their common frame, every value "
                             "but texts, colours packed as rgb, the first scanner's pose as viewpoint; NaN where the "
                             "file says that a point is invalid. Several scans have a field `scan`."),
          ofFiles<FileReader>("readers.pts", {".pts"},
                              "Leica's PTS: x y z as float64, intensity as float32, colours packed as rgb."),
          ofFiles<PtxReader>("readers.ptx", {".ptx"},
                             "Leica's PTX: all scans in their common frame, the scanner's pose as viewpoint, NaN where "
                             "it saw nothing. One scan "
                             "is an organised cloud; several are one row of points with a field `scan`."),
          ofFiles<TextReader>("readers.text", {".txt", ".xyz", ".asc", ".csv"},
                              "A point per line, as float64: x y z and more columns, named by the first line or "
                              "column_4, ...; E N H and the "
                              "like are x y z; columns r g b of whole numbers up to 255 are packed as rgb, nx ny nz "
                              "become normal_x normal_y "
                              "normal_z.")};
}

std::deque<StageType> fileWriters()
{
  return {
      ofFiles<FileWriter>("writers.pcd", {".pcd"}, "PCL's own format, with every field and the viewpoint."),
      ofFiles<PlyWriter>("writers.ply", {".ply"},
                         "Binary PLY, with every field but 64-bit integers; normals are nx ny nz, colours uchar red "
                         "green blue. A mesh is "
                         "written with its faces, as triangles, and what filters.bsh_flag found of them."),
      ofFiles<NarrowWriter>("writers.las", {".las", ".laz"},
                            "LAS, and LAZ where LASzip is, as its input file was: version, point format, scale, offset "
                            "and all records; without "
                            "one LAS 1.4, the scale by "
                            "the cloud's extent. Other fields, as `collision`, are extra bytes with a description. "
                            "Points that are not finite "
                            "are left out, with a warning."),
      ofFiles<NarrowWriter>("writers.pts", {".pts"},
                            "Leica's PTS: x y z, intensity, rgb. Points that are not finite are left out; warnings "
                            "name lost points and fields."),
      ofFiles<NarrowWriter>("writers.ptx", {".ptx"},
                            "Leica's PTX: x y z, intensity, rgb, the viewpoint as the scanner's pose; NaN is no "
                            "return, a field `scan` parts several scans. A warning names lost fields."),
      ofFiles<NarrowWriter>("writers.obj", {".obj"},
                            "Wavefront OBJ: vertices with their colours and normals; a warning names lost fields."),
      ofFiles<FileWriter>("writers.text", {".txt", ".xyz", ".asc", ".csv"},
                          "A line that names the fields, then a point per line; colours are columns r g b. A .csv "
                          "has commas between values, others blanks.")};
}

} // namespace pcl_bsh::pipeline
