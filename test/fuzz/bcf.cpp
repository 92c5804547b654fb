// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a BCF file: refused with a reason, or topics that have GUIDs.
#include "refusal.h"

#include <pcl_bsh/io/reports/bcf_topics.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  fuzz::mayRefuse([&] {
    const io::BcfContents contents = io::parseBcf({reinterpret_cast<const char*>(data), size});
    for (const auto& [guid, topic] : contents.topics) {
      fuzz::require(!guid.empty(), "a topic without a GUID");
      for (const io::BcfComment& comment : topic.comments)
        fuzz::require(!comment.guid.empty(), "a comment without one");
    }
  });
  return 0;
}
