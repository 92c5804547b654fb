// SPDX-License-Identifier: BSD-3-Clause
// The motion of an object since the last query, or what it would be once it has come to another pose.
#pragma once

#include <pcl_bsh/scene/state.h>
#include <pcl_bsh/scene/swept/sweep.h>

#include <optional>
#include <vector>

namespace pcl_bsh {

/// An object on one leg from its pose at the last query, with its present points. A part whose pose has been set since
/// then has a leg of its own, of T_world_cloud.
class SweptObject {
public:
  explicit SweptObject(const Body& body) : SweptObject(body, body.object.pose, body.turned) {}

  /// @param turned since the last query, on the way to the pose
  SweptObject(const Body& body, const Eigen::Isometry3d& to, const Eigen::Vector3d& turned);

  SweptPart part(std::uint32_t i) const;

  /// Holds it at every instant.
  Box3 box() const;

  /// Calls visit(part, leg, motion) of the whole, part: nothing, and of each part that has a leg of its own.
  template <class Visit>
  void eachLeg(const Visit& visit) const
  {
    visit(std::optional<std::uint32_t>(), leg_, motion_);
    for (const OwnLeg& own : own_) visit(std::optional<std::uint32_t>(own.part), own.leg, own.motion);
  }

private:
  struct OwnLeg {
    std::uint32_t part;
    Leg leg;
    ObjectMotion motion;
  };

  const Body& body_;
  Leg leg_;
  ObjectMotion motion_;
  std::vector<OwnLeg> own_; // ascending
};

} // namespace pcl_bsh
