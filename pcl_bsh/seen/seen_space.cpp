// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/seen_space.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/hierarchy/view_check.h>
#include <pcl_bsh/seen/beam_spacing.h>
#include <pcl_bsh/seen/storage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl_bsh {
namespace {

constexpr double kLeastAngle = 1e-4, kMostAngle = 0.25;

double angleOf(const BeamTree& beams, double asked)
{
  if (beams.beams().size() < 2) return 0.0;
  if (asked > 0.0) return asked;
  const double spacing = beamSpacing(beams);
  return spacing > 0.0 ? std::clamp(1.5 * spacing, kLeastAngle, kMostAngle) : 0.0;
}

} // namespace

void checkBeamAngle(double angle)
{
  if (angle >= kLeastAngle && angle <= kMostAngle) return;
  throw InvalidInput(Input::seen, "angle that a beam speaks for", plainText(angle, " radians"),
                     plainText("give one in [", kLeastAngle, ", ", kMostAngle, "], such as 0.002"))
      .withValue(angle);
}

void checkScan(const ScanBeams& scan, std::size_t index)
{
  const std::string name = "scan " + std::to_string(index);
  const auto refuse = [&](const std::string& what, const std::string& wrong, const char* remedy) {
    throw InvalidInput(Input::seen, name + ": " + what, wrong, remedy).withIndex(index);
  };
  if (!isFinite(scan.origin))
    refuse("origin", plainText(scan.origin[0], ' ', scan.origin[1], ' ', scan.origin[2]), "give finite coordinates");
  if (!(std::isfinite(scan.misses_beyond) && scan.misses_beyond >= 0.0))
    refuse("range of no return", plainText(scan.misses_beyond), "give a finite length >= 0");
  for (const PointsView* view : {&scan.returns, &scan.misses}) {
    checkView(name, *view);
    checkLengths(name, *view);
  }
  if (scan.returns.count + scan.misses.count > 0xffffffffu) refuse("beams", "are too many", "divide the scan");
}

SeenScan::SeenScan(const ScanBeams& scan, double angle, unsigned threads)
: beams_(scan),
  angle_(angleOf(beams_, angle)),
  speaks_(angle_),
  passes_(angle_, kBetweenOfAngle),
  holes_(beams_, angle_, threads)
{
}

bool SeenScan::sees(const BallView& ball, std::uint64_t& tested) const
{
  if (angle_ == 0.0 || !ball.isMeasured()) return false;
  double chord = 2.0;
  if (!ball.is_around) {
    const double cone = ball.coneAngle();
    if (holes_.meets(Cone(ball.direction, cone + kMarginOfAngle * angle_), tested)) return false;
    chord = chordOf(cone + speaks_.reach) + 2.0 * kDirectionError;
  }
  else if (holes_.hasAny()) {
    return false;
  }
  const double farthest = ball.farthest / speaks_.sure * (1.0 + kBallViewSlack);
  return !beams_.any(
      [&](const BeamNode& node) {
        ++tested;
        return static_cast<double>(node.least) <= farthest && !areDisjoint(ball.direction, chord, node);
      },
      [&](const Beam& beam) {
        if (static_cast<double>(beam.empty) > farthest || isBeyond(ball.direction, chord, beam)) return false;
        const BeamEnd given = beamOf(beams_.scan(), beam.record);
        return leavesOpen(ball, given.way, given.empty, speaks_);
      });
}

bool SeenScan::seesNoneIn(const BallView& ball, double least, std::uint64_t& tested) const
{
  if (angle_ == 0.0) return true;
  if (ball.is_around || !ball.isMeasured()) return false;
  // Each direction to a place in it is in a hole, or has a beam within the reach that ends before the nearest one.
  const double nearest = (ball.distance - ball.radius + least) * (1.0 - 0x1p-20);
  if (!(nearest < std::numeric_limits<float>::max())) return false; // ranges are stored no greater
  const double chord = chordOf(ball.coneAngle() + speaks_.reach) + 2.0 * kDirectionError;
  return !beams_.any(
      [&](const BeamNode& node) {
        ++tested;
        return static_cast<double>(node.greatest) > nearest && !areDisjoint(ball.direction, chord, node);
      },
      [&](const Beam& beam) {
        return static_cast<double>(beam.empty) > nearest && !isBeyond(ball.direction, chord, beam);
      });
}

bool SeenScan::isDark(const BallView& place, std::uint64_t& tested) const
{
  if (angle_ == 0.0 || !place.isMeasured()) return true;
  if (place.is_around) return false;
  if (holes_.meets(Cone(place.direction, place.coneAngle()), tested)) return true;
  const double chord = chordOf(passes_.reach) + 4.0 * kDirectionError;
  // Ranges are stored no greater than a float.
  const double least =
      std::min(place.distance * (1.0 - 0x1p-20), 0.5 * static_cast<double>(std::numeric_limits<float>::max()));
  return !beams_.any(
      [&](const BeamNode& node) {
        ++tested;
        return static_cast<double>(node.greatest) >= least && !areDisjoint(place.direction, chord, node);
      },
      [&](const Beam& beam) {
        if (static_cast<double>(beam.empty) < least || isBeyond(place.direction, chord, beam)) return false;
        const BeamEnd given = beamOf(beams_.scan(), beam.record);
        return passes(place, given.way, given.empty, passes_);
      });
}

SeenSpace::SeenSpace(const std::vector<ScanBeams>& scans, const SeenOptions& options) : storage_(new Storage)
{
  const DefaultFloatEnvironment environment;
  if (options.angle) checkBeamAngle(*options.angle);
  if (scans.empty()) throw InvalidInput(Input::seen, "scans", "there are none", "give one at least, with its origin");
  for (std::size_t i = 0; i < scans.size(); ++i) checkScan(scans[i], i);
  const unsigned threads = threadCount(options.threads);
  for (const ScanBeams& scan : scans) storage_->scans.emplace_back(scan, options.angle.value_or(0.0), threads);
}

SeenSpace::~SeenSpace() = default;
SeenSpace::SeenSpace(SeenSpace&&) noexcept = default;
SeenSpace& SeenSpace::operator=(SeenSpace&&) noexcept = default;

std::size_t SeenSpace::size() const noexcept
{
  return storage_->scans.size();
}

double SeenSpace::angle(std::size_t scan) const noexcept
{
  return storage_->scans[scan].angle();
}

std::size_t SeenSpace::beams(std::size_t scan) const noexcept
{
  return storage_->scans[scan].size();
}

} // namespace pcl_bsh
