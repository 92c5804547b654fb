// SPDX-License-Identifier: BSD-3-Clause
// The stack of a depth-first search that several threads empty together, in the order in which one thread would.
#pragma once

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/query/result.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh {

/// Steps of a search before it is shared. They cost less than waking another thread.
inline constexpr std::uint32_t kStepsAlone = 512;

/// Steps on a piece before a thread gives it back.
inline constexpr std::uint32_t kStepsOfPiece = 256;

/// Tells a search when to pause: after some steps, or when what it looks for is of no use any more.
struct Pause {
  std::uint32_t steps = kStepsAlone;
  const std::atomic<bool>* dropped = nullptr;

  /// Returns whether to pause; if not, counts a step.
  bool stops()
  {
    if (steps == 0 || (dropped && dropped->load(std::memory_order_relaxed))) return true;
    --steps;
    return false;
  }
};

/// Pairs still to be visited, kept as a list of pieces in the order of the depth-first search. A thread takes pairs
/// from the first piece that waits, visits them and what is below for some steps, and puts back what is left in their
/// place. A find ends the search of all pieces behind it, and of no piece before it. So the first find in depth-first
/// order wins, whichever thread is the fastest, and the work up to it is that of one thread.
template <class Pair>
class SharedStack {
public:
  struct Piece {
    enum class State : std::uint8_t { waiting, taken, visited };

    State state = State::waiting;
    std::vector<Pair> pairs;          ///< still to be visited, the next one last
    std::optional<PointPair> found;   ///< in this piece, so that its other pairs need not be visited
    Work work;                        ///< of what was visited
    std::atomic<bool> dropped{false}; ///< nothing here matters any more: give it back soon
  };

  /// @param pairs the next one last
  explicit SharedStack(const std::vector<Pair>& pairs) { pieces_.emplace_back().pairs = pairs; }

  /// Calls makeVisitor() on each thread, and visitor(piece) for one piece after another: it visits pairs of the piece,
  /// leaves the others there, and sets `found` and `work`. Rethrows what a visitor throws.
  template <class MakeVisitor>
  void visit(unsigned threads, const MakeVisitor& makeVisitor)
  {
    if (threads > 1) askWatcher(); // this thread may come too late to get a piece
    parallelFor(threads, threads, [&](std::size_t) {
      try {
        auto visitor = makeVisitor();
        while (Piece* const piece = take()) {
          visitor(*piece);
          askWatcher();
          giveBack(*piece);
        }
      }
      catch (...) {
        fail();
        throw;
      }
    });
  }

  // After visit().

  /// The first find.
  std::optional<PointPair> found() const { return pieces_.front().found; }

  /// Returns the work up to the first find. Adds voxels and volumes that were built behind it, because they stay built.
  Work work() const
  {
    Work all = pieces_.front().work;
    return all += built_;
  }

private:
  using State = typename Piece::State;
  using Place = typename std::list<Piece>::iterator;

  /// Returns the next pairs to visit; null at the end. Waits while other threads may still give pairs back.
  Piece* take()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      if (failed_) return nullptr;
      const Place first = std::find_if(pieces_.begin(), pieces_.end(),
                                       [](const Piece& piece) { return piece.state == State::waiting; });
      if (first != pieces_.end()) {
        const Place taken = frontOf(first);
        taken->state = State::taken;
        ++taken_;
        return &*taken;
      }
      if (taken_ == 0) return nullptr;
      waitForChange(lock);
    }
  }

  void waitForChange(std::unique_lock<std::mutex>& lock)
  {
    struct Idle { // counts down also where the wait throws
      explicit Idle(std::size_t& idle) : count(idle) { ++count; }
      ~Idle() { --count; }
      std::size_t& count;
    };
    const Idle idle(idle_);
    waitAsking(changed_, lock);
  }

  void giveBack(Piece& piece)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Place at = std::find_if(pieces_.begin(), pieces_.end(), [&](const Piece& other) { return &other == &piece; });
    if (at->dropped.load(std::memory_order_relaxed))
      drop(at);
    else
      settle(at);
    --taken_;
    if (idle_ != 0) changed_.notify_all();
  }

  /// Returns the next few pairs of a piece as a piece of their own; the others stay for other threads.
  Place frontOf(Place piece)
  {
    constexpr std::size_t most = 8;
    const std::size_t count = std::min(most, (piece->pairs.size() + 1) / 2);
    if (count == piece->pairs.size()) return piece;
    const Place front = pieces_.emplace(piece);
    front->pairs.assign(piece->pairs.end() - static_cast<std::ptrdiff_t>(count), piece->pairs.end());
    piece->pairs.resize(piece->pairs.size() - count);
    return front;
  }

  void settle(Place at)
  {
    Place behind = std::next(at);
    if (at->found) {
      while (behind != pieces_.end()) {
        const Place next = std::next(behind);
        if (behind->state == State::taken)
          behind->dropped.store(true, std::memory_order_relaxed);
        else
          drop(behind);
        behind = next;
      }
    }
    else if (!at->pairs.empty()) {
      if (behind == pieces_.end() || behind->state != State::waiting) behind = pieces_.emplace(behind);
      behind->pairs.insert(behind->pairs.end(), at->pairs.begin(), at->pairs.end());
    }
    at->pairs.clear();
    at->state = State::visited;
    if (std::next(at) != pieces_.end()) join(at, std::next(at));
    if (at != pieces_.begin()) join(std::prev(at), at);
  }

  void join(Place first, Place second)
  {
    if (first->state != State::visited || second->state != State::visited) return;
    first->work += second->work;
    first->found = second->found;
    pieces_.erase(second);
  }

  void drop(Place at)
  {
    built_.voxels_built += at->work.voxels_built;
    built_.volumes_built += at->work.volumes_built;
    pieces_.erase(at);
  }

  /// Ends the search on all threads.
  void fail()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    failed_ = true;
    for (Piece& piece : pieces_) piece.dropped.store(true, std::memory_order_relaxed);
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Piece> pieces_; ///< visited ones are joined, so that there are at most three for each thread
  std::size_t taken_ = 0;
  std::size_t idle_ = 0; ///< threads that wait
  bool failed_ = false;
  Work built_; ///< by pieces that were dropped
};

} // namespace pcl_bsh
