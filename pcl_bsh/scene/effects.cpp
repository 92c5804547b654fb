// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/effects.h>

namespace pcl_bsh {

const char* nameOf(Effect effect) noexcept
{
  static constexpr const char* names[kEffects] = {"any",  "flags", "distance", "contacts", "first_contact", "swept",
                                                  "self", "stop",  "slide",    "gravity",  "deform"};
  return names[static_cast<std::size_t>(effect)];
}

bool Effects::has(Effect effect) const noexcept
{
  switch (effect) {
  case Effect::any:
    return any;
  case Effect::flags:
    return flags;
  case Effect::distance:
    return distance.has_value();
  case Effect::contacts:
    return contacts.has_value();
  case Effect::first_contact:
    return first_contact;
  case Effect::swept:
    return swept;
  case Effect::self:
    return self;
  case Effect::stop:
    return response == Response::stop;
  case Effect::slide:
    return response == Response::slide;
  case Effect::gravity:
    return gravity.has_value();
  case Effect::deform:
    return deform.has_value();
  }
  return false;
}

bool Effects::none() const noexcept
{
  for (std::size_t i = 0; i < kEffects; ++i)
    if (has(static_cast<Effect>(i))) return false;
  return true;
}

bool Effects::ofPairs() const noexcept
{
  return any || flags || distance || contacts || first_contact || swept || response != Response::none || gravity;
}

} // namespace pcl_bsh
