# SPDX-License-Identifier: BSD-3-Clause
# The Python package, installed by pip into an environment that sees the system's packages, and used from there.
#
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -D WERROR=ON -D PYTHON=python3 -P pip.cmake
# WERROR: as that build has it
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
cmake_path(GET test PARENT_PATH root)
include("${CMAKE_CURRENT_LIST_DIR}/reuse.cmake")

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${PCL_BSH_REUSE};.")
file(STRINGS "${root}/pyproject.toml" lines REGEX "^PCL_BSH_BUILD_[A-Z]+ = ") # what pip will configure
list(TRANSFORM lines REPLACE "^([A-Z_]+) = \"([A-Z]+)\".*" "-D\\1=\\2")
run(${CMAKE_COMMAND} -S "${root}" -B "${WORK}/alike" -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_EXPORT_COMPILE_COMMANDS=ON -D
    "PCL_BSH_WERROR=${WERROR}" ${lines})
pcl_bsh_list_reused("${WORK}/alike" ".")

run("${PYTHON}" -m venv --system-site-packages --without-pip "${WORK}/venv")
set(python "${WORK}/venv/bin/python3")
run("${python}" -m pip install --no-build-isolation --no-index --verbose --config-settings "build-dir=${WORK}/build" "${root}")
execute_process(
  COMMAND "${python}" -c "
import numpy as np, pcl_bsh
points = np.random.default_rng(1).random((500, 3))
flags = pcl_bsh.collision_flags(pcl_bsh.SphereHierarchy(points), pcl_bsh.SphereHierarchy(points[:3]), clearance=0.2)
squared = ((points[:, None] - points[None, :3]) ** 2).sum(axis=2).min(axis=1)
assert (flags == (squared <= 0.04)).all(), flags
print(pcl_bsh.__file__, flags.sum())"
  WORKING_DIRECTORY "${WORK}" OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "^${WORK}/venv/.* [1-9][0-9]*\n")
  message(FATAL_ERROR "another copy of pcl_bsh is imported, or nothing collides: ${said}")
endif()
message(STATUS "${said}")
run("${python}" -m pip uninstall --yes pcl_bsh)
