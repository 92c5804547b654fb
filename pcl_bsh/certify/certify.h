// SPDX-License-Identifier: BSD-3-Clause
// Proof that no point lies outside the spheres above it, and how much larger than necessary these spheres are.
//
//   Certificate certificate = certify(hierarchy);
//   if (!certificate.holds()) ...                 // certificate.leaks names the points
//   certificate.total.ratio.mean();               // stored radius over the smallest possible one
//
// Compiled, this links CGAL's Bounding_volumes: GPL-3.0-or-later. See LICENSE in this folder.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Options of certify(): its sample, and how many threads it uses.
struct CertifyOptions {
  static constexpr std::size_t all = ~std::size_t{0};

  /// How many spheres of each level are compared with the smallest ones. Containment is checked for every sphere.
  std::size_t sample = 1000;
  std::uint64_t seed = 1; ///< of the sample
  unsigned threads = 1;   ///< 0: all of the machine's; the certificate is the same for any number
  /// Called now and then with the share that is done, from 0 to 1; by one thread at a time, not always the caller's.
  std::function<void(double)> progress;
};

/// Where in a hierarchy a sphere is.
struct SphereLevel {
  /// Which of the trees.
  enum Kind : std::uint8_t {
    above_voxels, ///< in the tree whose leaves are voxels
    voxel,        ///< the one around a voxel's origin
    in_voxel      ///< in a voxel's own tree
  };
  Kind kind = above_voxels;
  unsigned depth = 0; ///< 0: the root's children; 0 for `voxel`
};

/// A point outside a sphere that should hold it.
struct Leak {
  SphereLevel level;
  std::size_t voxel = 0;    ///< that holds the point
  std::uint32_t node = 0;   ///< of the tree that `level` speaks of
  std::uint32_t child = 0;  ///< of the node
  std::uint32_t record = 0; ///< of the point, in the cloud's view
  double excess = 0.0;      ///< how far the point, or its ball, sticks out, in the cloud's unit; > 0
};

/// Stored radius over the smallest radius, of the spheres that were measured.
struct RadiusRatios {
  /// histogram[i] counts ratios below edges[i] and not below edges[i - 1]; the last all others.
  static constexpr std::array<double, 7> edges = {1.001, 1.01, 1.05, 1.1, 1.2, 1.5, 2.0};

  std::size_t measured = 0;
  std::size_t one_place = 0; ///< spheres of a single place, whose smallest radius is 0: they have no ratio
  double worst = 0.0;
  double sum = 0.0;
  std::array<std::size_t, edges.size() + 1> histogram = {}; ///< one more than `edges`

  /// Mean of the measured ratios; 0 where none was measured.
  double mean() const noexcept { return measured == 0 ? 0.0 : sum / static_cast<double>(measured); }
};

/// Findings of certify() on one level of the tree.
struct LevelCertificate {
  SphereLevel level;
  std::size_t spheres = 0;
  std::size_t checks = 0;       ///< points looked at, over all spheres
  std::size_t exact_checks = 0; ///< of these, decided in rationals; double arithmetic with its bound sufficed otherwise
  std::size_t leaks = 0;
  RadiusRatios ratio; ///< none for SphereLevel::voxel, whose sphere is not meant to be small
};

/// Result of certify().
struct Certificate {
  static constexpr std::size_t most_leaks = 100;

  std::vector<LevelCertificate> levels; ///< from the top down
  LevelCertificate total;               ///< of all levels; its `level` has no meaning
  std::vector<Leak> leaks;              ///< the first, in the order of voxels and levels
  std::size_t missing = 0;              ///< finite points of the view that no leaf holds

  /// Whether every point is where queries look for it.
  bool holds() const noexcept { return total.leaks == 0 && missing == 0; }
};

/// Checks every sphere of the hierarchy against every point below it, on the numbers exactly as stored and given;
/// builds the voxels that are not built yet. The smallest spheres are CGAL's, in exact arithmetic: Gaertner, Fast and
/// Robust Smallest Enclosing Balls (ESA 1999); Fischer and Gaertner, The Smallest Enclosing Ball of Balls (SoCG 2003).
/// Apart from its spheres, the tree must be sound (SphereHierarchy::validate()).
Certificate certify(const SphereHierarchy& hierarchy, const CertifyOptions& options = {});

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
