// SPDX-License-Identifier: BSD-3-Clause
#include "study.h"

#include "stopwatch.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pcl_bsh::accuracy {
namespace {

enum class Query { any, flags, distance };

const char* nameOf(Query query)
{
  return query == Query::any ? "any" : query == Query::flags ? "flags" : "distance";
}

const char* knobOf(const Accuracy& accuracy)
{
  switch (accuracy.mode) {
  case Accuracy::Mode::tolerance:
    return "tolerance";
  case Accuracy::Mode::level:
    return "level of detail";
  case Accuracy::Mode::node_pairs:
    return "budget of tests";
  case Accuracy::Mode::time:
    return "time budget";
  case Accuracy::Mode::exact:
    break;
  }
  return "exact";
}

/// The true results at a pose, to judge the others by.
struct Truth {
  Verdict any;
  std::vector<Verdict> flags;
  double distance;
};

/// One setting on its way through the repetitions.
struct Trial {
  Accuracy accuracy;
  Query query;
  Measurement measurement;
  std::vector<std::vector<double>> seconds; ///< of each pose, one a repetition
};

class Laboratory {
public:
  Laboratory(const Subject& subject, unsigned threads)
  : subject_(subject),
    a_(subject.a),
    b_(subject.b),
    threads_(threads)
  {
    a_.buildAll(threads);
    b_.buildAll(threads);
    for (const Eigen::Isometry3d& pose : subject.poses) {
      FlagsResult flags = collisionFlags({a_}, {b_, pose}, flagsRequest({}));
      truths_.push_back({anyCollision({a_}, {b_, pose}, anyRequest({})).verdict, std::move(flags.a),
                         closestPair({a_}, {b_, pose}).distance});
    }
  }

  std::size_t colliding() const
  {
    std::size_t count = 0;
    for (const Truth& truth : truths_) count += countOf(truth.flags, Verdict::colliding);
    return count;
  }

  /// Adds the seconds of one query at each pose.
  void time(Query query, const Accuracy& accuracy, std::vector<std::vector<double>>& seconds) const
  {
    seconds.resize(subject_.poses.size());
    // Each query is asked once before it is timed, because an earlier query of another kind may have filled the caches
    // with other memory. PCL's ways are repeated, too.
    for (const Eigen::Isometry3d& pose : subject_.poses) ask(query, accuracy, {a_}, {b_, pose});
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      const Stopwatch watch(threads_);
      ask(query, accuracy, {a_}, {b_, subject_.poses[i]});
      seconds[i].push_back(watch.seconds());
    }
  }

  /// Seconds of one query about clouds that nothing was asked about before, at each pose.
  Spread timeOnce(Query query, const Accuracy& accuracy, unsigned repetitions) const
  {
    std::vector<std::vector<double>> seconds(subject_.poses.size());
    HierarchyOptions options;
    options.threads = threads_;
    for (unsigned repetition = 0; repetition < repetitions; ++repetition) {
      for (std::size_t i = 0; i < seconds.size(); ++i) {
        const Stopwatch watch(threads_);
        const SphereHierarchy a(subject_.a, options), b(subject_.b, options);
        ask(query, accuracy, {a}, {b, subject_.poses[i]});
        seconds[i].push_back(watch.seconds());
      }
    }
    return spreadOfPoses(seconds);
  }

  /// Judges the answers at a setting.
  Measurement judge(Query query, const Accuracy& accuracy) const
  {
    Measurement m;
    m.query = nameOf(query);
    m.knob = knobOf(accuracy);
    m.setting = accuracy.text();
    m.poses = subject_.poses.size();
    double answers = 0.0, undecided = 0.0;
    for (std::size_t i = 0; i < subject_.poses.size(); ++i) {
      const Placed b{b_, subject_.poses[i]};
      const Truth& truth = truths_[i];
      if (query == Query::any) {
        const AnyResult result = anyCollision({a_}, b, anyRequest(accuracy));
        answers += 1;
        undecided += result.verdict == Verdict::undecided ? 1 : 0;
        m.wrong += result.verdict != Verdict::undecided && result.verdict != truth.any ? 1 : 0;
        m.work += result.work;
      }
      else if (query == Query::flags) {
        const FlagsResult result = collisionFlags({a_}, b, flagsRequest(accuracy));
        answers += static_cast<double>(a_.size());
        undecided += static_cast<double>(result.undecided_a);
        for (std::size_t k = 0; k < result.a.size(); ++k)
          m.wrong += result.a[k] != Verdict::undecided && result.a[k] != truth.flags[k];
        m.work += result.work;
      }
      else {
        const DistanceResult result = closestPair({a_}, b, {accuracy});
        m.certified_error = std::max(m.certified_error, result.interval.upper - result.interval.lower);
        m.actual_error = std::max(m.actual_error, std::abs(result.distance - truth.distance));
        m.work += result.work;
      }
    }
    if (query == Query::distance) {
      // The width of an exact answer is the rounding of the number given.
      if (accuracy.isExact()) m.certified_error = 0.0;
    }
    else {
      m.certified_error = undecided / answers;
      m.actual_error = static_cast<double>(m.wrong) / answers;
    }
    return m;
  }

private:
  void ask(Query query, const Accuracy& accuracy, const Placed& a, const Placed& b) const
  {
    if (query == Query::any) anyCollision(a, b, anyRequest(accuracy));
    if (query == Query::flags) collisionFlags(a, b, flagsRequest(accuracy));
    if (query == Query::distance) closestPair(a, b, {accuracy});
  }

  AnyRequest anyRequest(const Accuracy& accuracy) const { return {subject_.clearance, accuracy}; }

  FlagsRequest flagsRequest(const Accuracy& accuracy) const
  {
    FlagsRequest request;
    request.clearance = subject_.clearance;
    request.threads = threads_;
    request.accuracy = accuracy;
    return request;
  }

  const Subject& subject_;
  SphereHierarchy a_, b_;
  unsigned threads_;
  std::vector<Truth> truths_;
};

/// The settings to measure: exact, tolerances from a millionth of the diameter up, levels until nothing is left open,
/// and budgets of tests and of time, up to twice the exact time.
std::vector<Accuracy> dialOf(Query query, const Laboratory& laboratory, const Subject& subject)
{
  const double diameter = subject.diameter;
  std::vector<Accuracy> dial = {Accuracy::exact()};
  for (const double part : {1e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2})
    dial.push_back(Accuracy::tolerance(roundLength(part * diameter)));
  if (query == Query::distance)
    for (const double length : subject.tolerances) dial.push_back(Accuracy::tolerance(length));
  for (unsigned level = 0; level <= 16; ++level) {
    dial.push_back(Accuracy::level(level));
    if (laboratory.judge(query, dial.back()).certified_error <= 1e-9 * diameter) break;
  }
  std::vector<std::vector<double>> seconds;
  laboratory.time(query, Accuracy::exact(), seconds);
  const double exact = spreadOfPoses(seconds).median;
  for (const char* text : {"1e-5", "3e-5", "1e-4", "3e-4", "0.001", "0.003", "0.01", "0.03", "0.1", "0.3", "1", "3"}) {
    const Accuracy budget = Accuracy::parse(std::string("time=") + text);
    if (budget.value >= exact / 300.0 && budget.value <= 2.0 * exact) dial.push_back(budget);
  }
  const std::uint64_t tests = laboratory.judge(query, Accuracy::exact()).work.node_pairs;
  for (std::uint64_t count = 100; count < tests; count *= 10) {
    dial.push_back(Accuracy::nodePairs(count));
    if (3 * count < tests) dial.push_back(Accuracy::nodePairs(3 * count));
  }
  return dial;
}

FitMeasurement measureFit(const Subject& subject, SphereFit fit, const char* name, unsigned repetitions,
                          unsigned threads)
{
  FitMeasurement m;
  m.fit = name;
  std::vector<double> build, flags, distance;
  for (unsigned i = 0; i < repetitions; ++i) {
    HierarchyOptions options;
    options.fit = fit;
    options.threads = threads;
    const Stopwatch watch(threads);
    const SphereHierarchy a(subject.a, options), b(subject.b, options);
    a.buildAll(threads);
    b.buildAll(threads);
    build.push_back(watch.seconds());
    FlagsRequest request;
    request.clearance = subject.clearance;
    request.threads = threads;
    const auto timed = [&](const auto& ask) {
      const Stopwatch query(threads);
      for (const Eigen::Isometry3d& pose : subject.poses) ask(Placed{b, pose});
      return query.seconds() / static_cast<double>(subject.poses.size());
    };
    flags.push_back(timed([&](const Placed& placed) { collisionFlags({a}, placed, request); }));
    distance.push_back(timed([&](const Placed& placed) { closestPair({a}, placed); }));
    m.mean_leaf_radius = a.statistics().mean_leaf_radius;
  }
  m.build = spreadOf(build);
  m.flags = spreadOf(flags);
  m.distance = spreadOf(distance);
  return m;
}

} // namespace

Spread spreadOf(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const auto at = [&](double part) {
    return values[static_cast<std::size_t>(std::lround(part * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.25), at(0.5), at(0.75)};
}

Spread spreadOfPoses(const std::vector<std::vector<double>>& samples)
{
  if (samples.size() == 1) return spreadOf(samples.front());
  std::vector<double> medians;
  for (const std::vector<double>& of_pose : samples) medians.push_back(spreadOf(of_pose).median);
  return spreadOf(medians);
}

double roundLength(double length)
{
  const double decade = std::floor(std::log10(length));
  const double lead = length / std::pow(10.0, decade);
  const int rounded = lead < std::sqrt(3.0) ? 1 : lead < std::sqrt(30.0) ? 3 : 10;
  return std::strtod((std::to_string(rounded) + "e" + std::to_string(static_cast<int>(decade))).c_str(), nullptr);
}

double roundLengthDown(double length)
{
  const int digits = 1 - static_cast<int>(std::floor(std::log10(length)));
  for (double units = std::floor(length * std::pow(10.0, digits)); units > 0.0; --units) {
    const double rounded =
        std::strtod((std::to_string(static_cast<int>(units)) + "e" + std::to_string(-digits)).c_str(), nullptr);
    if (rounded <= length) return rounded;
  }
  return length;
}

Study runStudy(const Subject& subject, unsigned repetitions, unsigned threads, const Progress& progress)
{
  Study study;
  progress("building and exact answers", 0.0);
  const Laboratory laboratory(subject, threads);
  study.colliding = laboratory.colliding();
  std::vector<Trial> trials;
  for (const Query query : {Query::any, Query::flags, Query::distance}) {
    progress(std::string("range of the dial for ") + nameOf(query), 0.05);
    for (const Accuracy& accuracy : dialOf(query, laboratory, subject))
      trials.push_back({accuracy, query, laboratory.judge(query, accuracy), {}});
  }
  for (unsigned repetition = 0; repetition < repetitions; ++repetition) {
    progress("repetition " + std::to_string(repetition + 1) + " of " + std::to_string(repetitions),
             0.1 + 0.5 * repetition / repetitions);
    for (Trial& trial : trials) laboratory.time(trial.query, trial.accuracy, trial.seconds);
  }
  progress("asked once", 0.6);
  const unsigned few = std::min(repetitions, 3u);
  for (Trial& trial : trials) {
    trial.measurement.seconds = spreadOfPoses(trial.seconds);
    trial.measurement.once = laboratory.timeOnce(trial.query, trial.accuracy, few);
    study.measurements.push_back(std::move(trial.measurement));
  }
  progress("fits of spheres", 0.8);
  study.fits.push_back(measureFit(subject, SphereFit::box_center, "box centre", few, threads));
  study.fits.push_back(measureFit(subject, SphereFit::ritter, "Ritter", few, threads));
  study.fits.push_back(measureFit(subject, SphereFit::minimal, "minimal", few, threads));
  return study;
}

} // namespace pcl_bsh::accuracy
