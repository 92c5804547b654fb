# SPDX-License-Identifier: BSD-3-Clause
# A workspace of ROS 2 with two packages, this project and one that needs it, built by colcon.
#
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -D WERROR=ON -P workspace.cmake
# WERROR: as that build has it
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH test)
cmake_path(GET test PARENT_PATH root)
include("${CMAKE_CURRENT_LIST_DIR}/reuse.cmake")

file(STRINGS "${root}/package.xml" line REGEX "<version>")
file(STRINGS "${root}/pcl_bsh/version.h" numbers REGEX "define PCL_BSH_VERSION_[A-Z]+ [0-9]")
list(TRANSFORM numbers REPLACE ".* " "")
list(JOIN numbers "." version)
if(NOT line MATCHES "<version>${version}</version>")
  message(FATAL_ERROR "package.xml: has another version than pcl_bsh/version.h, ${version}")
endif()

file(REMOVE_RECURSE "${WORK}")
file(COPY "${CMAKE_CURRENT_LIST_DIR}/workspace/" "${test}/consumer/core_only.cpp" "${test}/consumer/own_point_type.cpp"
     DESTINATION "${WORK}/src/robot")
set(arguments -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_EXPORT_COMPILE_COMMANDS=ON -D "PCL_BSH_WERROR=${WERROR}")
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${PCL_BSH_REUSE};.")
run(${CMAKE_COMMAND} -S "${root}" -B "${WORK}/build/pcl_bsh" ${arguments} -D PCL_BSH_BUILD_COMPONENTS=OFF -D
    PCL_BSH_BUILD_TESTS=OFF -D "CMAKE_INSTALL_PREFIX=${WORK}/install/pcl_bsh")
pcl_bsh_list_reused("${WORK}/build/pcl_bsh" ".")
list(TRANSFORM arguments REPLACE "^([A-Z].*=)" "-D\\1")
list(REMOVE_ITEM arguments -D)
set(ENV{COLCON_HOME} "${WORK}/colcon")
execute_process(COMMAND colcon --log-base "${WORK}/log" build --base-paths "${root}" src --event-handlers console_direct+ --cmake-args ${arguments}
                WORKING_DIRECTORY "${WORK}" COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
unset(ENV{CMAKE_CXX_COMPILER_LAUNCHER})
run(bash -c ". '${WORK}/install/setup.sh' && core_only && own_point_type")
