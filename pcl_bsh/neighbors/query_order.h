// SPDX-License-Identifier: BSD-3-Clause
// Many queries in an order that visits neighbouring places one after another, so that what one query has brought into
// the caches serves the next.
#pragma once

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/prefetch.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

/// The numbers [0, queries.size()) by the Morton code of the query's place in the cloud's bounds; queries that are not
/// finite come last. Each thread orders a stretch of its own, so the order of many queries depends on how many threads
/// there are.
/// @pre checkView() accepts the queries
std::vector<std::uint32_t> queryOrder(const SphereHierarchy::Storage& cloud, const PointsView& queries,
                                      unsigned threads);

/// Calls body(i, point) for each point that the view names, the i-th, in the DefaultFloatEnvironment. The body returns
/// how many pairs of nodes would have taken as long. Calls expect(i, soon) twice before that, to prefetch what the
/// answer needs: early with soon = false, and shortly before with soon = true.
/// @throws InvalidInput for an accuracy other than exact. Cancelled
template <class Expect, class Body>
void forEachQuery(const SphereHierarchy::Storage& cloud, const PointsView& queries, const Effort& effort,
                  const Expect& expect, const Body& body)
{
  constexpr std::size_t kAhead = 8; // queries between a record's being fetched and its use
  constexpr std::size_t kSoon = 4;
  constexpr std::size_t kShare = 256; // enough to make up for handing it to a thread, few enough to share out evenly
  checkExact(effort);
  const DefaultFloatEnvironment environment;
  Progress progress(effort.progress);
  const unsigned threads = threadCount(effort.threads);
  const std::vector<std::uint32_t> order = queryOrder(cloud, queries, threads);
  const std::size_t shares = (order.size() + kShare - 1) / kShare;
  progress.begin(1.0, shares);
  parallelFor(shares, threads, [&](std::size_t share) {
    if (progress.stopped()) return;
    const std::size_t end = std::min(order.size(), (share + 1) * kShare);
    Pulse pulse;
    for (std::size_t k = share * kShare; k < end; ++k) {
      if (k + kAhead < end) {
        prefetch(queries, queries.record(order[k + kAhead]));
        expect(order[k + kAhead], false);
      }
      if (k + kSoon < end) expect(order[k + kSoon], true);
      pulse.count(body(order[k], queries.point(queries.record(order[k]))));
    }
    progress.step();
  });
  progress.end();
}

} // namespace pcl_bsh
