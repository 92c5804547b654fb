// SPDX-License-Identifier: BSD-3-Clause
// Bullet's world, whose islands are those of manifolds and joints, not of boxes that overlap.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <btBulletDynamicsCommon.h>

namespace pcl_bsh {

class IslandWorld final : public btDiscreteDynamicsWorld {
public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

protected:
  void calculateSimulationIslands() override
  {
    btSimulationIslandManager& islands = *getSimulationIslandManager();
    islands.updateActivationState(getCollisionWorld(), getCollisionWorld()->getDispatcher());
    const auto unite = [&](const btCollisionObject& a, const btCollisionObject& b) {
      if (!a.isStaticOrKinematicObject() && !b.isStaticOrKinematicObject())
        islands.getUnionFind().unite(a.getIslandTag(), b.getIslandTag());
    };
    btDispatcher& dispatcher = *getCollisionWorld()->getDispatcher();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold& touching = *dispatcher.getManifoldByIndexInternal(i);
      unite(*touching.getBody0(), *touching.getBody1());
    }
    for (int i = 0; i < getNumConstraints(); ++i)
      unite(getConstraint(i)->getRigidBodyA(), getConstraint(i)->getRigidBodyB());
    islands.storeIslandActivationState(getCollisionWorld());
  }
};

} // namespace pcl_bsh
