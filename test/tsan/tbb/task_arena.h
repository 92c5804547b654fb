// SPDX-License-Identifier: BSD-3-Clause
// Stands in for oneTBB under ThreadSanitizer. ThreadSanitizer does not see inside libtbb, so that every piece of work
// handed from thread to thread would look like a race; it understands std::thread.
#pragma once

namespace tbb {

class task_arena {
public:
  explicit task_arena(int threads) : threads_(threads) {}

  template <class Function>
  void execute(const Function& function)
  {
    struct Outer { // comes back when the function throws, too
      ~Outer() { threadsHere() = threads; }
      int threads = threadsHere();
    };
    const Outer outer;
    threadsHere() = threads_;
    function();
  }

  /// Threads for parallel_for() when this thread calls it.
  static int& threadsHere()
  {
    thread_local int threads = 1;
    return threads;
  }

private:
  int threads_;
};

} // namespace tbb
