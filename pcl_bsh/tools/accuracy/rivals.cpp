// SPDX-License-Identifier: BSD-3-Clause
#include "rivals.h"

namespace pcl_bsh::accuracy {
namespace {

/// The fastest of ours that is certified to at most this error; null: there is none.
const Measurement* fastestWithin(const Study& study, const std::string& query, double error,
                                 const Spread Measurement::*seconds = &Measurement::seconds)
{
  const Measurement* fastest = nullptr;
  for (const Measurement& m : study.measurements) {
    if (m.query != query || m.peer || !m.certified || m.certified_error > error) continue;
    if (query == "flags" && m.knob == "tolerance") continue; // nothing is undecided there, but of another question
    if (!fastest || (m.*seconds).median < (fastest->*seconds).median) fastest = &m;
  }
  return fastest;
}

} // namespace

std::vector<Rival> rivalsOf(const Study& study)
{
  std::vector<Rival> rivals;
  for (const Measurement& m : study.measurements)
    if (m.peer)
      rivals.push_back({&m, fastestWithin(study, m.query, m.actual_error),
                        fastestWithin(study, m.query, m.actual_error, &Measurement::once)});
  return rivals;
}

std::vector<Beaten> beatenOf(const Study& study, double noise)
{
  std::vector<Beaten> beaten;
  for (const Measurement& m : study.measurements) {
    if (m.query != "distance" || m.peer || !m.certified) continue;
    const Measurement* const by = fastestWithin(study, m.query, m.certified_error);
    if (by->seconds.median * (1.0 + noise) < m.seconds.median) beaten.push_back({&m, by});
  }
  return beaten;
}

} // namespace pcl_bsh::accuracy
