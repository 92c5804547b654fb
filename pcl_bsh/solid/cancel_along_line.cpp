// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/cancel_along_line.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace pcl_bsh {
namespace {

/// Edges of one direction at the sweep's place, by ordinal: the first ones are left, the others are cancelled.
class Passing {
public:
  using Key = std::pair<std::size_t, std::size_t>; ///< ordinal, edge

  explicit Passing(std::vector<Point3>& since) : since_(since) {}

  void add(const Key& key) { cancelled_.insert(key); }

  void remove(const Key& key, const Point3& at)
  {
    if (cancelled_.erase(key) != 0) return;
    left_.erase(key);
    close(key, at);
  }

  std::size_t size() const { return left_.size() + cancelled_.size(); }

  /// Leaves the first `count` edges from a place on.
  void leave(std::size_t count, const Point3& at)
  {
    while (left_.size() > count) cancelLast(at);
    while (left_.size() < count) leaveFirst(at);
    while (!left_.empty() && !cancelled_.empty() && *cancelled_.begin() < *left_.rbegin()) {
      leaveFirst(at);
      cancelLast(at);
    }
  }

  /// Visits the parts that end at a place: their edges were left up to there, and are not from there on.
  template <class Visit>
  void visitClosed(const Point3& at, const Visit& visit)
  {
    for (const auto& [key, begin] : closed_)
      if (left_.count(key) == 0) visit(key.second, begin, at);
    closed_.clear();
  }

private:
  void cancelLast(const Point3& at)
  {
    const Key key = *left_.rbegin();
    cancelled_.insert(left_.extract(key));
    close(key, at);
  }
  void leaveFirst(const Point3& at)
  {
    const Key key = *cancelled_.begin();
    left_.insert(cancelled_.extract(key));
    const auto closed = closed_.find(key);
    since_[key.second] = closed == closed_.end() ? at : closed->second;
  }
  void close(const Key& key, const Point3& at)
  {
    if (since_[key.second] != at) closed_.emplace(key, since_[key.second]);
  }

  std::set<Key> left_, cancelled_;
  std::map<Key, Point3> closed_; ///< edges no longer left from the sweep's place on, and where each part began
  std::vector<Point3>& since_;
};

} // namespace

void cancelAlongLine(const std::vector<EdgeOnLine>& edges,
                     const std::function<void(std::size_t, const Point3&, const Point3&)>& visit)
{
  if (edges.size() == 1) return visit(0, edges[0].low, edges[0].high);
  struct End {
    Point3 at;
    std::size_t edge;
    bool begins;
  };
  std::vector<End> ends;
  ends.reserve(2 * edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ends.push_back({edges[i].low, i, true});
    ends.push_back({edges[i].high, i, false});
  }
  std::sort(ends.begin(), ends.end(), [](const End& l, const End& r) { return l.at < r.at; });

  std::vector<Point3> since(edges.size());
  std::array<Passing, 2> passing = {Passing(since), Passing(since)};
  for (auto end = ends.begin(); end != ends.end();) {
    const Point3 at = end->at;
    for (; end != ends.end() && end->at == at; ++end) {
      const EdgeOnLine& edge = edges[end->edge];
      Passing& with = passing[edge.rises ? 1 : 0];
      if (end->begins)
        with.add({edge.ordinal, end->edge});
      else
        with.remove({edge.ordinal, end->edge}, at);
    }
    const std::size_t falling = passing[0].size(), rising = passing[1].size();
    passing[0].leave(falling - std::min(falling, rising), at);
    passing[1].leave(rising - std::min(falling, rising), at);
    for (Passing& with : passing) with.visitClosed(at, visit);
  }
}

} // namespace pcl_bsh
