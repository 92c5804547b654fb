// SPDX-License-Identifier: BSD-3-Clause
// Warnings that go with a question's answer, as each program, filter and package tells them. Their conditions and
// sentences stand here alone.
//
//   for (const Warning& warning : warningsOf(question, measuredCloud("hall.ply", hall), namedCloud("robot", robot)))
//     tell(warning.text);
//
// ask() (ask.h) has them in its answer.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/named_cloud.h>
#include <pcl_bsh/question/question.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// How wide the holes between points are that a collision may hide in.
struct Density {
  std::optional<Spacing> input, obstacle; ///< none of a surface, which has no holes

  /// Half a hole each: where two surfaces touch, a point of one may be this far from the nearest of the other.
  double blind() const;

  /// Clouds of less than a hundred points are no scans, and have no density.
  bool couldHide(double clearance) const;
};

/// The subject of a warning.
enum class WarningKind : std::uint8_t {
  empty,      ///< no finite point
  not_finite, ///< some points are not
  loose,      ///< vertices of a surface that no face has
  coarse,     ///< float32 coordinates that are coarse for the clearance, or for limits of distances
  sparse,     ///< surfaces may touch while no two points are within the clearance
  apart,      ///< boxes far from each other: not in one frame, perhaps
  unguarded,  ///< a density guard of a surface
  hollow,     ///< faces close round what counts as free
  units,      ///< one is hundreds of times as large as the other: millimetres and metres, perhaps
  ignored,    ///< some points do not count, as was asked
};

/// One sentence for users, which names the cloud and says what to do.
struct Warning {
  WarningKind kind;
  std::string text;
};

/// Returns all warnings of a question about two clouds, in memory or not. A sentence about two clouds of one name that
/// would be told twice is told once.
std::vector<Warning> warningsOf(const Question& question, const NamedCloud& input, const NamedCloud& obstacle);

/// Returns the warnings of one cloud by itself: empty, not finite, loose vertices, coarse.
/// @param least_length without a clearance, the least length that distances are compared with
std::vector<Warning> warningsOf(const NamedCloud& cloud, std::optional<double> clearance,
                                double least_length = std::numeric_limits<double>::infinity());

/// Warns where holes between points may hide a collision within the clearance. Needs the spacing of one cloud at least.
std::optional<Warning> warningOfDensity(const NamedCloud& a, const NamedCloud& b, double clearance);

/// Warns of boxes, in one frame, that are farther apart than the clearance and ten times the diagonal of either. Each
/// box holds all of the motion of its thing.
std::optional<Warning> warningOfFrames(const std::string& a, const Eigen::AlignedBox3d& box_a, const std::string& b,
                                       const Eigen::AlignedBox3d& box_b, double clearance);

/// Warns where one box is a hundred times as large as the other, or more, by their diagonals.
std::optional<Warning> warningOfUnits(const NamedCloud& a, const NamedCloud& b);

/// Tells how many points of a cloud do not count, by each term.
Warning warningOfIgnored(const std::string& name, const IgnoredPoints& ignored, const CountedPoints& counted);

/// Warns of angles, in radians, of more than two turns: degrees, perhaps. The text begins without a name.
std::optional<std::string> warningOfAngles(double roll, double pitch, double yaw);

/// Appends a sentence, unless it is there.
void addOnce(std::string text, std::vector<std::string>& texts);

/// Appends the sentence of each warning, unless it is there.
void addTexts(const std::vector<Warning>& warnings, std::vector<std::string>& texts);

/// For callers that ask about a stream of clouds: tells each kind of warning in one question only.
class WarningsOnce {
public:
  /// Returns the warnings of kinds that no earlier call had.
  std::vector<Warning> unheard(std::vector<Warning> warnings);

private:
  std::uint32_t told_ = 0; ///< a bit for each kind
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
