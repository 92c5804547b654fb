// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/dragged_object.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/nearest_places.h>
#include <pcl_bsh/scene/part_colliders.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace pcl_bsh {

struct DraggedObject::Parts {
  struct Part {
    ObjectId object;
    std::uint32_t part;
    const Collider* collider;
    bool solid;
  };

  Parts(Scene& of, ObjectId dragged, const DragOptions& options) : scene(of), object(dragged), most(options.most)
  {
    if (object >= scene.size()) throw std::out_of_range(plainText("object ", object, " of ", scene.size()));
    if (options.margin && !(std::isfinite(*options.margin) && *options.margin >= 0.0))
      throw InvalidInput(Input::scene, "margin of contacts", plainText(*options.margin),
                         "give a finite length of at least 0");
    double spacing = 0.0;
    for (ObjectId i = 0; i < scene.size(); ++i) {
      for (std::uint32_t part = 0; part < scene[i].parts.size(); ++part) {
        const ScenePart& of_object = scene[i].parts[part];
        const Collider& collider = *colliders.of(*of_object.hierarchy, of_object.solid).collider;
        (i == object ? own : others).push_back({i, part, &collider, of_object.solid});
        spacing = std::max(spacing, collider.spacing());
      }
    }
    margin = options.margin.value_or(std::max(4.0 * scene.options().tolerance, 0.5 * spacing));
  }

  void look()
  {
    now.pose = scene[object].pose;
    now.contacts.clear();
    now.nearest.reset();
    now.work = Work();
    for (const Part& other : others)
      if (const auto clearance = scene.clearanceOf(object, other.object)) look(other, *clearance);
    if (!now.nearest) return;
    // The next look begins with the nearest object: its distance bounds the search among all others.
    const auto is_nearest = [&](const Part& other) { return other.object == now.nearest->object; };
    std::iter_swap(others.begin(), std::find_if(others.begin(), others.end(), is_nearest));
  }

  void look(const Part& other, double clearance)
  {
    for (const Part& mine : own) {
      const Placed a(mine.collider->thing(), scene.worldPose(object, mine.part));
      const Placed b(other.collider->thing(), scene.worldPose(other.object, other.part));
      DistanceRequest request;
      request.threads = scene.options().threads;
      if (now.nearest) request.max_distance = std::max({now.nearest->distance, clearance + margin, 0.0});
      const DistanceResult found = closestPair(a, b, request);
      now.work += found.work;
      if (found.pair && (!now.nearest || found.distance < now.nearest->distance)) {
        const auto [place, opposite] = nearestPlaces(a, b, *found.pair);
        now.nearest = {other.object, found.distance, place, opposite};
      }
      const bool is_near = found.pair && found.interval.lower <= clearance + margin;
      if (is_near || mine.solid || other.solid) // which may hold the other wholly
        addContacts({*mine.collider, a.pose}, {*other.collider, b.pose}, clearance);
    }
  }

  void addContacts(const PlacedCollider& a, const PlacedCollider& b, double clearance)
  {
    ManifoldRequest request;
    request.margin = margin;
    request.thickness = clearance;
    request.most = most;
    contactManifold(a, b, request, between);
    now.work += between.work;
    now.contacts.insert(now.contacts.end(), between.contacts.begin(), between.contacts.end());
  }

  Scene& scene;
  const ObjectId object;
  const std::size_t most;
  double margin = 0.0;
  PartColliders colliders;
  std::vector<Part> own, others; ///< of the dragged object, and of all others
  Manifold between;              ///< of the last pair; its memory is used again
  DragStep now;
};

DraggedObject::DraggedObject(Scene& scene, ObjectId object, const DragOptions& options)
: parts_(std::make_unique<Parts>(scene, object, options))
{
}

DraggedObject::~DraggedObject() = default;
DraggedObject::DraggedObject(DraggedObject&&) noexcept = default;
DraggedObject& DraggedObject::operator=(DraggedObject&&) noexcept = default;

const DragStep& DraggedObject::moveTo(const Eigen::Isometry3d& T_world_object)
{
  struct AtRest {
    ~AtRest() { scene.setMotion(object, NoMotion()); }
    Scene& scene;
    ObjectId object;
  };
  Scene& scene = parts_->scene;
  {
    scene.setMotion(parts_->object, WaypointMotion{{0.0, 1.0}, {scene[parts_->object].pose, T_world_object}});
    const AtRest after{scene, parts_->object};
    const SceneResult done = scene.step(1.0);
    parts_->now.held = std::any_of(done.outcomes.begin(), done.outcomes.end(), [&](const Outcome& outcome) {
      return outcome.object == parts_->object && (outcome.touched || outcome.stuck);
    });
  }
  return look();
}

const DragStep& DraggedObject::look()
{
  parts_->look();
  return parts_->now;
}

} // namespace pcl_bsh
