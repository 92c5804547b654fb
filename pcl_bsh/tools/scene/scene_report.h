// SPDX-License-Identifier: BSD-3-Clause
// The results of a scene's step, line by line: CSV for tables, JSON lines for programs.
#pragma once

#include <pcl_bsh/physics/scene_bodies.h>
#include <pcl_bsh/scene/scene.h>

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <iosfwd>
#include <vector>

namespace pcl_bsh::cli {

/// Counts of bodies.
struct BodyCost {
  std::size_t steps = 0; ///< of the solver
  WorldStep solved;
  double seconds = 0.0;

  void add(const BodiesStep& step);
  nlohmann::ordered_json json() const;
};

/// Sums over the steps of a run.
struct SceneTotals {
  std::array<EffectCost, kEffects> costs;
  BodyCost bodies;
  BroadPhaseCost broad_phase;
  std::vector<double> step_seconds;
  std::size_t colliding_steps = 0; ///< in which `any` found a pair
  std::size_t undecided_steps = 0; ///< in which it left one undecided
  std::size_t unswept_steps = 0;   ///< in which an object did more than first_contact and swept look at
  std::size_t touched_moves = 0;
  double travelled = 0.0, wanted = 0.0;

  void add(const BodiesStep& step, double seconds);
};

/// Counts of a step: a row of the CSV. Columns of effects that are not listed are left out.
class SceneTable {
public:
  /// @param undecided whether results may be undecided: then there are columns for that
  /// @param bodies null where the scene has none
  SceneTable(const Effects& effects, bool undecided, const SceneBodies* bodies)
  : effects_(effects),
    undecided_(undecided),
    bodies_(bodies)
  {
  }

  void writeHeader(std::ostream& out) const;

  /// Numbers are written to the last digit: times must not repeat, and distances are exact.
  void writeRow(std::ostream& out, std::size_t step, const BodiesStep& done) const;

private:
  bool sweeps() const { return effects_.first_contact || effects_.swept; }
  bool moves() const { return effects_.response != Response::none || effects_.gravity.has_value(); }

  const Effects& effects_;
  bool undecided_;
  const SceneBodies* bodies_;
};

/// Whether a verdict of the scene may be undecided, for its accuracy or the uncertainty of points.
bool mayBeUndecided(const Scene& scene);

nlohmann::ordered_json toJson(const EffectCost& cost);

/// One line: all results of the step, objects by name; the positions of those that moved under a response, and bodies.
/// @param bodies null where the scene has none
nlohmann::ordered_json toJson(std::size_t step, const BodiesStep& done, const Scene& scene, const SceneBodies* bodies);

} // namespace pcl_bsh::cli
