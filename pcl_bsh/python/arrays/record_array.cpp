// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/arrays/record_array.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/python/arrays/array_output.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

namespace py = pybind11;
using Field = pcl::PCLPointField;

constexpr std::array<std::pair<std::uint8_t, const char*>, 11> kTypes = {{
    {Field::INT8, "i1"},
    {Field::UINT8, "u1"},
    {Field::INT16, "i2"},
    {Field::UINT16, "u2"},
    {Field::INT32, "i4"},
    {Field::UINT32, "u4"},
    {Field::INT64, "i8"},
    {Field::UINT64, "u8"},
    {Field::FLOAT32, "f4"},
    {Field::FLOAT64, "f8"},
    {Field::BOOL, "u1"}, // PCL's flags are any byte, NumPy's 0 or 1
}};

py::dtype dtypeOf(const pcl::PCLPointCloud2& cloud)
{
  py::list names, formats, offsets;
  for (const Field& field : cloud.fields) {
    if (field.name == "_") continue; // padding
    const auto type = std::find_if(kTypes.begin(), kTypes.end(), [&](auto& t) { return t.first == field.datatype; });
    if (type == kTypes.end()) throw py::value_error("field " + field.name + " has an unknown type");
    names.append(py::str(field.name));
    if (field.count > 1)
      formats.append(py::make_tuple(type->second, field.count));
    else
      formats.append(type->second);
    offsets.append(field.offset);
  }
  py::dict layout;
  layout["names"] = names;
  layout["formats"] = formats;
  layout["offsets"] = offsets;
  layout["itemsize"] = cloud.point_step;
  return py::module_::import("numpy").attr("dtype")(layout).cast<py::dtype>();
}

Field fieldFrom(const std::string& cloud, const std::string& name, py::dtype type, std::uint32_t offset)
{
  Field field;
  field.name = name;
  field.offset = offset;
  field.count = 1;
  if (const py::object inner = type.attr("subdtype"); !inner.is_none()) {
    for (const py::handle extent : type.attr("shape")) field.count *= extent.cast<std::uint32_t>();
    type = inner.cast<py::tuple>()[0].cast<py::dtype>();
  }
  const std::string code = std::string(1, type.kind() == 'b' ? 'u' : type.kind()) + std::to_string(type.itemsize());
  const auto known = std::find_if(kTypes.begin(), kTypes.end(), [&](auto& t) { return t.second == code; });
  if (known == kTypes.end() || (type.byteorder() != '=' && type.byteorder() != '|') || field.count == 0)
    throw InvalidInput(Input::points, cloud,
                       "have a field `" + name + "` of type " + std::string(py::str(py::handle(type))),
                       "give numbers of at most 64 bits in this machine's byte order");
  field.datatype = known->first;
  return field;
}

} // namespace

Records recordsFrom(pcl::PCLPointCloud2&& cloud)
{
  const py::dtype type = dtypeOf(cloud);
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(cloud.width)};
  if (cloud.height > 1) shape.insert(shape.begin(), static_cast<py::ssize_t>(cloud.height));
  const py::array_t<std::uint8_t> bytes = arrayFrom(std::move(cloud.data));
  return py::array(type, std::move(shape), bytes.data(), bytes);
}

pcl::PCLPointCloud2 cloudFrom(const std::string& name, const py::object& records)
{
  const py::module_ numpy = py::module_::import("numpy");
  py::array array = numpy.attr("ascontiguousarray")(records);
  if (!array.dtype().has_fields()) {
    if (array.ndim() != 2 || array.shape(1) != 3)
      throw InvalidInput(Input::points, name, "have shape " + std::string(py::str(array.attr("shape"))),
                         "give records with fields x, y, z, or (n, 3)");
    py::list fields;
    for (const char* const axis : {"x", "y", "z"}) fields.append(py::make_tuple(axis, array.dtype()));
    array = array.attr("view")(numpy.attr("dtype")(fields)).attr("reshape")(-1);
  }
  if (array.ndim() < 1 || array.ndim() > 2)
    throw InvalidInput(Input::points, name, "have " + std::to_string(array.ndim()) + " dimensions",
                       "give (n,), or (height, width) for an organised cloud");
  io::requirePoints(static_cast<std::uint64_t>(array.size()));
  pcl::PCLPointCloud2 cloud;
  const py::dict fields = array.dtype().attr("fields");
  for (const py::handle key : array.dtype().attr("names")) {
    const py::tuple field = fields[key];
    cloud.fields.push_back(fieldFrom(name, py::str(key), field[0].cast<py::dtype>(), field[1].cast<std::uint32_t>()));
  }
  cloud.point_step = static_cast<std::uint32_t>(array.itemsize());
  const bool organised = array.ndim() == 2;
  io::allocate(cloud, static_cast<std::uint32_t>(array.shape(organised ? 1 : 0)),
               organised ? static_cast<std::uint32_t>(array.shape(0)) : 1);
  if (array.nbytes() > 0) std::memcpy(cloud.data.data(), array.data(), static_cast<std::size_t>(array.nbytes()));
  io::setDense(cloud);
  return cloud;
}

} // namespace pcl_bsh::python
