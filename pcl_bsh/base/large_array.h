// SPDX-License-Identifier: BSD-3-Clause
// A growing array of small elements that leaves new elements uninitialised. Large arrays have huge pages, and their
// memory is kept for other uses when they end (large_buffer.h).
#pragma once

#include <pcl_bsh/base/large_buffer.h>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace pcl_bsh {

/// Grows and does not shrink by itself. Throws nothing while the elements fit the capacity.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  std::size_t bytes() const noexcept { return capacity_ * sizeof(T); }

  T* data() noexcept { return items_.get(); }
  const T* data() const noexcept { return items_.get(); }
  T* begin() noexcept { return data(); }
  const T* begin() const noexcept { return data(); }
  T* end() noexcept { return data() + size_; }
  const T* end() const noexcept { return data() + size_; }
  T& operator[](std::size_t i) noexcept { return items_[i]; }
  const T& operator[](std::size_t i) const noexcept { return items_[i]; }

  void resize(std::size_t size) noexcept { size_ = size; } ///< @pre there is room
  void clear() noexcept { size_ = 0; }

  /// Makes sure that `more` items fit behind the last one. @throws std::bad_alloc
  void reserveMore(std::size_t more)
  {
    if (size_ + more > capacity_) move(std::max(2 * capacity_, size_ + more + 64));
  }

  /// Makes room for exactly `size` elements.
  void reserve(std::size_t size)
  {
    if (size > capacity_) move(size);
  }

  /// @pre reserveMore() was called
  void push(const T& item) noexcept { items_[size_++] = item; }

  /// Appends `count` uninitialised items. @return the first of them. @throws std::bad_alloc
  T* append(std::size_t count)
  {
    reserve(size_ + count);
    size_ += count;
    return end() - count;
  }

  /// Reduces the room to `capacity` items, but not below size(). @throws std::bad_alloc
  void shrink(std::size_t capacity)
  {
    if (capacity_ > capacity) move(std::max(capacity, size_));
  }

private:
  void move(std::size_t capacity)
  {
    LargeBuffer<T> other = makeBuffer<T>(capacity);
    std::copy_n(items_.get(), size_, other.get());
    items_ = std::move(other);
    capacity_ = capacity;
  }

  LargeBuffer<T> items_;
  std::size_t size_ = 0, capacity_ = 0;
};

} // namespace pcl_bsh
