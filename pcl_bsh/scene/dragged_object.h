// SPDX-License-Identifier: BSD-3-Clause
// An object of a scene that is led by hand. It goes where it is wanted, as far as the scene's response lets it. It
// tells what it touches, and how near it is to anything.
//
//   SceneOptions options;
//   options.clearance = 0.02;
//   options.effects.response = Response::slide;        // or stop; none: it goes anywhere
//   Scene scene(options);                              // add() the others without motions
//   DraggedObject crate(scene, *scene.find("crate"));
//   const DragStep& now = crate.moveTo(T_world_wanted); // for each event of a mouse
//   draw(now.pose, now.contacts, now.nearest);
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/scene/scene.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The options of a dragged object. Lengths are in the clouds' unit.
struct DragOptions {
  /// Contacts have gaps up to this; finite, >= 0. Nothing: four tolerances of the scene, or half the largest spacing of
  /// clouds of points where that is more.
  std::optional<double> margin;
  std::size_t most = 4; ///< contacts of a patch
};

/// The object that is nearest to a dragged one.
struct NearestObject {
  ObjectId object = 0;
  double distance = 0.0; ///< as closestPair() measures it: of surfaces, also where one is in the other
  Eigen::Vector3d place = Eigen::Vector3d::Zero(); ///< of the dragged object, in the world
  Eigen::Vector3d other = Eigen::Vector3d::Zero(); ///< of the nearest
};

/// Where a dragged object is, its contacts, and the nearest object.
struct DragStep {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_object
  bool held = false;                                      ///< the response keeps it from where it was wanted
  /// By contactManifold(), between the dragged object as a and all others that it is tested against. The clearance is
  /// the thickness: a gap is the distance beyond it.
  std::vector<Contact> contacts;
  std::optional<NearestObject> nearest; ///< nothing: it is tested against no point
  Work work;                            ///< of contacts and distances
};

/// Not to be used from several threads at once. The constructor makes colliders of all clouds.
class DraggedObject {
public:
  /// @param scene must outlive it, and keep its objects and their points. Its other effects are computed in each step
  /// @throws InvalidInput for a margin without meaning, std::out_of_range for an object that is not there
  DraggedObject(Scene& scene, ObjectId object, const DragOptions& options = {});
  ~DraggedObject();
  DraggedObject(DraggedObject&&) noexcept;
  DraggedObject& operator=(DraggedObject&&) noexcept;

  /// Leads the object to a pose, straight and at constant speed, as the scene's response and gravity let it. A step of
  /// the scene: its time passes by a second. @throws as Scene::step() does; then nothing has moved
  const DragStep& moveTo(const Eigen::Isometry3d& T_world_object);

  /// Finds contacts and the nearest object where the object is now, for one that something else has moved.
  const DragStep& look();

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
