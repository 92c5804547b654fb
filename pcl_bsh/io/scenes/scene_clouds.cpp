// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/scenes/scene_clouds.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {
namespace {

constexpr double kMostPoints = 1e8; // of a shape

void parseUncertainty(const JsonReader& reader, CloudSource& cloud)
{
  const bool of_field = reader.has("uncertainty") && reader.at("uncertainty").json().is_string();
  double sigmas = 1.0;
  read(reader, "sigmas", sigmas);
  const auto withPose = [&](Uncertainty uncertainty) {
    try {
      if (reader.has("pose_uncertainty"))
        uncertainty.pose = PoseUncertainty::parse(reader.at("pose_uncertainty").text());
    }
    catch (const InvalidInput& error) {
      reader.at("pose_uncertainty").fail(error.wrong(), error.remedy());
    }
    return uncertainty;
  };
  if (!of_field) {
    if (reader.has("sigmas"))
      reader.at("sigmas").fail("is given, but the uncertainty is no field", "give the length itself");
    read(reader, "uncertainty", cloud.uncertainty.length);
    cloud.uncertainty = withPose(cloud.uncertainty);
    return;
  }
  if (!cloud.shape.empty())
    reader.at("uncertainty").fail("names a field, which a " + cloud.shape + " does not have", "give a length");
  cloud.uncertainty = withPose({reader.at("uncertainty").text(), sigmas * cloud.scale});
}

void parseSurface(const JsonReader& reader, CloudSource& cloud)
{
  for (const auto& [key, what] :
       {std::pair{"vertices_only", "faces"}, {"columns", "files"}, {"allow_scale", "files"}}) {
    if (reader.has(key) && !cloud.shape.empty())
      reader.at(key).fail(std::string("is about ") + what + ", and a " + cloud.shape + " is points", "leave it out");
  }
  if (reader.has("columns")) {
    try {
      cloud.columns = columnNamesOf(reader.at("columns").text());
    }
    catch (const FormatError& error) {
      reader.at("columns").fail(error.what(), error.remedy());
    }
  }
  read(reader, "allow_scale", cloud.allow_scale);
  read(reader, "vertices_only", cloud.surface.vertices_only);
}

void parseShape(const JsonReader& reader, CloudSource& cloud)
{
  const JsonReader shape = reader.at(cloud.shape.c_str());
  if (cloud.shape == "sphere") {
    cloud.size.setConstant(shape.at("radius").number());
  }
  else if (cloud.shape == "box") {
    cloud.size = shape.at("size").vector();
  }
  else {
    bool open = false;
    read(shape, "open", open);
    cloud.size = {shape.at("radius").number(), shape.at("height").number(), open ? 1.0 : 0.0};
  }
  read(reader, "spacing", cloud.spacing);
  if (!(shapePointCount(cloud.shape, cloud.size, cloud.spacing) <= kMostPoints))
    reader.fail("would have more than 1e8 points", "give a larger 'spacing'");
}

constexpr double kPi = 3.14159265358979323846;

void add(std::vector<float>& xyz, double x, double y, double z)
{
  for (const double coordinate : {x, y, z}) xyz.push_back(static_cast<float>(coordinate));
}

/// Fibonacci's spiral: evenly spread.
void addSphere(std::vector<float>& xyz, double radius, double spacing)
{
  const double steps = radius / spacing;
  const auto count = static_cast<std::size_t>(std::ceil(4.0 * kPi * steps * steps)) + 2;
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z), angle = golden * static_cast<double>(i);
    add(xyz, radius * r * std::cos(angle), radius * r * std::sin(angle), radius * z);
  }
}

void addBox(std::vector<float>& xyz, const Eigen::Vector3d& size, double spacing)
{
  int cells[3];
  for (int k = 0; k < 3; ++k) cells[k] = std::max(1, static_cast<int>(std::ceil(size[k] / spacing)));
  for (int i = 0; i <= cells[0]; ++i)
    for (int j = 0; j <= cells[1]; ++j)
      for (int k = 0; k <= cells[2]; ++k) {
        if (i != 0 && i != cells[0] && j != 0 && j != cells[1] && k != 0 && k != cells[2]) {
          k = cells[2] - 1; // inside: on to the next that is not
          continue;
        }
        add(xyz, size[0] * (double(i) / cells[0] - 0.5), size[1] * (double(j) / cells[1] - 0.5),
            size[2] * (double(k) / cells[2] - 0.5));
      }
}

/// The mantle, and both lids unless it is open.
void addCylinder(std::vector<float>& xyz, double radius, double height, bool open, double spacing)
{
  const auto ring = [&](double r, double z) {
    const int count = std::max(1, static_cast<int>(std::ceil(2.0 * kPi * r / spacing)));
    for (int i = 0; i < count; ++i)
      add(xyz, r * std::cos(2.0 * kPi * i / count), r * std::sin(2.0 * kPi * i / count), z);
  };
  const int rows = std::max(1, static_cast<int>(std::ceil(height / spacing)));
  for (int k = 0; k <= rows; ++k) ring(radius, height * (double(k) / rows - 0.5));
  if (open) return;
  const int rings = static_cast<int>(std::ceil(radius / spacing));
  for (int k = 0; k < rings; ++k)
    for (const double z : {-0.5 * height, 0.5 * height}) ring(radius * k / rings, z);
}

} // namespace

std::vector<float> shapePoints(const std::string& shape, const Eigen::Vector3d& size, double spacing)
{
  std::vector<float> xyz;
  if (shape == "sphere") addSphere(xyz, size[0], spacing);
  if (shape == "box") addBox(xyz, size, spacing);
  if (shape == "cylinder") addCylinder(xyz, size[0], size[1], size[2] > 0.0, spacing);
  return xyz;
}

double shapePointCount(const std::string& shape, const Eigen::Vector3d& size, double spacing)
{
  const Eigen::Array3d n = size.array() / spacing + 2.0;
  if (shape == "sphere") return 4.0 * kPi * n[0] * n[0];
  if (shape == "box") return 2.0 * (n[0] * n[1] + n[1] * n[2] + n[0] * n[2]);
  return 2.0 * kPi * n[0] * (n[1] + n[0]);
}

void read(const JsonReader& object, const char* key, std::optional<double>& value)
{
  if (object.has(key)) value = object.at(key).number();
}

std::filesystem::path existingFile(const JsonReader& reader, const std::filesystem::path& folder)
{
  const std::filesystem::path given = reader.text();
  const std::filesystem::path file = given.is_absolute() ? given : folder / given;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) reader.fail("no such file: " + file.string(), "check the name");
  if (std::filesystem::is_directory(file, error)) reader.fail(file.string() + " is a folder", "name a file");
  return file;
}

CloudSource cloudFrom(const JsonReader& reader, const std::string& name, const std::filesystem::path& folder)
{
  CloudSource cloud;
  cloud.name = name;
  cloud.place = reader.place();
  if (reader.json().is_string()) {
    cloud.file = existingFile(reader, folder);
  }
  else {
    for (const char* shape : {"sphere", "box", "cylinder"})
      if (reader.has(shape)) {
        if (!cloud.shape.empty()) reader.fail("is both a " + cloud.shape + " and a " + shape, "give one of them");
        cloud.shape = shape;
      }
    if (cloud.shape.empty() == !reader.has("file"))
      reader.fail("is neither or both of a file and a shape", "give 'file', 'sphere', 'box' or 'cylinder'");
    if (reader.has("file")) cloud.file = existingFile(reader.at("file"), folder);
    read(reader, "scale", cloud.scale);
    read(reader, "shift", cloud.shift);
    parseSurface(reader, cloud);
    if (!cloud.shape.empty()) parseShape(reader, cloud);
    parseUncertainty(reader, cloud);
  }
  return cloud;
}

} // namespace pcl_bsh::io
