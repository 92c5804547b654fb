// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/arrays/array_input.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/python/arrays/array_layout.h>
#include <pcl_bsh/question/uncertainty.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::python {
namespace {

py::array doublesOf(const std::string& name, const py::object& object, Input input)
{
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  Doubles array = Doubles::ensure(object);
  if (!array) throw InvalidInput(input, name, "are no numbers", "give an array of float64");
  return array;
}

Eigen::Isometry3d poseFromRows(const std::string& name, const double* rows, py::ssize_t row_count)
{
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.affine() = Eigen::Map<const Rows>(rows);
  if (row_count == 4 && !(rows[12] == 0.0 && rows[13] == 0.0 && rows[14] == 0.0 && rows[15] == 1.0))
    throw InvalidInput(Input::pose, name, "has a last row other than 0 0 0 1",
                       "give a rigid transform, (4, 4) or (3, 4)");
  return pose;
}

/// The view with a pose's uncertainty added. arraysOf() still finds its arrays.
PointsView withPose(const PointsView& view, const std::string& name, const PoseUncertainty& pose)
{
  if (pose.isZero()) return view;
  Uncertainty of_pose;
  of_pose.pose = pose;
  PointsView uncertain = withUncertainty(view, {}, name, of_pose);
  uncertain.owner = std::shared_ptr<const void>(uncertain.owner, view.owner.get());
  return uncertain;
}

bool isPoseShape(const py::array& array, py::ssize_t first)
{
  return (array.shape(first) == 3 || array.shape(first) == 4) && array.shape(first + 1) == 4;
}

/// The view of the points, without what the pose's uncertainty adds.
PointsView keptViewOf(const std::string& name, const PointsInput& input)
{
  auto kept = makeOwner<KeptArrays>();
  kept->points = asArray(name, input.xyz);
  const bool converted = !kept->points.is(input.xyz) && kept->points.owndata();
  PointsView view = viewOfArray(name, kept->points, input.copy, kept->in_place);
  if (converted) kept->in_place = false;
  kept->keep(kept->points);
  const auto floats = [&](const char* what, const py::object& values) -> const float* {
    if (values.is_none()) return nullptr;
    py::array array = floatsOf(what, values, view.count);
    if (input.copy) array = array.attr("copy")();
    return static_cast<const float*>(kept->keep(array));
  };
  view.radii = floats("radii", input.radii);
  kept->uncertainty = view.uncertainty = input.uncertainty;
  kept->uncertainties = view.uncertainties = floats("uncertainties", input.uncertainties);
  kept->pose = input.pose;
  if (!input.indices.is_none()) {
    const std::vector<std::uint32_t> records = recordsOf("indices", input.indices, 1);
    py::array_t<std::int32_t> own(static_cast<py::ssize_t>(records.size()));
    std::transform(records.begin(), records.end(), own.mutable_data(), [](std::uint32_t record) {
      return static_cast<std::int32_t>(std::min<std::uint32_t>(record, std::numeric_limits<std::int32_t>::max()));
    });
    view.restrictTo(static_cast<const std::int32_t*>(kept->keep(own)), records.size());
  }
  view.owner = std::shared_ptr<const void>(kept, static_cast<const Owner*>(kept.get()));
  return view;
}

} // namespace

const void* KeptArrays::keep(const py::array& array)
{
  locks_.push_back(std::make_unique<ArrayLock>(array));
  return array.data();
}

int KeptArrays::traverse(visitproc visit, void* arg) const
{
  std::vector<PyObject*> references;
  if (points) references.push_back(points.ptr());
  for (const auto& lock : locks_) lock->addReferences(references);
  // Arrays do not tell the collector of their bases. If all references to an array are ours, so is its own reference to
  // its base.
  const bool tell_themselves = PyType_HasFeature(py::detail::npy_api::get().PyArray_Type_, Py_TPFLAGS_HAVE_GC);
  for (std::size_t i = 0; i < references.size() && !tell_themselves; ++i) {
    PyObject* const array = references[i];
    const auto here = references.begin() + static_cast<std::ptrdiff_t>(i);
    if (!py::isinstance<py::array>(array) || std::find(references.begin(), here, array) != here) continue;
    if (Py_REFCNT(array) != std::count(here, references.end(), array)) continue;
    if (PyObject* const base = py::detail::array_proxy(array)->base) references.push_back(base);
  }
  for (PyObject* const reference : references) Py_VISIT(reference);
  return 0;
}

PointsView viewOfPoints(const std::string& name, const PointsInput& input)
{
  return withPose(keptViewOf(name, input), name, input.pose);
}

PointsView viewOfTriangles(const PointsInput& vertices, std::vector<Triangle> triangles)
{
  const PointsView corners = keptViewOf("vertices", vertices);
  PointsView view = viewOf(trianglesOf(corners, std::make_shared<const std::vector<Triangle>>(std::move(triangles))));
  view.owner = std::shared_ptr<const void>(view.owner, corners.owner.get()); // arraysOf() finds the arrays
  return withPose(view, "triangles", vertices.pose);
}

const KeptArrays* arraysOf(const PointsView& view)
{
  return dynamic_cast<const KeptArrays*>(static_cast<const Owner*>(view.owner.get()));
}

MovedView movedView(const PointsView& before, PointsInput input)
{
  const KeptArrays& given = *arraysOf(before);
  input.uncertainty = given.uncertainty;
  input.pose = given.pose;
  if (before.triangles) {
    if (!input.radii.is_none() || !input.uncertainties.is_none())
      throw InvalidInput(Input::points, input.radii.is_none() ? "uncertainties" : "radii", "are those of points",
                         "leave them out for triangles");
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < before.triangles->count; ++i)
      triangles.push_back(before.triangles->cornersOf(static_cast<std::uint32_t>(i)));
    return {before, viewOfTriangles(input, std::move(triangles))};
  }
  // Copies: the arrays of `before` end when the hierarchy gets its new view.
  const auto stays = [&](py::object& now, const float* values) {
    if (now.is_none() && values) now = py::array_t<float>(static_cast<py::ssize_t>(before.count), values);
  };
  stays(input.radii, before.radii);
  stays(input.uncertainties, given.uncertainties);
  if (before.indices)
    input.indices = py::array_t<std::int32_t>(static_cast<py::ssize_t>(before.index_count), before.indices);
  return {before, viewOfPoints("points", input)};
}

PointsView viewForCall(const std::string& name, const py::object& xyz, py::array& kept)
{
  kept = asArray(name, xyz);
  bool in_place = false;
  return viewOfArray(name, kept, false, in_place);
}

Eigen::Isometry3d poseOf(const std::string& name, const py::object& pose)
{
  if (pose.is_none()) return Eigen::Isometry3d::Identity();
  const py::array array = doublesOf(name, pose, Input::pose);
  if (array.ndim() != 2 || !isPoseShape(array, 0))
    throw InvalidInput(Input::pose, name, "has shape " + shapeOf(array), "give a rigid transform, (4, 4) or (3, 4)");
  return poseFromRows(name, static_cast<const double*>(array.data()), array.shape(0));
}

std::vector<Eigen::Isometry3d> posesOf(const std::string& name, const py::object& poses)
{
  const py::array array = doublesOf(name, poses, Input::pose);
  if (array.ndim() != 3 || !isPoseShape(array, 1))
    throw InvalidInput(Input::pose, name, "have shape " + shapeOf(array),
                       "give rigid transforms, (m, 4, 4) or (m, 3, 4)");
  std::vector<Eigen::Isometry3d> list;
  list.reserve(static_cast<std::size_t>(array.shape(0)));
  const auto* rows = static_cast<const double*>(array.data());
  for (py::ssize_t i = 0; i < array.shape(0); ++i, rows += 4 * array.shape(1))
    list.push_back(poseFromRows(name + "[" + std::to_string(i) + "]", rows, array.shape(1)));
  return list;
}

PoseUncertainty poseUncertaintyOf(const py::object& uncertainty)
{
  if (uncertainty.is_none()) return {};
  if (py::isinstance<py::str>(uncertainty)) return PoseUncertainty::parse(py::str(uncertainty));
  const py::array numbers = doublesOf("pose_uncertainty", uncertainty, Input::uncertainty).attr("reshape")(-1);
  std::string text;
  for (const py::handle number : numbers) text += (text.empty() ? "" : ",") + std::string(py::str(number));
  return PoseUncertainty::parse(text);
}

Point3 point3Of(const std::string& name, const py::object& point)
{
  const py::array array = doublesOf(name, point, Input::points);
  if (array.ndim() != 1 || array.shape(0) != 3)
    throw InvalidInput(Input::points, name, "has shape " + shapeOf(array), "give three coordinates");
  const auto* p = static_cast<const double*>(array.data());
  return {p[0], p[1], p[2]};
}

Eigen::Vector3d vectorOf(const std::string& name, const py::object& vector)
{
  const Point3 p = point3Of(name, vector);
  return {p[0], p[1], p[2]};
}

Accuracy accuracyOf(const py::object& accuracy)
{
  if (accuracy.is_none()) return Accuracy::exact();
  if (py::isinstance<py::str>(accuracy)) return Accuracy::parse(accuracy.cast<std::string>());
  if (!py::isinstance<Accuracy>(accuracy)) throw py::type_error("accuracy: give a text or an Accuracy");
  return accuracy.cast<Accuracy>();
}

py::array_t<float> floatsOf(const std::string& name, const py::object& values, std::size_t count)
{
  const py::array array = asArray(name, values);
  if (scalarOf(array.dtype()) != Scalar::float32)
    throw InvalidInput(Input::points, name, "are " + nameOfType(array.dtype()) + ", not float32",
                       "convert them, and mind which way that rounds: numpy.asarray(..., numpy.float32)");
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != count)
    throw InvalidInput(Input::points, name, "have shape " + shapeOf(array),
                       "give one for each of the " + counted(count, "point"));
  if (count > 1 && array.strides(0) != sizeof(float)) return py::array_t<float, py::array::c_style>::ensure(array);
  return py::reinterpret_borrow<py::array_t<float>>(array); // the array itself, no view of it: keep() locks it
}

std::vector<double> rowsOf(const std::string& name, const py::object& values, py::ssize_t columns)
{
  const py::array array = doublesOf(name, values, Input::trajectory);
  const bool fits = columns == 1 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns;
  if (!fits)
    throw InvalidInput(Input::trajectory, name, "have shape " + shapeOf(array),
                       columns == 1 ? "give (n,)" : "give (n, " + std::to_string(columns) + ")");
  const auto* numbers = static_cast<const double*>(array.data());
  return {numbers, numbers + array.size()};
}

std::vector<std::uint32_t> recordsOf(const std::string& name, const py::object& values, py::ssize_t columns)
{
  const py::array given = asArray(name, values);
  const bool empty = given.size() == 0;
  if (!empty && given.dtype().kind() != 'i' && given.dtype().kind() != 'u')
    throw InvalidInput(Input::index, name, "are " + nameOfType(given.dtype()), "give whole numbers");
  const bool fits = columns == 1 ? given.ndim() == 1 : given.ndim() == 2 && given.shape(1) == columns;
  if (!fits && !empty)
    throw InvalidInput(Input::index, name, "have shape " + shapeOf(given),
                       columns == 1 ? "give (n,)" : "give (n, " + std::to_string(columns) + ")");
  const auto numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(given);
  std::vector<std::uint32_t> records(static_cast<std::size_t>(numbers.size()));
  const std::int64_t* number = numbers.data();
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (number[i] < 0 || number[i] > std::int64_t{std::numeric_limits<std::uint32_t>::max()})
      throw InvalidInput(Input::index, name, std::to_string(number[i]) + " is no record", "count from 0");
    records[i] = static_cast<std::uint32_t>(number[i]);
  }
  return records;
}

} // namespace pcl_bsh::python
