// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/ask_site.h>

#include <pcl_bsh/geometry/coordinate_spacing.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/question/warnings/hollow.h>
#include <pcl_bsh/site/answers/question_part.h>
#include <pcl_bsh/site/site_clashes.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh::site {

namespace {

/// Answers that no site has. Options have their column in the table of options.
struct NoAnswer {
  const char* name;
  bool Wanted::*member;
  const char* remedy;
};

constexpr NoAnswer no_answers[] = {{"indices", &Wanted::indices, "ask for flags, which a receiver gets"},
                                   {"obstacle_indices", &Wanted::obstacle_indices, "ask for flags of the obstacle"},
                                   {"both_ways", &Wanted::both_ways, "ask once more, with the roles exchanged"},
                                   {"within", &Wanted::within, "ask for distances, which a receiver gets"}};

} // namespace

void requireAnswers(const Question& question, bool obstacle_is_site)
{
  for (const QuestionOption& row : questionOptions()) {
    const bool of_site = row.of_sites == OptionOfSites::none;
    if (textOf(row, question).empty() || row.of_sites == OptionOfSites::all || (!of_site && !obstacle_is_site))
      continue;
    throw InvalidOption(row.name,
                        of_site ? "is not answered of sites" : "is not answered of an obstacle that is a site",
                        of_site ? "leave it out" : "give a cloud or a mesh, or leave it out");
  }
  for (const NoAnswer& row : no_answers)
    if (question.wanted.*row.member) throw InvalidInput(Input::result, row.name, "is not told of sites", row.remedy);
  if (!question.pose_of_input.matrix().isIdentity(0.0))
    throw InvalidInput(Input::pose, "pose_of_input", "is given, and a site stands where it is",
                       "give the obstacle's pose in its frame");
  const Wanted& wanted = question.wanted;
  if (wanted.obstacle_flags && (wanted.contacts || wanted.poses || wanted.first_poses))
    throw InvalidInput(Input::result, "obstacle_flags", "are not told of sites beside contacts", "ask twice");
  if (question.path && wanted.distances)
    throw InvalidOption("path", "has no distances but those of what collides", "give one pose");
  if (question.swept > 0.0 && wanted.poses)
    throw InvalidOption("swept", "is given, and what a site meets is told of each pose", "leave out one of them");
  if (obstacle_is_site && wanted.distances && question.accuracy.stopsEarly())
    throw InvalidOption("accuracy", question.accuracy.text() + ": distances of two sites cannot stop early",
                        "give exact or tolerance=LENGTH");
}

NamedCloud namedSite(const Site& site)
{
  NamedCloud cloud;
  cloud.name = site.folder.string();
  cloud.points = site.points;
  for (const Tile& tile : site.tiles)
    if (tile.bounds) cloud.finite += tile.points; // points that are not finite have tiles of their own
  cloud.spacing.emplace();
  cloud.spacing->samples = cloud.finite;
  cloud.spacing->median = spacingOf(site);
  if (!site.bounds) return cloud;
  cloud.box = Eigen::AlignedBox3d(Eigen::Vector3d::Map(site.bounds->low.data()),
                                  Eigen::Vector3d::Map(site.bounds->high.data()));
  for (const pcl::PCLPointField& field : site.fields) {
    if (field.name != "x" || field.datatype != pcl::PCLPointField::FLOAT32) continue;
    cloud.coordinate_spacing =
        float32Spacing(cloud.box.min().cwiseAbs().cwiseMax(cloud.box.max().cwiseAbs()).maxCoeff());
  }
  return cloud;
}

void build(const Question& question, Shape& obstacle)
{
  obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads);
  if (!question.solid) return;
  if (!obstacle.isSurface())
    throw InvalidOption("solid", obstacle.name() + " has no faces", "give a mesh that closes, or leave it out");
  obstacle.solid(); // refused before a tile is read
}

namespace {

/// Answers one question about a site and an obstacle.
class SiteAsking {
public:
  SiteAsking(const Question& question, const Site& site, Shape* shape, const Site* other, const SiteMeans& means)
  : question_(question),
    part_{question, means, site, shape, other}
  {
    if (means.clashes) part_.question.wanted.contacts = true;
    requireAnswers(part_.question, other != nullptr);
    if (visits() > 1 && means.answers && question.wanted.measures())
      throw InvalidInput(Input::result, "answers", "are kept of one visit to each tile", "ask for distances alone");
    if (shape) build(question, *shape);
  }

  SiteAnswer answer()
  {
    const Wanted& wanted = question_.wanted;
    if (isAlongPath())
      visit(followPath);
    else if (wantsFlags())
      visit(flag);
    if (wantsFlagsOfSite()) {
      part_.means.answers = nullptr; // those are of the tiles of the input
      visit(flagObstacle);
    }
    if (wanted.any) visit(findAny);
    if (wantsClosest()) visit(findClosest);
    if (wanted.distances) visit(measure);
    part_.question.progress = nullptr;
    part_.means.answers = nullptr;
    if (question_.seen) lookAround({&part_}, {&answer_}, answer_);
    if (part_.shape) {
      answer_.obstacle_colliding = countOf(answer_.obstacle_flags, Verdict::colliding);
      answer_.obstacle_undecided = countOf(answer_.obstacle_flags, Verdict::undecided);
    }
    warn();
    return std::move(answer_);
  }

private:
  bool isAlongPath() const
  {
    const Wanted& wanted = part_.question.wanted;
    return wanted.contacts || wanted.poses || wanted.first_poses ||
           (question_.path && (wanted.flags || wanted.closest));
  }
  bool wantsFlags() const
  {
    const bool of_obstacle = question_.wanted.obstacle_flags && part_.shape && !question_.seen; // `seen` tells them
    return question_.wanted.flags || of_obstacle;
  }
  bool wantsFlagsOfSite() const { return question_.wanted.obstacle_flags && part_.other; }
  bool wantsClosest() const { return question_.wanted.closest && !isAlongPath(); }

  int visits() const
  {
    const Wanted& wanted = question_.wanted;
    return (isAlongPath() || wantsFlags()) + wantsFlagsOfSite() + wanted.any + wantsClosest() + wanted.distances;
  }

  /// Each visit has its share of the progress.
  void visit(void (*answerPart)(const QuestionPart&, SiteAnswer&))
  {
    const double begun = begun_++, all = visits();
    if (question_.progress)
      part_.question.progress = [this, begun, all](double done) { return question_.progress((begun + done) / all); };
    answerPart(part_, answer_);
  }

  void warn()
  {
    const NamedCloud input = namedSite(part_.site);
    const bool spacings = question_.wanted.spacings;
    answer_.warnings =
        warningsOf(question_, input, part_.shape ? part_.shape->facts(spacings) : namedSite(*part_.other));
    std::optional<double> nearest;
    if (part_.question.wanted.collisions())
      nearest = nearestOf(part_.question, answer_);
    else if (question_.wanted.closest)
      nearest = answer_.closest.distance;
    if (auto hollow = warningOfHollow(part_, input.name, nearest)) answer_.warnings.push_back(std::move(*hollow));
  }

  const Question& question_;
  QuestionPart part_;
  int begun_ = 0; ///< visits so far
  SiteAnswer answer_;
};

} // namespace

TilesRead& TilesRead::operator+=(const TilesRead& visit)
{
  tiles = std::max(tiles, visit.tiles);
  needed = std::max(needed, visit.needed);
  read += visit.read;
  costs.insert(costs.end(), visit.costs.begin(), visit.costs.end());
  return *this;
}

SiteAnswer ask(const Question& question, const Site& site, Shape& obstacle, const SiteMeans& means)
{
  checkOptions(question);
  return SiteAsking(question, site, &obstacle, nullptr, means).answer();
}

SiteAnswer ask(const Question& question, const Site& site, const Site& obstacle, const SiteMeans& means)
{
  checkOptions(question);
  return SiteAsking(question, site, nullptr, &obstacle, means).answer();
}

void check(const Question& question, bool obstacle_is_site)
{
  pcl_bsh::check(question);
  requireAnswers(question, obstacle_is_site);
}

} // namespace pcl_bsh::site
