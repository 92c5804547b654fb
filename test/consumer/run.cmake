# SPDX-License-Identifier: BSD-3-Clause
# Installs a build of pcl_bsh to an empty prefix, then configures, builds and runs this project against it.
#   cmake -D PCL_BSH_BUILD=<build folder> -D WORK=<folder of its own> -P run.cmake
cmake_minimum_required(VERSION 3.25)
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --install "${PCL_BSH_BUILD}" --prefix "${WORK}/prefix")

run(${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D
    "CMAKE_PREFIX_PATH=${WORK}/prefix")
execute_process(COMMAND ${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/refused" -G Ninja -D
                        "CMAKE_PREFIX_PATH=${WORK}/prefix" -D PCL_BSH_COMPONENTS=tree RESULT_VARIABLE status
                OUTPUT_QUIET ERROR_VARIABLE text)
if(status EQUAL 0 OR NOT text MATCHES "no[ \n]+component[ \n]+tree")
  message(FATAL_ERROR "the component `tree` was not refused by its name: status ${status}, ${text}")
endif()

# Installed samples are built with the installed package.
file(GLOB samples "${WORK}/prefix/share/doc/pcl_bsh/cpp")
run(${CMAKE_COMMAND} -S "${samples}" -B "${WORK}/samples" -G Ninja -D CMAKE_BUILD_TYPE=Debug -D
    "CMAKE_PREFIX_PATH=${WORK}/prefix" -D "CMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror")
run(${CMAKE_COMMAND} --build "${WORK}/samples")
foreach(program IN ITEMS filter_chain search_chain own_stage)
  execute_process(COMMAND "${WORK}/samples/pcl_bsh_${program}" RESULT_VARIABLE status ERROR_VARIABLE text)
  if(NOT status EQUAL 2 OR NOT text MATCHES "^usage: pcl_bsh_${program} ")
    message(FATAL_ERROR "pcl_bsh_${program}: status ${status}, ${text}")
  endif()
endforeach()
run(${CMAKE_COMMAND} --build "${WORK}/build")

# The project that cmake/INSTALL.md tells to write is built, with the README's example and PCL's io.
file(READ "${CMAKE_CURRENT_LIST_DIR}/../../cmake/INSTALL.md" install)
file(READ "${CMAKE_CURRENT_LIST_DIR}/../../README.md" readme)
if(NOT install MATCHES "```cmake\n([^`]*)```")
  message(FATAL_ERROR "cmake/INSTALL.md: holds no project")
endif()
file(WRITE "${WORK}/told/CMakeLists.txt" "${CMAKE_MATCH_1}")
if(NOT readme MATCHES "```cpp\n(#include[^`]*)```")
  message(FATAL_ERROR "README.md: holds no example in C++")
endif()
file(WRITE "${WORK}/told/my_robot.cpp"
     "#include <pcl/io/pcd_io.h>\n${CMAKE_MATCH_1}\nint main(int count, char** names)\n{\n"
     "  auto scan = std::make_shared<Cloud>(), robot = std::make_shared<Cloud>();\n"
     "  if (count < 3 || pcl::io::loadPCDFile(names[1], *scan) < 0 || pcl::io::loadPCDFile(names[2], *robot) < 0) return 2;\n"
     "  return withoutRobot(scan, robot, Eigen::Isometry3d::Identity())->empty();\n}\n")
run(${CMAKE_COMMAND} -S "${WORK}/told" -B "${WORK}/told/build" -G Ninja -D CMAKE_BUILD_TYPE=Debug -D
    "CMAKE_PREFIX_PATH=${WORK}/prefix")
run(${CMAKE_COMMAND} --build "${WORK}/told/build")

# Each component but vtk is found in a project of C++ alone, which then does without PCL's io.
foreach(component IN ITEMS core search filters pipeline sites certify ompl)
  set(optional "OPTIONAL_COMPONENTS ${component}")
  if(component STREQUAL core) # CMake refuses one that is both required and optional
    set(optional "")
  endif()
  file(WRITE "${WORK}/${component}/CMakeLists.txt"
       "cmake_minimum_required(VERSION 3.16)\nproject(alone CXX)\n"
       "find_package(pcl_bsh 0.2 REQUIRED CONFIG COMPONENTS core ${optional})\n"
       "add_library(alone OBJECT alone.cpp)\nif(TARGET pcl_bsh::${component})\n"
       "  target_link_libraries(alone PRIVATE pcl_bsh::${component})\nendif()\n")
  file(WRITE "${WORK}/${component}/alone.cpp" "#include <pcl_bsh/collide.h>\nint one() { return 1; }\n")
  run(${CMAKE_COMMAND} -S "${WORK}/${component}" -B "${WORK}/${component}/build" -G Ninja -D
      "CMAKE_PREFIX_PATH=${WORK}/prefix")
  run(${CMAKE_COMMAND} --build "${WORK}/${component}/build")
endforeach()
run("${WORK}/build/core_only")
run("${WORK}/build/own_point_type")
run("${WORK}/build/site_error")
foreach(program IN ITEMS certified validated)
  if(EXISTS "${WORK}/build/${program}")
    run("${WORK}/build/${program}")
  endif()
endforeach()
if(EXISTS "${WORK}/build/spheres_file")
  run("${WORK}/build/spheres_file" "${WORK}/spheres.vtp")
endif()
