// SPDX-License-Identifier: BSD-3-Clause
// Which points of a model that is placed into scans lie where no scanner saw that the space about them is empty?
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/query/work.h>
#include <pcl_bsh/seen/seen_space.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The request of markUnseen().
struct UnseenRequest {
  double clearance = 0.0; ///< finite, >= 0: radius of the ball about a point, its radius and uncertainty on top
  unsigned threads = 1;   ///< 0: all of the machine's
  /// Called now and then, by the calling thread, with the fraction done in [0, 1], which never falls. False: stop,
  /// markUnseen() throws Cancelled.
  std::function<bool(double)> progress = {};

  bool kinds = false;                          ///< tell UnseenResult::kinds
  bool parts = false;                          ///< with kinds: and its parts
  std::optional<Eigen::Isometry3d> frame = {}; ///< of the parts' boxes: T_frame_model. None: the model's pose
};

/// A box about a part of a triangle, or several neighbouring parts, in which it is unseen.
struct UnseenPart {
  std::uint32_t record;
  bool in_shadow; ///< else in the skin
  Point3 low, high;
};

/// Unseen places are in shadow or in the skin. A place is in shadow if no beam passed it: for each scanner, its
/// direction lies between no beams, or all beams within 1.2 angles of it ended before it. All else that is unseen is
/// skin: beams passed the place, but the ball about it is too near to a border or a surface to be seen.
struct UnseenKinds {
  /// One per record: whether it is unseen and in shadow. A point counts by its place. A triangle is in shadow if the
  /// middle of any unseen part of it is. Its parts have a radius of at most the clearance and its uncertainty, or ten
  /// halvings.
  std::vector<bool> in_shadow;
  /// With `parts`, by record: where triangles are unseen, at most 64 boxes of shadow and 64 of skin each. A triangle
  /// without parts is unseen as a whole and of one kind, or no larger than the ball about a place.
  std::vector<UnseenPart> parts;
};

/// The result of markUnseen().
struct UnseenResult {
  std::size_t unseen = 0;    ///< points that were free and are unseen
  std::size_t in_shadow = 0; ///< with UnseenRequest::kinds: of these, in shadow; the others are in the skin
  UnseenKinds kinds;         ///< with UnseenRequest::kinds
  Work work;                 ///< node_pairs: spheres of the model, and of directions, that were tested
};

/// Turns Verdict::free of a point into Verdict::unseen where no scanner saw the ball about it. Other verdicts stay. All
/// places of a triangle must be seen, each by one scanner. It is halved until balls about its parts are seen, down to
/// an eighth of the clearance and its uncertainty, and to 14 times.
/// @param model at T_scans_model. @param verdicts one per record of its view, such as FlagsResult::b
/// @throws std::invalid_argument naming the value: a clearance, a pose, or a number of verdicts. Cancelled
UnseenResult markUnseen(const SeenSpace& seen, const Placed& model, const UnseenRequest& request,
                        std::vector<Verdict>& verdicts);
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
