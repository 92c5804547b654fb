// SPDX-License-Identifier: BSD-3-Clause
// Made worlds of planes, boxes and spheres, and what scanners among them measure.
#pragma once

#include "made_scans.h"

#include <array>

namespace pcl_bsh::test {

/// Space that is before all planes, and in no box or sphere, is empty.
struct MadeWorld {
  struct Plane {
    Eigen::Vector3d normal;
    double offset; ///< empty: normal . x < offset
  };
  struct Box {
    Eigen::Isometry3d pose;
    Eigen::Vector3d half;
  };
  struct Sphere {
    Eigen::Vector3d center;
    double radius;
  };
  std::vector<Plane> planes;
  std::vector<Box> boxes;
  std::vector<Sphere> spheres;

  /// Along a unit vector to the first surface. @pre the origin is in what is empty
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& way) const
  {
    double nearest = 1e9;
    for (const Plane& plane : planes) {
      const double towards = plane.normal.dot(way);
      if (towards > 0.0) nearest = std::min(nearest, (plane.offset - plane.normal.dot(origin)) / towards);
    }
    for (const Sphere& sphere : spheres) {
      const Eigen::Vector3d to = sphere.center - origin;
      const double along = to.dot(way), under = along * along - to.squaredNorm() + sphere.radius * sphere.radius;
      if (under > 0.0 && along > 0.0) nearest = std::min(nearest, along - std::sqrt(under));
    }
    for (const Box& box : boxes) {
      const Eigen::Array3d from = (box.pose.inverse() * origin).array();
      const Eigen::Array3d by = (box.pose.linear().transpose() * way).array();
      const Eigen::Array3d a = (-box.half.array() - from) / by, b = (box.half.array() - from) / by;
      const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
      if (enter < leave && enter > 0.0) nearest = std::min(nearest, enter);
    }
    return nearest;
  }

  /// From a place to the nearest surface; negative in what is not empty.
  double distance(const Eigen::Vector3d& place) const
  {
    double nearest = 1e9;
    for (const Plane& plane : planes) nearest = std::min(nearest, plane.offset - plane.normal.dot(place));
    for (const Sphere& sphere : spheres) nearest = std::min(nearest, (place - sphere.center).norm() - sphere.radius);
    for (const Box& box : boxes) {
      const Eigen::Vector3d beside = (box.pose.inverse() * place).cwiseAbs() - box.half;
      const double outside = beside.cwiseMax(0.0).norm();
      nearest = std::min(nearest, outside > 0.0 ? outside : beside.maxCoeff());
    }
    return nearest;
  }
};

/// A random world, its scans and places in it. Boxes and spheres are wider than two of the angle, seen from each
/// scanner.
struct ScannedWorld {
  explicit ScannedWorld(Random& random)
  : step(random.uniform(0.02, 0.1)),
    angle(1.5 * step),
    clearance(random.chance(0.1) ? 0.0 : std::pow(10.0, random.uniform(-3.5, -0.7))),
    random_(random)
  {
    makeWorld();
    for (const Eigen::Vector3d& origin : origins) addScan(origin);
    addPlaces();
  }

  std::vector<ScanBeams> scans() const
  {
    std::vector<ScanBeams> all;
    for (std::size_t s = 0; s < origins.size(); ++s) {
      ScanBeams scan;
      scan.origin = {origins[s].x(), origins[s].y(), origins[s].z()};
      scan.returns = viewOf(ends[s].data(), ends[s].size() / 3);
      all.push_back(scan);
    }
    return all;
  }

  double step, angle, clearance; ///< of beams, in radians; a length
  MadeWorld world;
  std::vector<Eigen::Vector3d> origins;
  std::vector<std::vector<double>> ends; ///< of beams, of each scanner
  std::vector<double> places;

private:
  Eigen::Vector3d anywhere(double reach = 1.0)
  {
    const double x = random_.uniform(-reach, reach), y = random_.uniform(-reach, reach);
    return {x, y, random_.uniform(-reach, reach)};
  }

  Eigen::Matrix3d anyTurn()
  {
    const Eigen::Vector3d axis = anywhere().normalized();
    return Eigen::AngleAxisd(random_.uniform(-kPi, kPi), axis).toRotationMatrix();
  }

  /// From the farthest scanner.
  double farthest(const Eigen::Vector3d& place) const
  {
    double range = 0.0;
    for (const Eigen::Vector3d& origin : origins) range = std::max(range, (place - origin).norm());
    return range;
  }

  bool isEmptyAtScanners(const MadeWorld& of) const
  {
    return std::all_of(origins.begin(), origins.end(), [&](const auto& origin) { return of.distance(origin) > 0.05; });
  }

  void makeWorld()
  {
    const double room = random_.uniform(3, 10);
    for (int k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0})
        world.planes.push_back({side * Eigen::Vector3d::Unit(k), room * random_.uniform(0.4, 1.0)});
    for (int i = random_.integer(1, 2); i > 0; --i) origins.push_back(anywhere(0.3 * room));
    for (int i = random_.integer(0, 2); i > 0; --i) { // slants, as near as that
      const Eigen::Vector3d normal = anywhere().normalized();
      double offset = -1e9;
      for (const Eigen::Vector3d& origin : origins) offset = std::max(offset, normal.dot(origin));
      world.planes.push_back({normal, offset + random_.uniform(0.02, 2.0)});
    }
    for (int i = random_.integer(2, 7); i > 0; --i) {
      const Eigen::Vector3d at = origins[0] + random_.uniform(1.0, room) * anywhere().normalized();
      const double least = angle * farthest(at);
      MadeWorld one;
      if (i % 3 == 0) {
        one.spheres.push_back({at, least * random_.uniform(1.0, 4.0)});
      }
      else {
        MadeWorld::Box box{Eigen::Isometry3d(Eigen::Translation3d(at)), Eigen::Vector3d::Zero()};
        if (random_.chance(0.5)) box.pose.linear() = anyTurn();
        for (double& half : box.half) half = least * random_.uniform(1.0, 4.0);
        one.boxes.push_back(box);
      }
      if (!isEmptyAtScanners(one)) continue;
      world.boxes.insert(world.boxes.end(), one.boxes.begin(), one.boxes.end());
      world.spheres.insert(world.spheres.end(), one.spheres.begin(), one.spheres.end());
    }
  }

  /// Rows and columns about any axis: even, uneven, of narrower columns, or with gaps; in any order.
  void addScan(const Eigen::Vector3d& origin)
  {
    const Eigen::Matrix3d turn = random_.chance(0.5) ? anyTurn() : Eigen::Matrix3d::Identity();
    const int kind = random_.integer(0, 3);
    const double uneven = kind == 1 ? 0.3 * step : 0.0, column = kind == 2 ? step * random_.uniform(0.2, 1.0) : step;
    const double lowest = random_.uniform(-1.5, -0.5), highest = lowest + random_.uniform(0.8, 2.0);
    const double last = random_.uniform(1.0, 6.28), hole = random_.uniform(0.0, 8.0) * step;
    const double hole_up = random_.uniform(lowest, highest), hole_around = random_.uniform(0.0, last);
    std::vector<std::array<double, 3>> beams;
    for (double up = lowest; up <= std::min(highest, 1.55); up += step)
      for (double around = 0.0; around <= last; around += column / std::max(0.05, std::cos(up))) {
        const double e = up + uneven * random_.uniform(-0.5, 0.5);
        const double a = around + uneven * random_.uniform(-0.5, 0.5) / std::max(0.05, std::cos(up));
        if (kind == 3 && std::hypot(e - hole_up, (a - hole_around) * std::cos(e)) < hole) continue;
        if (kind == 3 && random_.chance(0.02)) continue;
        const Eigen::Vector3d way =
            turn * Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        const Eigen::Vector3d end = origin + world.cast(origin, way) * way;
        beams.push_back({end.x(), end.y(), end.z()});
      }
    for (std::size_t i = beams.size(); i > 1; --i)
      std::swap(beams[i - 1], beams[static_cast<std::size_t>(random_.integer(0, static_cast<int>(i) - 1))]);
    ends.emplace_back();
    for (const auto& end : beams) ends.back().insert(ends.back().end(), end.begin(), end.end());
  }

  void addPlaces()
  {
    const auto add = [&](const Eigen::Vector3d& place) {
      places.insert(places.end(), {place.x(), place.y(), place.z()});
    };
    for (std::size_t s = 0; s < origins.size(); ++s) {
      const auto beams = static_cast<int>(ends[s].size() / 3);
      for (int i = 0; i < 1500; ++i) { // beside beams
        const Eigen::Vector3d end(&ends[s][3 * static_cast<std::size_t>(random_.integer(0, beams - 1))]);
        const Eigen::Vector3d aside = 2.0 * angle * anywhere();
        const Eigen::Vector3d way = ((end - origins[s]).normalized() + aside).normalized();
        const double range = world.cast(origins[s], way);
        const double off = i % 3 == 0   ? range * random_.uniform(-1.0, 0.2)
                           : i % 3 == 1 ? clearance * random_.uniform(-3, 3)
                                        : range * angle * random_.uniform(-1.5, 1.0);
        add(origins[s] + (range + off) * way);
      }
      for (const MadeWorld::Box& box : world.boxes) // before edges and corners
        for (int i = 0; i < 100; ++i) {
          Eigen::Vector3d corner;
          for (double& x : corner) x = random_.chance(0.5) ? 1.0 : -1.0;
          if (i % 2 == 0) corner[random_.integer(0, 2)] = random_.uniform(-1, 1);
          const Eigen::Vector3d way = box.pose * corner.cwiseProduct(box.half) - origins[s];
          const double share = 1.0 + angle * random_.uniform(-1.0, 0.3);
          add(origins[s] + share * way + clearance * anywhere());
        }
    }
  }

  Random& random_;
};

} // namespace pcl_bsh::test
