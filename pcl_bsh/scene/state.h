// SPDX-License-Identifier: BSD-3-Clause
// The state of a Scene between queries.
#pragma once

#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/scene/pairs/broad_phase.h>
#include <pcl_bsh/scene/scene.h>
#include <pcl_bsh/scene/scene_solids.h>
#include <pcl_bsh/scene/swept/object_motion.h>

#include <chrono>
#include <optional>
#include <unordered_map>
#include <vector>

namespace pcl_bsh {

struct SweptPart;

/// T_world_cloud of a part that is at `part` (T_object_cloud) in an object at `pose`.
Eigen::Isometry3d worldPoseOf(const Eigen::Isometry3d& pose, const Eigen::Isometry3d& part);

/// Adds the time until its end to a cost.
class Timed {
public:
  explicit Timed(double& seconds) : seconds_(seconds) {}
  ~Timed() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// An object as it stands.
struct Body {
  ObjectId id = 0;
  bool listed = false; ///< among those that moved since the last query
  SceneObject object;
  Eigen::Isometry3d start;              ///< pose at time 0 of its motion
  double start_time = 0.0;              ///< of the scene, when the motion was given
  bool follows_motion = true;           ///< stands where its motion has it
  std::vector<Eigen::Isometry3d> world; ///< T_world_cloud of each part
  Box3 box;                             ///< of its points, in the object's frame
  Box3 world_box;
  std::uint64_t version = 1;                        ///< grows with every change of a pose or of points
  Eigen::Isometry3d last_pose;                      ///< at the last query; before the first, where it was put
  std::vector<Eigen::Isometry3d> last_parts;        ///< poses of its parts at the last query, if one was set since
  std::uint64_t last_version = 0;                   ///< at the last query; 0: there was none
  bool reshaped = false;                            ///< since the last query its points have changed
  bool detoured = false;                            ///< since the last query it went another way than in one leg
  std::uint64_t placed_version = 0;                 ///< when it was placed in the grid
  bool placed_swept = false;                        ///< whether it was placed with the motion to its pose
  Eigen::Vector3d turned = Eigen::Vector3d::Zero(); ///< since the last query, full turns included
  double last_motion = 0.0;                         ///< how far its points went between the last two queries, at most
  Eigen::Isometry3d step_pose;                      ///< before the step in progress
  bool step_follows_motion = true;                  ///< follows_motion before the step in progress
  Eigen::Vector3d step_turned = Eigen::Vector3d::Zero(); ///< turned before the step in progress

  /// Centre of its box, in the object's frame: the point that moves straight.
  Eigen::Vector3d center() const { return box.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : box.center(); }

  /// Whether a part has moved within the object since the last query.
  bool isPartMoved(std::size_t part) const
  {
    return !last_parts.empty() && last_parts[part].matrix() != object.parts[part].pose.matrix();
  }
  bool isMoved() const
  {
    if (turned != Eigen::Vector3d::Zero() || last_pose.matrix() != object.pose.matrix()) return true;
    for (std::size_t i = 0; i < last_parts.size(); ++i)
      if (isPartMoved(i)) return true;
    return false;
  }
};

/// Whether an effect looks at the motion since the last query.
inline bool usesSweptMotion(const Effects& effects)
{
  return effects.first_contact || effects.swept;
}

inline bool isResponding(const Effects& effects)
{
  return effects.response != Response::none || effects.gravity.has_value();
}

class Scene::State {
public:
  explicit State(SceneOptions scene_options);

  /// While it lives, the scene answers a query or does a step.
  struct InProgress {
    explicit InProgress(State& scene) : state(scene) { state.progress.emplace(state.options.progress); }
    ~InProgress() { state.progress.reset(); }
    InProgress(const InProgress&) = delete;
    InProgress& operator=(const InProgress&) = delete;

    State& state;
  };

  Placed placed(ObjectId object, std::size_t part) const
  {
    return {*bodies[object].object.parts[part].hierarchy, bodies[object].world[part]};
  }

  StandingPart standing(ObjectId object, std::size_t part) const
  {
    return {placed(object, part), bodies[object].object.parts[part].solid};
  }
  bool areSolid(const PartPair& parts) const ///< whether at least one of them is
  {
    return bodies[parts.a].object.parts[parts.part_a].solid || bodies[parts.b].object.parts[parts.part_b].solid;
  }

  /// Returns an enclosed record of two standing parts, and a triangle of a body that holds it. Nothing where no record
  /// is enclosed. @param surfaces the verdict of their surfaces, which is not colliding
  std::optional<PointPair> enclosedPair(const StandingPart& a, const StandingPart& b, Verdict surfaces,
                                        double clearance, Work& work) const;
  void followSolids(); ///< makes what queries of solids need

  EffectCost& cost(Effect effect) { return result.costs[static_cast<std::size_t>(effect)]; }
  Body& body(ObjectId object);
  static void checkWorld(const SceneObject& object, const Eigen::Isometry3d& pose);

  void setPose(ObjectId object, const Eigen::Isometry3d& pose);
  void updateWorld(Body& body);
  void shapeChanged(ObjectId object);  ///< its parts or their points are elsewhere in it
  void pointsChanged(ObjectId object); ///< the same, where points have moved by themselves, not with a part
  void followPoints(); ///< forgets what is known of points that were changed since the last call, also by another scene

  SceneResult step(double dt);
  void move(double dt);
  void respond(ObjectId object, const Eigen::Isometry3d& target, const Eigen::Vector3d& turn);
  void recover() noexcept; ///< after a query that threw: drops its result, and all that is remembered
  void prepareGrid();      ///< the grid, and every object in it
  SceneResult query();     ///< at the end of a step, or by itself

  /// Returns the effort of a query of two parts. The scene's progress watches its thread.
  Effort ofParts() const { return {options.accuracy, 1}; }

  SceneOptions options;
  mutable std::optional<Progress> progress; ///< of the query or step in progress, and none between them
  double share = 0.0;                       ///< of the whole that is done at the end of the effect that is computed
  PairRules rules;
  SceneSolids solids;
  std::vector<Body> bodies;
  std::unordered_map<std::string, ObjectId> names;
  double time = 0.0;
  bool queried = false;  ///< there was a query
  bool stepping = false; ///< the query is that of a step
  BroadPhase grid;
  bool grid_stale = true;             ///< must be made anew: rules, clearances or reach have changed
  double reach = 0.0;                 ///< how far apart pairs are of interest
  SceneResult result;                 ///< of the query in progress
  std::vector<BroadPair*> near;       ///< pairs whose boxes are within the clearance, by (a, b)
  bool near_stale = true;             ///< must be gathered from all pairs
  std::vector<ObjectId> moved;        ///< since the last query
  std::vector<ObjectId> moved_before; ///< between the two queries before

  /// The hierarchies of all objects, and their revisions when the scene last looked.
  std::unordered_map<const SphereHierarchy*, std::uint64_t> watched;

private:
  void place(ObjectId object);
  void findNear();
  void findAny(EffectCost& spent);
  void findFlags(EffectCost& spent);
  void findDistances(EffectCost& spent);
  void findContacts(EffectCost& spent);
  void findFirstContacts(EffectCost& spent);
  void findSwept(EffectCost& spent);
  void findSelf(EffectCost& spent);

  void addEnclosedOnTheWay(const SweptPart& a, const SweptPart& b, const PartPair& parts, BroadPair& pair,
                           std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b) const;
  void addEnclosedAt(double s, const SweptPart& a, const SweptPart& b, const PartPair& parts, BroadPair& pair,
                     std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b) const;

  void decideAny(BroadPair& pair) const;
  bool remembersAny(BroadPair& pair) const;
  bool isKnownFree(const BroadPair& pair) const;
  void decideDistance(BroadPair& pair, double within) const;
  void compareBoxes(BroadPair& pair);
  template <class Decide>
  void eachPair(const std::vector<BroadPair*>& pairs, EffectCost& cost, const Decide& decide);
  template <class Ask>
  void eachPartPair(BroadPair& pair, const Ask& ask) const;
  template <class Ask>
  void eachNearPair(EffectCost& cost, const Ask& ask);
  template <class Ask>
  void eachSweptPair(EffectCost& cost, const Ask& ask);
  void checkMotion(const Body& body, const ObjectMotion& motion, double rounding) const;
  void listSweptMotions();
  void checkMotions(double before, double after) const;

  std::vector<Box3> boxes_;            // scratch
  std::vector<BroadPair*> newly_near_; // scratch
};

} // namespace pcl_bsh
