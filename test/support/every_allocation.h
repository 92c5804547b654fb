// SPDX-License-Identifier: BSD-3-Clause
// The rules of code that allocates. When any allocation fails, the caller gets std::bad_alloc, or the right answer all
// the same. Afterwards the same objects give the right answer; nothing is leaked.
#pragma once

#include <pcl_bsh/base/retained_memory.h>

#include "failing_allocation.h"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <optional>
#include <utility>

extern "C" int __asan_address_is_poisoned(void const volatile*) __attribute__((weak));

namespace pcl_bsh::test {

/// Asked of the linker, because these objects are compiled without the sanitizer that watches over the library.
inline bool underAddressSanitizer()
{
  return &__asan_address_is_poisoned != nullptr;
}

/// The allocations to fail, one after another: the first 200, then fewer and fewer. Fewer from the start where all that
/// follow fail as well, and where each takes twenty times as long.
inline std::size_t nextFailure(std::size_t k, Shortage shortage)
{
  if (shortage == Shortage::lasting) return k + 1 + k / 8;
  const std::size_t all = underAddressSanitizer() ? 40 : 200;
  return k < all ? k + 1 : k + k / 8;
}

/// @param make a fresh subject @param ask puts a question to it; the answers can be compared
/// @return how many allocations the question takes
template <class Make, class Ask>
std::size_t failEachAllocation(const Make& make, const Ask& ask)
{
  const auto expected = [&] {
    auto subject = make();
    return ask(subject); // with all that is allocated once in a process
  }();
  std::size_t allocations = 0;
  for (const Shortage shortage : {Shortage::once, Shortage::lasting}) {
    for (std::size_t k = 1;; k = nextFailure(k, shortage)) {
      releaseRetainedMemory(); // scratch, and threads', is allocated anew
      auto subject = make();
      std::optional<std::decay_t<decltype(expected)>> answer;
      bool thrown = false, failed = false;
      {
        const FailingAllocation failing(k, shortage);
        try {
          answer.emplace(ask(subject));
        }
        catch (const std::bad_alloc&) {
          thrown = true;
        }
        failed = failing.hasHappened();
        allocations = failing.allocations();
      }
      if (!thrown) {
        EXPECT_TRUE(*answer == expected) << "allocation " << k << " failed unnoticed";
      }
      if (!failed) {
        EXPECT_FALSE(thrown);
        break;
      }
      EXPECT_TRUE(ask(subject) == expected) << "after allocation " << k << " had failed";
      if (testing::Test::HasFailure()) return allocations;
    }
  }
  return allocations;
}

/// Blocks that a body leaves behind once what is retained is given back.
inline std::ptrdiff_t leakedBy(const std::function<void()>& body)
{
  body(); // with all that is allocated once in a process
  releaseRetainedMemory();
  const std::ptrdiff_t before = liveAllocations();
  body();
  releaseRetainedMemory();
  return liveAllocations() - before;
}

} // namespace pcl_bsh::test
