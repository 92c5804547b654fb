// SPDX-License-Identifier: BSD-3-Clause
// The effect of that name: an object's points move, and its spheres with them.
#include <pcl_bsh/scene/state.h>

#include <pcl_bsh/base/invalid_input.h>

#include <chrono>

namespace pcl_bsh {

RefitReport Scene::deform(ObjectId object, std::uint32_t part, const PointsView& now)
{
  using Clock = std::chrono::steady_clock;
  const Body& body = state_->body(object);
  if (!state_->options.effects.deform)
    throw InvalidInput(Input::scene, "Scene", "object '" + body.object.name + "' cannot deform",
                       "deform is not listed");
  if (part >= body.object.parts.size())
    throw InvalidInput(Input::scene, "Scene", "object '" + body.object.name + "' has no part " + std::to_string(part));
  const auto start = Clock::now();
  SphereHierarchy& hierarchy = *body.object.parts[part].hierarchy;
  const RefitReport report = hierarchy.refit(now, *state_->options.effects.deform);
  state_->followPoints();
  EffectCost& cost = state_->cost(Effect::deform);
  ++cost.pairs;
  cost.work.volumes_built += report.volumes_refitted;
  cost.seconds += std::chrono::duration<double>(Clock::now() - start).count();
  return report;
}

} // namespace pcl_bsh
