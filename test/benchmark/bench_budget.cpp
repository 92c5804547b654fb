// SPDX-License-Identifier: BSD-3-Clause
// Do time budgets keep their word? The smallest distance of two files of points within budgets of time: how long calls
// take, and how wide their intervals are beside those of the best other setting that takes no longer. Calls that
// something else on the machine interrupted are left out.
#include "posed_files.h"

#include <pcl_bsh/collide.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>

namespace {

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

struct Options : PosedFilesOptions {
  std::vector<double> budgets = {20, 50, 100, 1000};
};

double secondsOn(clockid_t clock)
{
  timespec time;
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Call {
  double seconds = 0.0, width = 0.0;
};

/// @param ask gives the width of the answer. Nothing where the thread did not have a processor for all of the time.
template <typename Ask>
std::optional<Call> timed(const Ask& ask)
{
  const double processor = secondsOn(CLOCK_THREAD_CPUTIME_ID), start = secondsOn(CLOCK_MONOTONIC);
  const double width = ask();
  const double seconds = secondsOn(CLOCK_MONOTONIC) - start;
  if (seconds > secondsOn(CLOCK_THREAD_CPUTIME_ID) - processor) return std::nullopt;
  return Call{seconds, width};
}

std::optional<Call> timed(const SphereHierarchy& a, const SphereHierarchy& b, const Eigen::Isometry3d& pose,
                          const Accuracy& accuracy)
{
  return timed([&] {
    const Interval found = closestPair({a}, {b, pose}, {accuracy}).interval;
    return found.upper - found.lower;
  });
}

/// Looks at the clock until the time is over: later than this, only the machine is.
std::optional<Call> spin(double seconds)
{
  return timed([seconds, start = secondsOn(CLOCK_MONOTONIC)] {
    while (secondsOn(CLOCK_MONOTONIC) - start < seconds) {
    }
    return 0.0;
  });
}

/// The settings that a budget is held against: two to a decade of each kind.
std::vector<Accuracy> otherSettings(double size)
{
  std::vector<Accuracy> settings = {Accuracy::exact()};
  for (const double part : {1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1})
    settings.push_back(Accuracy::tolerance(part * size));
  for (unsigned level = 0; level <= 8; ++level) settings.push_back(Accuracy::level(level));
  for (std::uint64_t count = 30; count < 100'000; count *= 10) {
    settings.push_back(Accuracy::nodePairs(count));
    settings.push_back(Accuracy::nodePairs(3 * count));
  }
  return settings;
}

bool run(const Options& options, Table& table)
{
  const Points points_a = loadPoints(options.a), points_b = loadPoints(options.b);
  const SphereHierarchy a(viewOf(&points_a.data()->x, points_a.size())),
      b(viewOf(&points_b.data()->x, points_b.size()));
  a.buildAll();
  b.buildAll();
  const std::vector<Eigen::Isometry3d> poses = posesAbout(options, points_a, points_b);
  for (const Eigen::Isometry3d& pose : poses) closestPair({a}, {b, pose}); // fits slabs
  progress(options.name + ": other settings");
  std::vector<std::vector<Call>> others(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (const Accuracy& accuracy : otherSettings(boxOf(points_a).diagonal().norm())) {
      std::vector<double> seconds;
      Call call;
      for (unsigned repetition = 0; repetition < std::min(options.repeat, 9u); ++repetition) {
        if (const std::optional<Call> one = timed(a, b, poses[i], accuracy)) {
          call = *one;
          seconds.push_back(call.seconds);
        }
      }
      if (seconds.empty()) continue;
      call.seconds = median(seconds);
      others[i].push_back(call);
    }
  }
  for (const double budget : options.budgets) {
    progress(options.name + ": " + text(budget) + " us");
    const double allowed = 1e-6 * budget;
    std::vector<double> ratios, widths;
    std::size_t calls = 0, in_time = 0, as_narrow = 0, spins = 0, spins_in_time = 0;
    for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
      for (std::size_t i = 0; i < poses.size(); ++i) {
        ++calls;
        if (const std::optional<Call> empty = spin(allowed)) {
          ++spins;
          spins_in_time += empty->seconds <= 1.1 * allowed ? 1 : 0;
        }
        const std::optional<Call> call = timed(a, b, poses[i], Accuracy::time(allowed));
        if (!call) continue;
        double best = std::numeric_limits<double>::infinity();
        for (const Call& other : others[i])
          if (other.seconds <= allowed) best = std::min(best, other.width);
        ratios.push_back(call->seconds / allowed);
        widths.push_back(call->width);
        in_time += call->seconds <= 1.1 * allowed ? 1 : 0;
        as_narrow += call->width <= best * (1.0 + 1e-9) ? 1 : 0;
      }
    }
    if (ratios.empty() || spins == 0) {
      progress("each call was interrupted: left out");
      continue;
    }
    const auto share = [](std::size_t count, std::size_t of) {
      return text(static_cast<double>(count) / static_cast<double>(of), 4);
    };
    table.add({options.name, options.pose, text(budget), std::to_string(calls), std::to_string(calls - ratios.size()),
               share(in_time, ratios.size()), share(spins_in_time, spins), text(quantile(ratios, 0.5)),
               text(quantile(ratios, 0.99)), text(median(widths)), share(as_narrow, ratios.size())});
  }
  return true;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  options.repeat = 200;
  CLI::App app("Times the smallest distance within budgets of time, on two clouds.", "bench_budget");
  options.addTo(app);
  app.add_option("--budgets", options.budgets, "in microseconds")->delimiter(',')->capture_default_str();
  return runProgram(
      app, argc, argv, options,
      Table({"clouds", "pose", "budget [us]", "calls", "interrupted", "within 1.1", "empty loop within 1.1",
             "median / budget", "p99 / budget", "width, median", "no wider than others"}),
      [&](Table& table) { return run(options, table); });
}
