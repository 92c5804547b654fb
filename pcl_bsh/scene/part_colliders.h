// SPDX-License-Identifier: BSD-3-Clause
// The colliders of a scene's parts. Parts of one hierarchy share one.
#pragma once

#include <pcl_bsh/manifold/collider.h>
#include <pcl_bsh/solid/solid.h>

#include <map>
#include <memory>
#include <utility>

namespace pcl_bsh {

struct PartCollider {
  std::unique_ptr<const Solid> solid; ///< null: it encloses nothing
  std::unique_ptr<const Collider> collider;
};

class PartColliders {
public:
  using Key = std::pair<const SphereHierarchy*, bool>; ///< and whether it is a solid

  /// Made on the first use. @param encloses whether the hierarchy is of triangles that are a solid
  /// @throws InvalidInput as Solid does
  const PartCollider& of(const SphereHierarchy& hierarchy, bool encloses)
  {
    PartCollider& made = made_[{&hierarchy, encloses}];
    if (made.collider) return made;
    if (encloses) made.solid = std::make_unique<const Solid>(*hierarchy.view().triangles);
    made.collider = std::make_unique<const Collider>(hierarchy, made.solid.get());
    return made;
  }

  const std::map<Key, PartCollider>& all() const noexcept { return made_; }

private:
  std::map<Key, PartCollider> made_;
};

} // namespace pcl_bsh
