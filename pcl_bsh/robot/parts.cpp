// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/robot/outward.h>
#include <pcl_bsh/robot/parts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pcl_bsh::robots {

namespace {

constexpr std::size_t kChildren = 4;
constexpr std::size_t kPatches = 128;      ///< a mesh has no more
constexpr std::size_t kPatchTriangles = 2; ///< a patch of so many triangles is not halved

struct Corners : std::array<Eigen::Vector3d, 3> {
  std::uint32_t record = 0;
};

std::vector<Corners> trianglesOf(const PointsView& view)
{
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::array<Point3, 3> t = view.triangles->triangle(view.record(i));
    if (!(isFinite(t[0]) && isFinite(t[1]) && isFinite(t[2]))) continue;
    triangles.emplace_back();
    triangles.back().record = view.record(i);
    for (std::size_t k = 0; k < 3; ++k) triangles.back()[k] = Eigen::Vector3d(t[k][0], t[k][1], t[k][2]);
  }
  return triangles;
}

Eigen::MatrixX3d cornersOf(const std::vector<Corners>& triangles)
{
  std::vector<Eigen::Vector3d> all;
  for (const Corners& triangle : triangles) all.insert(all.end(), triangle.begin(), triangle.end());
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  all.erase(std::unique(all.begin(), all.end()), all.end());
  if (all.size() > std::size_t{kMostCorners}) return {};
  Eigen::MatrixX3d corners(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t i = 0; i < all.size(); ++i) corners.row(static_cast<Eigen::Index>(i)) = all[i];
  return corners;
}

class Maker {
public:
  Maker(Parts& parts, const Robot& robot, const Kinematics& kinematics, const std::vector<double>& joint_uncertainties)
  : parts_(parts),
    robot_(robot),
    kinematics_(kinematics),
    joint_uncertainties_(joint_uncertainties)
  {
  }

  void make()
  {
    const std::size_t bodies = kinematics_.bodies().size();
    std::vector<std::vector<Ball>> links_of_body(bodies);
    std::vector<std::uint32_t> of_links(robot_.links.size(), kNoPart);
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      std::vector<Ball> balls = ballsOf(i);
      if (balls.empty()) continue;
      of_links[i] = add(root(std::move(balls)));
      links_of_body[kinematics_.bodyOf(i)].push_back(parts_.balls[of_links[i]]);
    }
    for (std::size_t body = 0; body < bodies; ++body) {
      parts_.chains.push_back(kinematics_.chain(body));
      parts_.of_bodies.push_back(links_of_body[body].empty() ? kNoPart : add(root(std::move(links_of_body[body]))));
    }
    for (Ball& ball : parts_.balls) {
      ball.axis_distances = kinematics_.axisDistances(ball.body, ball.center, ball.spread);
      if (!joint_uncertainties_.empty()) ball.doubts = doubtsOf(ball);
      parts_.extent = std::max(parts_.extent, ball.center.norm() + ball.radius);
    }
    addPairs(of_links);
  }

private:
  /// A turn moves a place by no more than its angle times the distance from the axis. A slide beyond the joint's limits
  /// adds to the distances from the axes before it.
  std::vector<double> doubtsOf(const Ball& ball) const
  {
    const std::vector<std::size_t>& chain = parts_.chains[ball.body];
    std::vector<double> doubts(chain.size());
    double sum = 0.0, slid = 0.0;
    for (std::size_t i = chain.size(); i-- > 0;) {
      const Kinematics::Body& body = kinematics_.bodies()[chain[i]];
      const bool slides = body.kind == Joint::Kind::prismatic;
      const double off = std::abs(body.multiplier) * joint_uncertainties_[body.variable];
      sum += off * (slides ? 1.0 : ball.axis_distances[i] + slid);
      if (slides) slid += off;
      doubts[i] = kOutward * sum;
    }
    return doubts;
  }

  std::uint32_t add(Ball ball)
  {
    parts_.balls.push_back(std::move(ball));
    return static_cast<std::uint32_t>(parts_.balls.size() - 1);
  }

  std::vector<Ball> ballsOf(std::size_t link)
  {
    std::vector<Ball> balls;
    const Link& of = robot_.links[link];
    for (std::size_t i = 0; i < of.shapes.size(); ++i) {
      const Shape& shape = of.shapes[i];
      const Eigen::Isometry3d pose = kinematics_.inBody(link) * shape.pose;
      Piece piece{solidOf(shape), nullptr, {pose.linear(), pose.translation()}, link, i};
      Ball ball;
      ball.body = kinematics_.bodyOf(link);
      ball.center = pose.translation();
      if (piece.solid) {
        ball.radius = kOutward * enclosingRadius(*piece.solid);
        ball.is_sphere = std::holds_alternative<Sphere>(*piece.solid);
        if (ball.is_sphere) ball.radius = enclosingRadius(*piece.solid);
      }
      else {
        const auto& mesh = std::get<Mesh>(shape.form);
        if (!mesh.surface || !mesh.surface->view().triangles)
          throw InvalidInput(Input::scene, "link '" + of.name + "'",
                             "has the mesh " + mesh.path + ", which is not read", "read it first");
        if (mesh.surface->empty()) continue;
        piece.surface = mesh.surface.get();
        std::vector<Corners> triangles = trianglesOf(mesh.surface->view());
        piece.corners = cornersOf(triangles);
        for (Corners& triangle : triangles)
          for (Eigen::Vector3d& corner : triangle) corner = pose * corner;
        ball.piece = static_cast<std::uint32_t>(parts_.pieces.size());
        ball.padding = of.padding;
        Ball whole = root(patchesOf(std::move(triangles), ball));
        whole.piece = ball.piece;
        whole.padding = of.padding;
        parts_.pieces.push_back(std::move(piece));
        balls.push_back(std::move(whole));
        continue;
      }
      ball.spread = ball.is_sphere ? 0.0 : ball.radius;
      ball.padding = of.padding;
      ball.radius += of.padding;
      ball.piece = static_cast<std::uint32_t>(parts_.pieces.size());
      parts_.pieces.push_back(std::move(piece));
      balls.push_back(std::move(ball));
    }
    return balls;
  }

  /// Balls about triangles that are near to each other. @param like gives the members that all have
  std::vector<Ball> patchesOf(std::vector<Corners> triangles, const Ball& like)
  {
    const std::size_t most = std::max(kPatchTriangles, (triangles.size() + kPatches - 1) / kPatches);
    std::vector<std::pair<std::size_t, std::size_t>> ranges = {{0, triangles.size()}};
    std::vector<Ball> patches;
    while (!ranges.empty()) {
      const auto [begin, end] = ranges.back();
      ranges.pop_back();
      Eigen::AlignedBox3d box, middles;
      for (std::size_t i = begin; i < end; ++i) {
        for (const Eigen::Vector3d& corner : triangles[i]) box.extend(corner);
        middles.extend(middleOf(triangles[i]));
      }
      if (end - begin > most) {
        const std::size_t middle = (begin + end) / 2;
        int axis = 0;
        middles.sizes().maxCoeff(&axis);
        const auto at = [&](std::size_t i) { return triangles.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end),
                         [&](const Corners& a, const Corners& b) { return middleOf(a)[axis] < middleOf(b)[axis]; });
        ranges.insert(ranges.end(), {{begin, middle}, {middle, end}});
        continue;
      }
      patches.push_back(like);
      Ball& patch = patches.back();
      patch.center = box.center();
      patch.record = static_cast<std::uint32_t>(parts_.records.size());
      patch.records = static_cast<std::uint32_t>(end - begin);
      for (std::size_t i = begin; i < end; ++i) parts_.records.push_back(triangles[i].record);
      for (std::size_t i = begin; i < end; ++i)
        for (const Eigen::Vector3d& corner : triangles[i])
          patch.spread = std::max(patch.spread, kOutward * (corner - patch.center).norm());
      patch.radius = patch.spread + patch.padding;
    }
    return patches;
  }

  static Eigen::Vector3d middleOf(const Corners& triangle) { return (triangle[0] + triangle[1] + triangle[2]) / 3.0; }

  static Ball holding(const Ball* begin, const Ball* end)
  {
    Eigen::AlignedBox3d box;
    for (const Ball* ball = begin; ball != end; ++ball) {
      box.extend(Eigen::Vector3d(ball->center.array() - ball->radius));
      box.extend(Eigen::Vector3d(ball->center.array() + ball->radius));
    }
    Ball all;
    all.center = box.center();
    all.body = begin->body;
    for (const Ball* ball = begin; ball != end; ++ball) {
      const double way = (ball->center - all.center).norm();
      all.radius = std::max(all.radius, kOutward * (way + ball->radius));
      all.spread = std::max(all.spread, kOutward * (way + ball->spread));
    }
    return all;
  }

  /// Returns one ball that holds all. The balls that it holds are added to the parts.
  Ball root(std::vector<Ball> balls)
  {
    if (balls.size() == 1) return balls[0];
    // Halves along the longest axis, until there are as many parts as a ball has children.
    std::vector<std::pair<std::size_t, std::size_t>> ranges = {{0, balls.size()}};
    while (ranges.size() < std::min(kChildren, balls.size())) {
      const auto widest = std::max_element(ranges.begin(), ranges.end(), [](const auto& a, const auto& b) {
        return a.second - a.first < b.second - b.first;
      });
      const auto [begin, end] = *widest;
      Eigen::AlignedBox3d box;
      for (std::size_t i = begin; i < end; ++i) box.extend(balls[i].center);
      int axis = 0;
      box.sizes().maxCoeff(&axis);
      const std::size_t middle = (begin + end) / 2;
      const auto at = [&](std::size_t i) { return balls.begin() + static_cast<std::ptrdiff_t>(i); };
      std::stable_sort(at(begin), at(end),
                       [&](const Ball& a, const Ball& b) { return a.center[axis] < b.center[axis]; });
      *widest = {begin, middle};
      ranges.insert(std::upper_bound(ranges.begin(), ranges.end(), std::pair(begin, middle)), {middle, end});
    }
    Ball all = holding(balls.data(), balls.data() + balls.size());
    std::vector<Ball> children;
    for (const auto& [begin, end] : ranges)
      children.push_back(
          root({balls.begin() + static_cast<std::ptrdiff_t>(begin), balls.begin() + static_cast<std::ptrdiff_t>(end)}));
    all.first = static_cast<std::uint32_t>(parts_.balls.size());
    all.count = static_cast<std::uint32_t>(children.size());
    for (Ball& child : children) add(std::move(child));
    return all;
  }

  void addPairs(const std::vector<std::uint32_t>& of_links)
  {
    for (const auto& [a, b] : comparedLinks(robot_, kinematics_)) {
      if (of_links[a] == kNoPart || of_links[b] == kNoPart) continue;
      const auto &chain_a = parts_.chains[kinematics_.bodyOf(a)], &chain_b = parts_.chains[kinematics_.bodyOf(b)];
      const auto parted = std::mismatch(chain_a.begin(), chain_a.end(), chain_b.begin(), chain_b.end()).first;
      parts_.pairs.push_back({of_links[a], of_links[b], parted == chain_a.begin() ? 0 : *(parted - 1)});
    }
  }

  Parts& parts_;
  const Robot& robot_;
  const Kinematics& kinematics_;
  const std::vector<double>& joint_uncertainties_;
};

} // namespace

Parts::Parts(const Robot& robot, const Kinematics& kinematics, const std::vector<double>& joint_uncertainties)
{
  Maker(*this, robot, kinematics, joint_uncertainties).make();
}

} // namespace pcl_bsh::robots
