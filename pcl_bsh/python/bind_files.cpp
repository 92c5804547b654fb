// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/record_array.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

#include <pybind11/stl.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace pcl_bsh::python {
namespace {

constexpr auto kRead = R"(The points of a file as a structured array, every field in its type.

Parameters
----------
path : str or path-like
    .pcd, .ply, .las, .laz, .e57, .pts, .ptx, .csv, .xyz, .asc, .txt, .obj, .off or .stl.
columns : sequence of str, optional
    Names of all columns of .csv, .xyz, .asc and .txt, in place of those in the file, ``["x", "y", "z", "_"]``; "_" is not
    read.
)";

constexpr auto kReadArguments = R"(threads : int, default 0
    Threads that unpack LAZ; 0: all of the machine's. Any number gives the same result.
allow_scale : bool, default False
    Transforms of a .ptx may scale uniformly; else they are refused, and whatever else is no rigid motion always.
unit : str, optional
    Unit of the file's lengths: mm, cm, m, ft or us-ft. Default: that of a LAS file's coordinate system.
to_unit : str, optional
    Unit that lengths are converted to, as float64. Default: they stay as they are.
length_fields : sequence of str, optional
    With `to_unit`: more fields that are lengths, such as sigmas.
crs : str, optional
    Coordinate system of the file, as "EPSG:25832" or WKT; "none": of no system. Default: as a LAS or E57 file names it.
to_crs : str, optional
    Projected system that PROJ transforms coordinates to, as float64. Default: they stay as they are.
)";

constexpr auto kReadResult = R"(
Returns
-------
ndarray, (n,), of an organised cloud (height, width)
    Fields x, y, z (float32 or float64), and others by PCL's names: normal_x, intensity, rgb (packed) ...
    `SphereHierarchy` takes it as it is.

Raises
------
FileError
    A ValueError and an OSError: missing, unreadable, malformed, truncated, without x y z.

Warns
-----
UserWarning
    Facts that were taken for granted, as of columns without names, and records that a LAS header does not count.

See Also
--------
read_with_header : the viewpoint, and what a LAS file says beside its points, too.
)";

constexpr auto kReadWithHeader = R"(As `read`, and what the file says beside its points.

Returns
-------
records : ndarray
header : FileHeader
    `viewpoint` (tx, ty, tz, qw, qx, qy, qz); of LAS files `coordinate_system`, its name, and scale, offset and all
    records, which `write` keeps.
)";

constexpr auto kWrite = R"(Writes a cloud; the file appears complete or not at all.

Parameters
----------
path : str or path-like
    .pcd, .ply, .las, .csv, .xyz, .asc, .txt or .obj.
records : ndarray
    Structured with fields x, y, z: (n,), or (height, width) for an organised cloud. Or (n, 3).
header : FileHeader, optional
    The one that `read_with_header` returned.

Raises
------
FileError
    Where the disk says no, or the format cannot hold a field.

Examples
--------
>>> import numpy as np, pcl_bsh, tempfile, os
>>> cloud = np.zeros(2, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4"), ("hit", "u1")])
>>> cloud["hit"] = [0, 1]
>>> with tempfile.TemporaryDirectory() as folder:
...     pcl_bsh.write(os.path.join(folder, "cloud.ply"), cloud)
...     pcl_bsh.read(os.path.join(folder, "cloud.ply"))["hit"]
array([0, 1], dtype=uint8)
)";

constexpr auto kReadMesh = R"(The vertices and faces of a mesh, for `SphereHierarchy.of_triangles`.

Parameters
----------
path : str or path-like
    .obj, .off, .ply or .stl; polygons are cut into triangles. Other formats have no triangles. Lines, edges and
    free-form surfaces are warned of; a file of these without faces is refused: `read` gives its vertices.
)";

constexpr auto kReadMeshResult = R"(
Returns
-------
vertices : ndarray
    Structured, as `read`.
triangles : ndarray of uint32, (t, 3)
)";

constexpr auto kReadMeshParts =
    R"(The named parts of a mesh file, each as `read_mesh` gives a whole: objects or groups of an .obj, solids of a text .stl.

An .obj with objects (o) has these as parts, and one without has its groups (g). Faces without a name and names without
faces are left out, with a warning.

Parameters
----------
path : str or path-like
    .obj, or an .stl that is text.
unit : str, optional
    Unit of the file's lengths: mm, cm, m, ft or us-ft.
to_unit : str, optional
    Unit that lengths are converted to, as float64. Default: they stay as they are.

Returns
-------
dict of str to (vertices, triangles)
    In the order of the file.

Raises
------
FileError
    As `read_mesh`; a file without named faces, and two objects or solids of one name.

Examples
--------
>>> import pcl_bsh, tempfile, os
>>> with tempfile.TemporaryDirectory() as folder:
...     path = os.path.join(folder, "plant.obj")
...     with open(path, "w") as file:
...         _ = file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\no press\nf 1 2 3\no mill\nf 4 2 3\n")
...     parts = pcl_bsh.read_mesh_parts(path)
>>> machines = {name: pcl_bsh.SphereHierarchy.of_triangles(*mesh) for name, mesh in parts.items()}
>>> list(machines)
['press', 'mill']
)";

using FileHeader = io::CloudFacts;
using Text = std::optional<std::string>;
using Texts = std::optional<std::vector<std::string>>;

/// How a file is read, by the arguments that readers share.
io::ReadSettings readSettings(const std::optional<io::ColumnNames>& columns, bool allow_scale, const Text& unit,
                              const Text& to_unit, const Texts& length_fields, const Text& crs, const Text& to_crs)
{
  io::ReadSettings settings(columns.value_or(io::ColumnNames()), allow_scale);
  const auto unitOf = [](const char* argument, const Text& name) {
    try {
      return name ? std::optional(io::lengthUnitOf(*name)) : std::nullopt;
    }
    catch (const std::runtime_error& error) {
      throw py::value_error(std::string(argument) + ": " + error.what() + ": give " + io::length_units);
    }
  };
  settings.unit = unitOf("unit", unit);
  settings.to_unit = unitOf("to_unit", to_unit);
  settings.length_fields = length_fields.value_or(std::vector<std::string>());
  const auto systemOf = [](const char* argument, const Text& text) {
    try {
      io::requireSystem(text.value_or(""));
    }
    catch (const io::FormatError& error) {
      throw py::value_error(std::string(argument) + ": " + error.what() + ": " + error.remedy());
    }
    return text.value_or("");
  };
  settings.crs = systemOf("crs", crs);
  settings.to_crs = systemOf("to_crs", to_crs);
  return settings;
}

std::pair<Records, FileHeader> readWithHeader(const PathLike& path, const std::optional<io::ColumnNames>& columns,
                                              unsigned threads, bool allow_scale, const Text& unit, const Text& to_unit,
                                              const Texts& length_fields, const Text& crs, const Text& to_crs)
{
  const std::string file = pathOf(path);
  FileHeader header;
  const io::ReadSettings settings = readSettings(columns, allow_scale, unit, to_unit, length_fields, crs, to_crs);
  pcl::PCLPointCloud2 cloud = unlocked([&] { return io::readCloud(file, &header, settings, threads); });
  for (const std::string& remark : header.remarks) warn(file + ": " + remark);
  return {recordsFrom(std::move(cloud)), std::move(header)};
}

void writeRecords(const PathLike& path, const As<"npt.NDArray[Any]">& records, const FileHeader* header)
{
  const std::string file = pathOf(path);
  const pcl::PCLPointCloud2 cloud = cloudFrom("records", records);
  const FileHeader none;
  const FileHeader& kept = header ? *header : none;
  unlocked([&] { io::writeCloud(file, cloud, kept.viewpoint, kept.las); });
}

/// The vertices and triangles of a mesh.
std::pair<Records, py::array_t<std::uint32_t>> arraysOfMesh(io::Mesh&& mesh)
{
  py::array_t<std::uint32_t> triangles({static_cast<py::ssize_t>(mesh.triangles.size()), py::ssize_t{3}});
  std::uint32_t* corner = triangles.mutable_data();
  for (const Triangle& triangle : mesh.triangles) corner = std::copy(triangle.begin(), triangle.end(), corner);
  return {recordsFrom(std::move(mesh.vertices)), triangles};
}

std::pair<Records, py::array_t<std::uint32_t>> readMeshOf(const PathLike& path, unsigned threads, bool allow_scale,
                                                          const Text& unit, const Text& to_unit,
                                                          const Texts& length_fields, const Text& crs,
                                                          const Text& to_crs)
{
  const std::string file = pathOf(path);
  FileHeader header;
  const io::ReadSettings settings = readSettings({}, allow_scale, unit, to_unit, length_fields, crs, to_crs);
  io::Mesh mesh = unlocked([&] { return io::readMesh(file, &header, settings, threads); });
  for (const std::string& remark : header.remarks) warn(file + ": " + remark);
  return arraysOfMesh(std::move(mesh));
}

As<"Dict[str, Tuple[npt.NDArray[Any], npt.NDArray[np.uint32]]]"> readMeshPartsOf(const PathLike& path, const Text& unit,
                                                                                 const Text& to_unit)
{
  const std::string file = pathOf(path);
  FileHeader header;
  const io::ReadSettings settings = readSettings({}, false, unit, to_unit, std::nullopt, std::nullopt, std::nullopt);
  io::MeshParts parts;
  std::vector<io::Mesh> meshes = unlocked([&] {
    parts = io::readMeshParts(file);
    const io::Mesh whole = io::readMesh(file, &header, settings);
    return io::meshesOf(parts, whole.vertices, whole.triangles);
  });
  for (const auto* const remarks : {&parts.remarks, &header.remarks})
    for (const std::string& remark : *remarks) warn(file + ": " + remark);
  py::dict found;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    found[py::str(parts.names[i])] = py::cast(arraysOfMesh(std::move(meshes[i])));
  return {found};
}

} // namespace

void bindFiles(py::module_& module)
{
  const py::tuple bases = py::make_tuple(py::handle(PyExc_OSError), py::handle(PyExc_ValueError));
  py::register_exception<files::FileError>(module, "FileError", bases).attr("__doc__") =
      "A file that cannot be read or written, in one line: path, what is wrong, what to do.";
  py::class_<FileHeader>(module, "FileHeader", "Facts in a file beside its points.")
      .def_property_readonly(
          "viewpoint",
          [](const FileHeader& header) { return As<"Tuple[float, ...]">(py::tuple(py::cast(header.viewpoint))); },
          "Where the sensor stood: tx, ty, tz, qw, qx, qy, qz.")
      .def_property_readonly(
          "coordinate_system", [](const FileHeader& header) { return header.coordinate_system.name; },
          "As a LAS or E57 file names it, or as it was given; empty where nobody tells.")
      .def_property_readonly(
          "unit", [](const FileHeader& header) { return header.unit ? Text(io::nameOf(*header.unit)) : std::nullopt; },
          "The unit of lengths, as was given or by the coordinate system; None where nobody tells.")
      .def_property_readonly("is_las", [](const FileHeader& header) { return header.las != nullptr; })
      .def("__repr__", [](const FileHeader& header) { return header.las ? "FileHeader(las)" : "FileHeader()"; });
  const auto define = [&](const char* name, auto function, const std::string& text, const auto&... first) {
    module.def(name, function, text.c_str(), "path"_a, first..., "threads"_a = 0, "allow_scale"_a = false,
               "unit"_a = py::none(), "to_unit"_a = py::none(), "length_fields"_a = py::none(), "crs"_a = py::none(),
               "to_crs"_a = py::none());
  };
  define(
      "read",
      [](const PathLike& path, const std::optional<io::ColumnNames>& columns, unsigned threads, bool allow_scale,
         const Text& unit, const Text& to_unit, const Texts& length_fields, const Text& crs, const Text& to_crs) {
        return readWithHeader(path, columns, threads, allow_scale, unit, to_unit, length_fields, crs, to_crs).first;
      },
      std::string(kRead) + kReadArguments + kReadResult, "columns"_a = py::none(), py::kw_only());
  define("read_with_header", &readWithHeader, kReadWithHeader, "columns"_a = py::none(), py::kw_only());
  define("read_mesh", &readMeshOf, std::string(kReadMesh) + kReadArguments + kReadMeshResult, py::kw_only());
  module.def("read_mesh_parts", &readMeshPartsOf, kReadMeshParts, "path"_a, py::kw_only(), "unit"_a = py::none(),
             "to_unit"_a = py::none());
  module.def("write", &writeRecords, kWrite, "path"_a, "records"_a, "header"_a = py::none());
}

} // namespace pcl_bsh::python
