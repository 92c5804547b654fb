// SPDX-License-Identifier: BSD-3-Clause
// Which place of one cloud is the farthest from another cloud, as an interval that becomes narrower.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/query/record_distance.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// Diagonal of the box around all that a view has, in the clouds' unit; of triangles, around their corners.
double diagonalOf(const PointsView& view);

class FarthestPlace {
public:
  /// Measures all points of a, or all corners of its triangles. @param work gets what is done
  /// @param tolerance pieces that may be farther than what is known by no more than this are not divided
  FarthestPlace(const Placed& a, const Placed& b, double tolerance, unsigned threads, Work& work);

  /// Holds the distance of the farthest place.
  Interval interval() const;

  double distance() const { return farthest_distance_; } ///< of the farthest place that was measured
  PointPair pair() const { return farthest_; }           ///< its record, and the nearest of b

  /// Divides some pieces, those that may be the farthest.
  /// @param known no distance up to this is of interest @return how many; 0: none is left
  std::size_t divide(double known);

private:
  /// A piece of a triangle of a.
  struct Piece {
    double upper; ///< none of its places is farther than this
    std::uint32_t record;
    std::uint32_t depth;
    std::array<std::uint32_t, 3> corners; ///< their places
  };
  /// Whether `one` is less important than `other`. This orders all pieces, so that nothing depends on threads.
  static bool precedes(const Piece& one, const Piece& other);

  /// Where a piece is cut: a side, by its first corner, and how far along.
  struct Cut {
    std::size_t side;
    double share;
  };

  void measureRecords();
  void addTriangles();
  void measure(std::size_t from);
  void note(double distance, double error, PointPair pair);
  void keep(std::vector<Piece>& pieces, double known);
  double boundOf(const Piece& piece, const RecordDistance& of_places) const;
  Cut cutOf(const Piece& piece) const;
  double crossing(std::uint32_t from, std::uint32_t to) const;
  double roughDistance(const Eigen::Vector3d& at, std::uint32_t record) const;
  double mostOf(std::uint32_t place) const;
  PointsView viewOfPlaces(std::size_t from) const;
  double lengthBetween(std::uint32_t place, std::uint32_t other) const;

  const Placed& a_;
  const Placed& b_;
  const double tolerance_;
  const unsigned threads_;
  Work& work_;
  const Eigen::Isometry3d in_b_; ///< takes places of a into the frame of b
  double largest_ = 0.0;         ///< coordinate of a

  // Places, in the order in which they were measured.
  std::vector<Point3> places_;         ///< in a's own frame
  std::vector<double> distance_;       ///< from b, rounded to nearest
  std::vector<double> error_;          ///< how far the place may be from the one that it stands for
  std::vector<std::uint32_t> nearest_; ///< of b
  std::vector<std::uint32_t> record_;  ///< of a

  std::vector<Piece> waiting_; ///< a heap: the one that may be the farthest first
  double settled_; ///< no place of the pieces that do not wait is farther, unless it is no farther than known
  double lower_;
  double farthest_distance_;
  PointPair farthest_;
};

} // namespace pcl_bsh
