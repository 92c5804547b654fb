// SPDX-License-Identifier: BSD-3-Clause
// A robot as its questions see it: balls about its shapes, and trees of these on each body.
#pragma once

#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/shapes/shape.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::robots {

inline constexpr std::uint32_t kNoPart = 0xffffffffu;
inline constexpr int kMostCorners = 1024; ///< of a hull: each step of a distance looks at all

/// A solid or a mesh of a link, in the frame of its body.
struct Piece {
  std::optional<Solid> solid; ///< none: a mesh
  const SphereHierarchy* surface = nullptr;
  Kinematics::Pose pose; ///< T_body_piece
  std::size_t link = 0, shape = 0;
  Eigen::MatrixX3d corners = {}; ///< of a mesh: all of it is in their hull. Empty: more than kMostCorners
};

/// Holds a piece, a patch of a mesh, or other balls of its body.
struct Ball {
  Eigen::Vector3d center; ///< in the body's frame
  double radius = 0.0;    ///< with the link's padding
  double spread = 0.0;    ///< radius of the places whose motion counts: 0 of a sphere, its centre alone
  std::size_t body = 0;
  std::uint32_t piece = kNoPart;         ///< it holds this or a patch of it; none: more than one
  bool is_sphere = false;                ///< the piece is this ball, less the padding
  double padding = 0.0;                  ///< of the piece
  std::uint32_t first = 0, count = 0;    ///< balls that it holds, one after another
  std::uint32_t record = 0, records = 0; ///< of a patch: range of Parts::records
  std::vector<double> axis_distances;    ///< from the axes of the chain (kinematics.h)
  std::vector<double> doubts; ///< per joint of the chain: how far uncertain joints from it on move the places that
                              ///< count; empty: not at all
};

/// Two links to be compared, by the balls that hold them, and the last body that both hang on: motions are seen from
/// it.
struct LinkPair {
  std::uint32_t a = 0, b = 0;
  std::size_t common = 0;
};

struct Parts {
  /// @param joint_uncertainties of a state's values; empty: they are certain
  /// @throws InvalidInput for a mesh that was not read
  Parts(const Robot& robot, const Kinematics& kinematics, const std::vector<double>& joint_uncertainties);

  std::vector<Piece> pieces;
  std::vector<Ball> balls;
  std::vector<std::uint32_t> records;           ///< of meshes, patch by patch
  std::vector<std::uint32_t> of_bodies;         ///< of each body the ball that holds all, or kNoPart
  std::vector<LinkPair> pairs;                  ///< of links
  std::vector<std::vector<std::size_t>> chains; ///< of each body
  double extent = 0.0;                          ///< nothing is farther from the origin of its body
};

} // namespace pcl_bsh::robots
