// SPDX-License-Identifier: BSD-3-Clause
// Options of every query beside its question: how sure its answer has to be, how many threads it uses, and who watches
// its progress.
//
//   anyCollision({hall}, {robot, T}, {0.05, {Accuracy::tolerance(0.01), 4}}); // on four threads
//   request.progress = [&](double done) { return !quit; };                    // of any request
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/accuracy.h>

#include <functional>
#include <utility>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The base of all requests.
struct Effort {
  Effort() = default;
  /** All. */ Effort(const Accuracy& how_sure, unsigned on_threads = 1, std::function<bool(double)> report = {})
  : accuracy(how_sure),
    threads(on_threads),
    progress(std::move(report))
  {
  }
  /** Exact. */ Effort(unsigned on_threads, std::function<bool(double)> report = {})
  : threads(on_threads),
    progress(std::move(report))
  {
  }

  Accuracy accuracy;    ///< exact, unless the caller asks for less; queries that are always exact refuse any other
  unsigned threads = 1; ///< 0: all of the machine's; queries that say so take one
  /// Called now and then, by the thread that asks, with the fraction done in [0, 1], which never falls, and at least
  /// once where there is anything to do. A search for pairs counts the pairs it began with: it may tell little until it
  /// ends. False: stop, the query throws Cancelled. An exception that it throws comes out of the query.
  std::function<bool(double)> progress;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
