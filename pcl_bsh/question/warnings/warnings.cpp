// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/warnings.h>

#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr std::size_t least_samples = 100; // of a scan
constexpr double coarse_share = 0.1;       // of the clearance
constexpr double far_apart = 10;           // diagonals
constexpr double far_larger = 100;         // times
constexpr double pi = 3.14159265358979323846;
constexpr double most_angle = 4 * pi;

bool isScan(const Spacing& spacing)
{
  return spacing.samples >= least_samples;
}

void append(std::vector<Warning>& warnings, Warning warning)
{
  const auto same = [&](const Warning& other) { return other.text == warning.text; };
  if (std::none_of(warnings.begin(), warnings.end(), same)) warnings.push_back(std::move(warning));
}

} // namespace

double Density::blind() const
{
  return ((input ? input->median : 0.0) + (obstacle ? obstacle->median : 0.0)) / std::sqrt(2.0);
}

bool Density::couldHide(double clearance) const
{
  if (!input && !obstacle) return false;
  return (!input || isScan(*input)) && (!obstacle || isScan(*obstacle)) && blind() > clearance;
}

std::vector<Warning> warningsOf(const NamedCloud& cloud, std::optional<double> clearance, double least_length)
{
  std::vector<Warning> warnings;
  const std::string one = cloud.is_surface ? "triangle" : "point";
  if (cloud.box.isEmpty()) {
    const char* const what = clearance ? "nothing collides with it" : "nothing has a distance from it";
    warnings.push_back({WarningKind::empty, cloud.name + ": has no finite " + one + ": " + what});
  }
  else if (cloud.finite < cloud.points) {
    const std::uint64_t others = cloud.points - cloud.finite;
    warnings.push_back({WarningKind::not_finite,
                        plainText(cloud.name, ": ", others, " of ", cloud.points, ' ', one,
                                  others == 1 ? "s is not finite: it is" : "s are not finite: they are", " left out")});
  }
  if (cloud.loose > 0) {
    const char* const belong = cloud.loose == 1 ? " of its vertices belongs to no face: it is"
                                                : " of its vertices belong to no face: they are";
    warnings.push_back({WarningKind::loose,
                        plainText(cloud.name, ": ", cloud.loose, belong, " no part of the surface that is compared")});
  }
  const double length = clearance.value_or(least_length);
  if (length > 0 && cloud.coordinate_spacing > coarse_share * length) {
    warnings.push_back(
        {WarningKind::coarse, plainText(cloud.name, ": its float32 coordinates lie ", cloud.coordinate_spacing,
                                        " apart, coarse for a ", clearance ? "clearance" : "limit", " of ", length,
                                        ": give float64 coordinates, or ones near the origin")});
  }
  return warnings;
}

std::optional<Warning> warningOfDensity(const NamedCloud& a, const NamedCloud& b, double clearance)
{
  const Density density{a.spacing, b.spacing};
  if (a.box.isEmpty() || b.box.isEmpty() || !density.couldHide(clearance)) return std::nullopt;
  const std::string advice = plainText("the clearance of ", clearance, ": scan more densely, or give a clearance of ",
                                       density.blind(), " at least");
  if (a.spacing && b.spacing) {
    const std::string of_b = a.name == b.name ? "" : plainText(" and ", b.spacing->median, " in ", b.name);
    return Warning{WarningKind::sparse, plainText("points lie ", a.spacing->median, " apart in ", a.name, of_b,
                                                  ": surfaces may touch with no two points within ", advice)};
  }
  const NamedCloud& scan = a.spacing ? a : b;
  return Warning{WarningKind::sparse, plainText("points lie ", scan.spacing->median, " apart in ", scan.name,
                                                ": what was scanned may touch the surface of ",
                                                a.spacing ? b.name : a.name, " with no point within ", advice)};
}

std::optional<Warning> warningOfFrames(const std::string& a, const Eigen::AlignedBox3d& box_a, const std::string& b,
                                       const Eigen::AlignedBox3d& box_b, double clearance)
{
  if (box_a.isEmpty() || box_b.isEmpty()) return std::nullopt;
  const double apart = std::sqrt(box_a.squaredExteriorDistance(box_b));
  const double size = std::max(box_a.diagonal().norm(), box_b.diagonal().norm());
  const bool have_size = size > 1e-12 * apart; // a single place has no size but rounding
  const bool is_far = have_size && apart > clearance && apart > far_apart * size;
  if (!is_far) return std::nullopt;
  return Warning{WarningKind::apart,
                 plainText("the boxes of ", a, " and of ", b, ", with all of its motion, are ", apart,
                           " apart, and neither is larger than ", size,
                           ": check that both have one coordinate system and one unit (--obstacle-unit converts), and "
                           "that poses lead from the frame of ",
                           b, " to that of ", a)};
}

std::optional<Warning> warningOfUnits(const NamedCloud& a, const NamedCloud& b)
{
  if (a.box.isEmpty() || b.box.isEmpty()) return std::nullopt;
  const double size_a = a.box.diagonal().norm(), size_b = b.box.diagonal().norm();
  const bool is_a_larger = size_a > size_b;
  const auto [small, large] = std::minmax(size_a, size_b);
  const bool have_sizes = small > 1e-9 * large; // a single place has no size but rounding
  if (!have_sizes || large < far_larger * small) return std::nullopt;
  return Warning{WarningKind::units,
                 plainText((is_a_larger ? a : b).name, " is ", std::round(large / small), " times as large as ",
                           (is_a_larger ? b : a).name, ": their boxes have diagonals of ", large, " and ", small,
                           ": if one is in millimetres and the other in metres, say, name both units: --input-unit and "
                           "--obstacle-unit, or `unit` and `to_unit` where a file is read")};
}

namespace {

/// Warns of a scanner whose origin is farther from all that it scanned than ten times the size of that.
std::optional<Warning> warningOfOrigins(const Question& question, const NamedCloud& input)
{
  if (!question.seen || input.box.isEmpty()) return std::nullopt;
  const double size = input.box.diagonal().norm();
  for (const ScanOrigins::Entry& entry : question.origin.entries) {
    const double apart = input.box.exteriorDistance(Eigen::Vector3d(entry.origin.data()));
    if (!(size > 1e-12 * apart && apart > far_apart * size)) continue;
    ScanOrigins one = question.origin;
    one.entries = {entry};
    return Warning{WarningKind::apart, plainText("`origin` ", one.text(), " is ", apart, " from the box of ",
                                                 input.name, ", which is no larger than ", size,
                                                 ": check that both have one coordinate system and one unit, and that ",
                                                 input.name, " is the whole scan: else hardly anything is seen")};
  }
  return std::nullopt;
}

} // namespace

std::vector<Warning> warningsOf(const Question& question, const NamedCloud& input, const NamedCloud& obstacle)
{
  const std::optional<double>& clearance = question.clearance;
  double least_length = std::numeric_limits<double>::infinity();
  for (const double length :
       {question.max_distance.value_or(least_length), question.limits.least, question.limits.most})
    if (length > 0.0 && length < least_length) least_length = length;
  std::vector<Eigen::Isometry3d> poses = question.poses();
  for (Eigen::Isometry3d& pose : poses) pose = question.pose_of_input.inverse() * pose;
  std::vector<Warning> warnings = warningsOf(input, clearance, least_length);
  for (Warning& warning : warningsOf(obstacle, clearance, least_length)) append(warnings, std::move(warning));
  if (auto far =
          warningOfFrames(input.name, input.box, obstacle.name, boxAlong(obstacle.box, poses), clearance.value_or(0.0)))
    warnings.push_back(std::move(*far));
  else if (auto units = warningOfUnits(input, obstacle))
    warnings.push_back(std::move(*units));
  if (auto far = warningOfOrigins(question, input)) warnings.push_back(std::move(*far));
  if (!clearance) return warnings;
  if (auto sparse = warningOfDensity(input, obstacle, *clearance)) warnings.push_back(std::move(*sparse));
  return warnings;
}

Warning warningOfIgnored(const std::string& name, const IgnoredPoints& ignored, const CountedPoints& counted)
{
  std::string terms;
  for (std::size_t t = 0; t < ignored.terms.size(); ++t)
    terms += plainText(terms.empty() ? "" : ", ", counted.ignored[t], " of ", ignored.terms[t].text());
  return {WarningKind::ignored, plainText(name, ": ", counted.all, " of ", counted.all + counted.records.size(),
                                          " points do not count: ", terms)};
}

std::optional<std::string> warningOfAngles(double roll, double pitch, double yaw)
{
  const double angle = std::max({std::abs(roll), std::abs(pitch), std::abs(yaw)});
  if (!(angle > most_angle)) return std::nullopt;
  return plainText("an angle of ", angle, " radians is ", angle / (2 * pi), " turns: give radians: ", angle,
                   " degrees are ", angle * pi / 180);
}

void addOnce(std::string text, std::vector<std::string>& texts)
{
  if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(std::move(text));
}

void addTexts(const std::vector<Warning>& warnings, std::vector<std::string>& texts)
{
  for (const Warning& warning : warnings) addOnce(warning.text, texts);
}

std::vector<Warning> WarningsOnce::unheard(std::vector<Warning> warnings)
{
  const auto bitOf = [](const Warning& warning) { return std::uint32_t{1} << static_cast<unsigned>(warning.kind); };
  const auto heard = [&, told = told_](const Warning& warning) { return (told & bitOf(warning)) != 0; };
  warnings.erase(std::remove_if(warnings.begin(), warnings.end(), heard), warnings.end());
  for (const Warning& warning : warnings) told_ |= bitOf(warning);
  return warnings;
}

} // namespace pcl_bsh
