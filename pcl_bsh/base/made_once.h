// SPDX-License-Identifier: BSD-3-Clause
// Parts of a voxel that the first query makes and that are kept.
#pragma once

#include <atomic>
#include <memory>

namespace pcl_bsh {

/// @tparam T as std::unique_ptr has it: an object or an array
template <class T>
class MadeOnce {
public:
  using Owner = std::unique_ptr<T>;
  using Element = typename Owner::element_type;

  MadeOnce() = default;
  MadeOnce(const MadeOnce&) = delete;
  MadeOnce& operator=(const MadeOnce&) = delete;
  ~MadeOnce() { reset(); }

  /// Null where it was not made yet.
  const Element* get() const noexcept { return made_.load(std::memory_order_acquire); }

  /// Keeps `made` where nothing is kept yet, else deletes it, and returns the element that is kept. Any number of
  /// threads may call it at once, all with equal objects. @param kept becomes whether `made` is the one kept
  const Element* keep(Owner made, bool& kept) noexcept
  {
    Element* known = nullptr;
    kept = made_.compare_exchange_strong(known, made.get(), std::memory_order_acq_rel);
    return kept ? made.release() : known;
  }

  // Not while another thread asks.
  void reset() noexcept { Owner(made_.exchange(nullptr)); }
  void adopt(MadeOnce& other) noexcept
  {
    reset();
    made_.store(other.made_.exchange(nullptr));
  }

private:
  std::atomic<Element*> made_{nullptr};
};

} // namespace pcl_bsh
