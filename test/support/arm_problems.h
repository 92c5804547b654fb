// SPDX-License-Identifier: BSD-3-Clause
// Problems of an arm among boxes, cylinders and spheres, and clouds sampled on these evenly.
#pragma once

#include "support/random.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace pcl_bsh::test {

struct ArmObject {
  int kind = 0;                     ///< 0 box, 1 cylinder about z, 2 sphere
  std::array<double, 3> size = {};  ///< edges; height and radius; radius
  std::array<double, 12> pose = {}; ///< row by row
};

struct ArmProblem {
  std::string name;
  std::vector<double> start, goal;
  std::vector<ArmObject> objects;

  /// x y z of so many points of each object.
  std::vector<float> cloud(std::size_t points, Random& random) const
  {
    std::vector<float> xyz;
    for (const ArmObject& object : objects)
      for (std::size_t i = 0; i < points; ++i) {
        const std::array<double, 3> p = onSurface(object, random);
        for (std::size_t k = 0; k < 12; k += 4)
          xyz.push_back(static_cast<float>(object.pose[k] * p[0] + object.pose[k + 1] * p[1] +
                                           object.pose[k + 2] * p[2] + object.pose[k + 3]));
      }
    return xyz;
  }

private:
  static std::array<double, 3> onSurface(const ArmObject& object, Random& random)
  {
    const auto& [a, b, c] = object.size;
    const double angle = random.uniform(0, 2 * std::numbers::pi), way = random.uniform(-0.5, 0.5);
    if (object.kind == 2) {
      const double across = std::sqrt(1 - 4 * way * way);
      return {a * across * std::cos(angle), a * across * std::sin(angle), 2 * a * way};
    }
    if (object.kind == 1) {
      const double side = a, ends = b, place = random.uniform(0, side + ends);
      const double out = place < side ? b : b * std::sqrt(random.uniform(0, 1));
      const double up = place < side ? a * way : std::copysign(a / 2, way);
      return {out * std::cos(angle), out * std::sin(angle), up};
    }
    const std::array<double, 3> faces = {b * c, a * c, a * b};
    const double place = random.uniform(0, faces[0] + faces[1] + faces[2]);
    const std::size_t axis = place < faces[0] ? 0 : place < faces[0] + faces[1] ? 1 : 2;
    std::array<double, 3> p = {};
    for (double& x : p) x = random.uniform(-0.5, 0.5);
    p[axis] = std::copysign(0.5, way);
    return {a * p[0], b * p[1], c * p[2]};
  }
};

/// Problems of an arm of seven joints. Empty where there is no such file.
inline std::vector<ArmProblem> armProblems(const std::filesystem::path& file)
{
  std::ifstream in(file);
  std::vector<ArmProblem> problems;
  std::size_t count = 0;
  for (ArmProblem problem; in >> problem.name >> count; problem = {}) {
    for (std::vector<double>* state : {&problem.start, &problem.goal}) {
      state->resize(7);
      for (double& value : *state) in >> value;
    }
    for (; count > 0; --count) {
      ArmObject object;
      double kind = 0.0;
      in >> kind;
      object.kind = static_cast<int>(kind);
      for (double& x : object.size) in >> x;
      for (double& x : object.pose) in >> x;
      problem.objects.push_back(object);
    }
    problems.push_back(std::move(problem));
  }
  return problems;
}

} // namespace pcl_bsh::test
