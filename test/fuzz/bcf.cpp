// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a BCF file: refused with a reason, or topics that have GUIDs.
#include "refusal.h"

#include <pcl_bsh/io/reports/bcf_topics.h>
#include <pcl_bsh/io/text/format_error.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  try {
    const io::BcfContents contents = io::parseBcf({reinterpret_cast<const char*>(data), size});
    for (const auto& [guid, topic] : contents.topics) {
      fuzz::require(!guid.empty(), "a topic without a GUID");
      for (const io::BcfComment& comment : topic.comments)
        fuzz::require(!comment.guid.empty(), "a comment without one");
    }
  }
  catch (const io::FormatError& error) {
    fuzz::require(*error.what() != '\0' && !error.remedy().empty(), "a refusal without a reason");
  }
  return 0;
}
