// SPDX-License-Identifier: BSD-3-Clause
// Bodies in the report of a scene: columns of the CSV, members of the JSON lines, sums over a run.
#pragma once

#include <pcl_bsh/physics/scene_bodies.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <iosfwd>

namespace pcl_bsh::cli {

/// Counts of bodies.
struct BodyCost {
  std::size_t steps = 0; ///< of the solver
  WorldStep solved;
  double seconds = 0.0;

  void add(const BodiesStep& step);
  nlohmann::ordered_json json() const;
};

/// Names of the columns, each after a comma.
void writeBodyHeader(std::ostream& out);
void writeBodyRow(std::ostream& out, const BodiesStep& step, const SceneBodies& bodies);

/// Adds `bodies`, where each is and how it moves, and `body_contacts`.
void addBodies(nlohmann::ordered_json& json, const SceneBodies& bodies, const Scene& scene);

} // namespace pcl_bsh::cli
