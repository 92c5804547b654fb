// SPDX-License-Identifier: BSD-3-Clause
// A stage of one's own, to copy from: every_nth.json runs here as any pipeline does in pcl_bsh_pipeline.
//
//   pcl_bsh_own_stage every_nth.json
#include <pcl_bsh/filters/pipeline/pipeline.h>
#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <exception>
#include <iostream>

namespace {

using namespace pcl_bsh::pipeline;

/// The members are the options, their values the defaults.
struct EveryNth : Stage {
  int step = 10;

  StageCloudPtr run(StageClouds&& inputs) override
  {
    const StageCloud& input = *inputs[0];
    const auto output = emptyLike(input);
    const std::size_t record = input.cloud.point_step;
    const std::size_t points = std::size_t{input.cloud.width} * input.cloud.height;
    for (std::size_t i = 0; i < points; i += static_cast<std::size_t>(step)) {
      const auto begin = input.cloud.data.begin() + static_cast<std::ptrdiff_t>(i * record);
      output->cloud.data.insert(output->cloud.data.end(), begin, begin + static_cast<std::ptrdiff_t>(record));
      ++output->cloud.width;
    }
    output->cloud.row_step = static_cast<pcl::uindex_t>(output->cloud.data.size());
    return output;
  }
};

// The line that makes it known: its name, its options, their limits. The checks and the messages come with it.
const bool registered = registerStage(describe<EveryNth>("filters.every_nth", "Keeps one point of every few.")
                                          .option(&EveryNth::step, "step", "keep one of so many points")
                                          .atLeast(1));

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2 || !registered) {
    std::cerr << "usage: pcl_bsh_own_stage PIPELINE.json\n";
    return 2;
  }
  try {
    std::cout << pcl_bsh::Pipeline::read(argv[1]).run().metadata;
    return 0;
  }
  catch (const std::exception& error) {
    std::cerr << "pcl_bsh_own_stage: " << error.what() << '\n';
    return 1;
  }
}
