// SPDX-License-Identifier: BSD-3-Clause
// Flags as lists of records that collide and of records that are undecided.
#include <pcl_bsh/flags/colliding_indices.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/kept_scratch.h>

#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

/// Memory that queries use one after another; a ScratchLease lends it.
struct FlagArrays {
  FlagsResult flags;

  std::size_t bytes() const noexcept { return (flags.a.capacity() + flags.b.capacity()) * sizeof(Verdict); }
};

/// Appends the colliding and the undecided records to one list each. @param colliding, undecided how many there are
void list(const std::vector<Verdict>& flags, std::size_t colliding, std::size_t undecided,
          std::vector<std::int32_t>& of_colliding, std::vector<std::int32_t>& of_undecided)
{
  of_colliding.reserve(colliding);
  of_undecided.reserve(undecided);
  for (std::size_t i = 0; of_colliding.size() < colliding || of_undecided.size() < undecided; ++i) {
    if (flags[i] == Verdict::colliding) of_colliding.push_back(static_cast<std::int32_t>(i));
    if (flags[i] == Verdict::undecided) of_undecided.push_back(static_cast<std::int32_t>(i));
  }
}

} // namespace

void collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request, CollidingIndices& result)
{
  if (request.spacings_of_b)
    throw InvalidInput(Input::density, "density guard", "lists of points do not know it", "ask collisionFlags()");
  CollidingIndices found;
  std::swap(found, result); // should something throw, the result has no collision
  for (auto* const indices : {&found.a, &found.b, &found.undecided_a, &found.undecided_b}) indices->clear();
  const ScratchLease<FlagArrays> arrays;
  FlagsResult& flags = (*arrays).flags;
  collisionFlags(a, b, request, flags);
  list(flags.a, flags.colliding_a, flags.undecided_a, found.a, found.undecided_a);
  list(flags.b, flags.colliding_b, flags.undecided_b, found.b, found.undecided_b);
  found.work = flags.work;
  result = std::move(found);
}

CollidingIndices collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  CollidingIndices result;
  collidingIndices(a, b, request, result);
  return result;
}

} // namespace pcl_bsh
