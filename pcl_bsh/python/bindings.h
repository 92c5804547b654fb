// SPDX-License-Identifier: BSD-3-Clause
// Functions that bind a part of the module each, in the file of its name. Parts with types that signatures of other
// parts name are bound first.
#pragma once

#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/query/result.h>

#include <pybind11/pybind11.h>

namespace pcl_bsh::python {

/// A member of pcl_bsh.Verdict, an enum.IntEnum: flags in arrays are compared with it as numbers.
using VerdictMember = As<"Verdict">;
VerdictMember verdictOf(Verdict verdict);

void bindWords(pybind11::module_& module);     ///< verdicts, work, accuracy, Cancelled
void bindHierarchy(pybind11::module_& module); ///< SphereHierarchy
void bindCollision(pybind11::module_& module); ///< flags, any collision, smallest distance
void bindObstacles(pybind11::module_& module); ///< several obstacles at once
void bindContacts(pybind11::module_& module);
void bindManifold(pybind11::module_& module); ///< colliders, the few contacts of two, and ways out
void bindMass(pybind11::module_& module);
void bindDistances(pybind11::module_& module);
void bindNeighbors(pybind11::module_& module);
void bindClusters(pybind11::module_& module);    ///< clusters and spacings of one cloud
void bindTrajectory(pybind11::module_& module);  ///< paths of poses, and their clashes
void bindAxis(pybind11::module_& module);        ///< the line that a vehicle follows
void bindGauge(pybind11::module_& module);       ///< gauging runs along an axis
void bindSeenOutline(pybind11::module_& module); ///< what beams of such a run saw
void bindManyPoses(pybind11::module_& module);   ///< many poses, many motions
void bindScene(pybind11::module_& module);
void bindSceneResult(pybind11::module_& module);
void bindFiles(pybind11::module_& module);
void bindRobot(pybind11::module_& module); ///< this and the next two only where URDF is read
void bindRobotAnswers(pybind11::module_& module);
void bindRobotWorld(pybind11::module_& module);
void bindPipeline(pybind11::module_& module);

} // namespace pcl_bsh::python
