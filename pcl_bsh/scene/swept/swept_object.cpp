// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/swept/swept_object.h>

namespace pcl_bsh {
namespace {

Leg legOf(const Body& body, const Eigen::Isometry3d& to, const Eigen::Vector3d& turned)
{
  return {body.last_pose, to, body.center(), turnNearestTo(turned, body.last_pose.linear(), to.linear())};
}

/// The leg of T_world_cloud.
Leg legOf(const Body& body, std::uint32_t part, const Leg& whole, const Box3& box)
{
  const Eigen::Isometry3d &before = body.last_parts[part], &now = body.object.parts[part].pose;
  const Eigen::Isometry3d from = worldPoseOf(whole.from, before), to = worldPoseOf(whole.to, now);
  const Eigen::Vector3d turned = whole.turn + whole.to.linear() * shorterTurn(before.linear(), now.linear());
  const Eigen::Vector3d center = box.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : box.center();
  return {from, to, center, turnNearestTo(turned, from.linear(), to.linear())};
}

} // namespace

SweptObject::SweptObject(const Body& body, const Eigen::Isometry3d& to, const Eigen::Vector3d& turned)
: body_(body),
  leg_(legOf(body, to, turned)),
  motion_(leg_, body.box)
{
  for (std::uint32_t i = 0; i < body.world.size(); ++i) {
    if (!body.isPartMoved(i)) continue;
    const Box3 box = boxOf(*body.object.parts[i].hierarchy);
    const Leg leg = legOf(body, i, leg_, box);
    own_.push_back({i, leg, ObjectMotion(leg, box)});
  }
}

SweptPart SweptObject::part(std::uint32_t i) const
{
  static const Eigen::Isometry3d whole = Eigen::Isometry3d::Identity();
  const ScenePart& part = body_.object.parts[i];
  for (const OwnLeg& own : own_)
    if (own.part == i) return {*part.hierarchy, whole, own.motion};
  return {*part.hierarchy, part.pose, motion_};
}

Box3 SweptObject::box() const
{
  Box3 box = motion_.swept();
  for (const OwnLeg& own : own_) box.merge(own.motion.swept());
  return box;
}

} // namespace pcl_bsh
