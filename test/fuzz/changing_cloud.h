// SPDX-License-Identifier: BSD-3-Clause
// A cloud, of points or of triangles, that changes under its hierarchy: it is moved, refitted, updated and built anew,
// its records lie elsewhere in memory each time, and what they were before is overwritten.
#pragma once

#include "bytes.h"
#include "support/random.h"

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <Eigen/Geometry>

#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh::fuzz {

/// Data that the clouds of one sequence share, so that their points meet.
struct World {
  enum class Kind : std::uint8_t {
    grid,    ///< multiples of unit / 8: on faces of voxels, with ties and duplicates
    uniform, ///< [0, 2 unit)^3
    line,
    few, ///< three places, many points each
    outlier,
    crowded, ///< unit 1e-10 apart
    far,     ///< georeferenced: unit / 100 apart, half a million units off
    kinds
  };

  /// @param surfaces some of its clouds are of triangles
  explicit World(Bytes& bytes, bool surfaces = false);

  Point3 place(test::Random& random) const;
  double edge(test::Random& random) const; ///< of voxels; 0: their own choice
  Eigen::Isometry3d pose(test::Random& random) const;
  std::string text() const;

  Kind kind;
  double unit;
  bool surfaces;
};

class ChangingCloud {
public:
  ChangingCloud(const World& world, test::Random& random);

  PointsView view() const { return now_->view; } ///< its records are points or triangles
  std::string text() const;
  const std::shared_ptr<SphereHierarchy>& shared() const { return hierarchy_; }
  const SphereHierarchy& hierarchy() const { return *hierarchy_; }

  // Each says in a few words what it did.
  std::string buildAnew(test::Random& random);
  std::string buildSome(test::Random& random);
  std::string moveObject(test::Random& random);
  /// Moves points, and hands the view to refit(), which is SphereHierarchy's or a scene's.
  template <class Refit>
  std::string deform(test::Random& random, const Refit& refit)
  {
    const std::string what = movePoints(random);
    const Old before = store();
    const RefitReport report = refit(view(), growth(random));
    return what + (report.sorted_anew ? ", sorted anew" : ", refitted");
  }
  std::string refit(test::Random& random);
  std::string update(test::Random& random);

  Eigen::Isometry3d pose;

private:
  /// The caller's memory, spoilt before it is given back: nobody may read it after a change.
  struct Memory {
    ~Memory();
    std::vector<unsigned char> bytes;
    std::vector<float> radii;
    std::vector<std::int32_t> indices;
    std::vector<Triangle> triangles;
    PointsView view;
  };
  using Old = std::unique_ptr<Memory>;

  static double growth(test::Random& random);
  HierarchyOptions options(test::Random& random) const;
  std::string movePoints(test::Random& random);
  Point3 placeOrNone(test::Random& random) const;
  void append(const Point3& point, test::Random& random);
  void appendTriangles(test::Random& random);
  std::string updateTriangles(test::Random& random);
  bool isSurface() const { return kind_ != Kind::points; }
  Old store(); ///< writes the records elsewhere; @return where they were

  enum class Kind : std::uint8_t {
    points,
    triangles,  ///< of any of the points, twice where chance will have it
    tetrahedra, ///< four triangles each, which close
  };

  World world_;
  Kind kind_ = Kind::points;
  bool doubles_, with_radii_, with_subset_;
  std::size_t head_, tail_;
  std::vector<Point3> points_;
  std::vector<float> radii_;
  std::vector<std::int32_t> indices_;
  std::vector<Triangle> triangles_; ///< records of points_
  std::unique_ptr<Memory> now_;
  std::shared_ptr<SphereHierarchy> hierarchy_;
};

} // namespace pcl_bsh::fuzz
