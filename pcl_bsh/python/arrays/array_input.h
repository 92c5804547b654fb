// SPDX-License-Identifier: BSD-3-Clause
// Input of queries, from NumPy arrays. All of it needs the interpreter's lock, and throws std::invalid_argument, which
// Python knows as ValueError.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/python/arrays/array_lock.h>
#include <pcl_bsh/python/threads/interpreter_lock.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/question/pose_uncertainty.h>

#include <pybind11/numpy.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

namespace py = pybind11;

/// Points, and what may stand beside them, as Python hands them over.
struct PointsInput {
  py::object xyz;                        ///< (n, 3), or any shape of a dtype with fields x, y, z
  py::object radii = py::none();         ///< (n,) float32
  py::object indices = py::none();       ///< (k,) whole numbers
  double uncertainty = 0.0;              ///< of every point
  py::object uncertainties = py::none(); ///< (n,) float32
  bool copy = false;
  PoseUncertainty pose = {}; ///< on top of both: all points may move together
};

/// Owner of the memory that a Python hierarchy refers to. Released by whichever thread lets go of it last.
class Owner {
public:
  virtual ~Owner() = default;
};

/// Arrays that are read where they are, and so are locked.
class KeptArrays : public Owner {
public:
  py::array points;
  bool in_place = false; ///< `points` is the caller's own memory

  /// Input beside the points, from which the view's uncertainties are made.
  double uncertainty = 0.0;
  const float* uncertainties = nullptr;
  PoseUncertainty pose = {};
  const void* keep(const py::array& array);

  /// As PyTypeObject::tp_traverse, to be called by the only owner of this object.
  int traverse(visitproc visit, void* arg) const;

private:
  std::vector<std::unique_ptr<ArrayLock>> locks_;
};

/// An owner whose destructor runs with the interpreter's lock.
template <class Kept>
std::shared_ptr<Kept> makeOwner()
{
  return std::shared_ptr<Kept>(new Kept, [](Kept* kept) {
    if (!Py_IsInitialized()) return; // the arrays went with the interpreter
    const Locked lock;
    delete kept;
  });
}

/// The view of a hierarchy; its owner keeps the arrays. Memory that a view cannot describe (rows backwards, rows over
/// each other, records of two dimensions without one step from each to the next) is copied.
/// @param name how errors call the points
PointsView viewOfPoints(const std::string& name, const PointsInput& input);

/// The view of a hierarchy of triangles; its owner keeps the vertices' arrays. @param vertices without radii, indices
/// and uncertainties of their own
PointsView viewOfTriangles(const PointsInput& vertices, std::vector<Triangle> triangles);

/// Views of points before and after they moved. The last copy of each is to be released with the interpreter's lock.
struct MovedView {
  PointsView before, now;
};

/// The owner of the arrays of a view of viewOfPoints() or viewOfTriangles(); else null.
const KeptArrays* arraysOf(const PointsView& view);

/// The points of `before` at new places. They keep their subset, the uncertainties of all points and of the pose, and
/// the radii and uncertainties that `input` lacks. @param input has neither of the first three; for triangles vertices
MovedView movedView(const PointsView& before, PointsInput input);

/// A view for the time of a call: nothing is locked. `kept` has what must live as long as the view.
PointsView viewForCall(const std::string& name, const py::object& xyz, py::array& kept);

/// The pose in (4, 4) or (3, 4), an array or anything that NumPy makes one of; None: the identity.
Eigen::Isometry3d poseOf(const std::string& name, const py::object& pose);

/// The poses in (m, 4, 4) or (m, 3, 4).
std::vector<Eigen::Isometry3d> posesOf(const std::string& name, const py::object& poses);

Point3 point3Of(const std::string& name, const py::object& point);
Eigen::Vector3d vectorOf(const std::string& name, const py::object& vector);

/// A text for PoseUncertainty::parse(), or the numbers of one; None: exact.
PoseUncertainty poseUncertaintyOf(const py::object& uncertainty);

/// A text for Accuracy::parse(), or an Accuracy; None: exact.
Accuracy accuracyOf(const py::object& accuracy);

/// The values as (n,) float32, n being `count`. The array is not locked.
py::array_t<float> floatsOf(const std::string& name, const py::object& values, std::size_t count);

/// The numbers of an array (n, columns), row after row; for one column, of an array (n,).
std::vector<double> rowsOf(const std::string& name, const py::object& values, py::ssize_t columns);

/// The records in an array (n, columns), row after row, each in [0, 2^32); for one column, in an array (n,).
std::vector<std::uint32_t> recordsOf(const std::string& name, const py::object& values, py::ssize_t columns);

} // namespace pcl_bsh::python
