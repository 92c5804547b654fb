// SPDX-License-Identifier: BSD-3-Clause
// The parts of a question about a site. Each visits tiles once, and adds its results to the answer.
#pragma once

#include <pcl_bsh/site/ask_site.h>

#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::site {

/// A site where it stands, with how uncertain its points are.
struct PlacedSite {
  const Site& site;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Uncertainty uncertainty = {};
};

/// A part of a question. The obstacle is a thing in memory whose hierarchy is built, or another site.
struct QuestionPart {
  Question question; ///< its progress is that of the part
  SiteMeans means;
  const Site& site;
  Shape* shape = nullptr;
  const Site* other = nullptr;

  double clearance() const { return question.clearance.value_or(0.0); }
  const SphereHierarchy& model() const { return shape->hierarchy(); } ///< @pre it is in memory

  /// The input, and the obstacle where it is a site, as they stand: with their uncertainties, or as they were measured.
  PlacedSite input() const { return {site, Eigen::Isometry3d::Identity(), question.uncertaintyOfInput()}; }
  PlacedSite measuredInput() const { return {site}; }
  std::optional<PlacedSite> obstacle() const
  {
    return other ? std::optional(PlacedSite{*other, question.pose, question.uncertaintyOfObstacle()}) : std::nullopt;
  }
  std::optional<PlacedSite> measuredObstacle() const
  {
    return other ? std::optional(PlacedSite{*other, question.pose}) : std::nullopt;
  }
};

/// Refuses answers that sites do not have. @throws InvalidInput
void requireAnswers(const Question& question, bool obstacle_is_site);

/// Builds the hierarchy of an obstacle in memory and, where it counts as a solid, what its faces enclose.
/// @throws InvalidOption for a solid without faces, and as Shape does
void build(const Question& question, Shape& obstacle);

/// The facts that site.json states; no tile is read.
NamedCloud namedSite(const Site& site);

void findAny(const QuestionPart& part, SiteAnswer& answer);
void flag(const QuestionPart& part, SiteAnswer& answer);         ///< flags the input, and an obstacle in memory
void flagObstacle(const QuestionPart& part, SiteAnswer& answer); ///< flags an obstacle that is a site
void findClosest(const QuestionPart& part, SiteAnswer& answer);
void measure(const QuestionPart& part, SiteAnswer& answer);
void followPath(const QuestionPart& part, SiteAnswer& answer);

/// Tells the unseen records of obstacles that are asked about the same scans.
/// @param each gets `unseen` and `obstacle_flags` of an obstacle. @param all gets the tiles that were read, and beams
void lookAround(const std::vector<const QuestionPart*>& parts, const std::vector<Answer*>& each, SiteAnswer& all);

/// Returns the warning of question/warnings/hollow.h about an obstacle in memory that is not asked as a solid. There is
/// one where its faces enclose a place of the site, and no point of the site is near the faces. Reads up to four of the
/// tiles that meet its box at some pose.
/// @param name of the site.
/// @param nearest the smallest distance that the answer tells; none: it tells none. The smallest distance is computed
///   then, where there is such a place
std::optional<Warning> warningOfHollow(const QuestionPart& part, const std::string& name,
                                       std::optional<double> nearest);

} // namespace pcl_bsh::site
