// SPDX-License-Identifier: BSD-3-Clause
// The table of stages, and what is written from it.
#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <pcl_bsh/question/options.h>

#include <pcl_bsh/io/json/json_document.h>

#include "io/clouds/samples.h"
#include "run_stage.h"

#include <algorithm>
#include <limits>
#include <set>

namespace pcl_bsh::pipeline {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Own : Stage {
  int step = 2;
  StageCloudPtr run(StageClouds&& inputs) override { return inputs[0]; }
};

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

TEST(StageType, NamesAreUniqueAndDocumented)
{
  std::set<std::string> names;
  for (const StageType& type : stageTypes()) {
    EXPECT_TRUE(names.insert(type.name).second) << type.name;
    for (const std::string& alias : type.aliases) EXPECT_TRUE(names.insert(alias).second) << alias;
    if (type.name.find("test") != std::string::npos) continue;
    EXPECT_EQ(type.doc.back(), '.') << type.name;
    for (const Option& option : type.options) EXPECT_FALSE(option.doc.empty()) << type.name << ' ' << option.name;
  }
}

/// Whoever adds a row to the core's table has an option of these stages.
TEST(StageType, QuestionsHaveTheOptionsOfTheTable)
{
  for (const auto& [name, kind] : {std::pair{"filters.bsh_flag", QuestionKind::collisions},
                                   {"filters.bsh_collision", QuestionKind::collisions},
                                   {"writers.clashes", QuestionKind::collisions},
                                   {"filters.bsh_distance", QuestionKind::distances},
                                   {"writers.distances", QuestionKind::both_ways}}) {
    const StageType* const type = findStageType(name);
    ASSERT_NE(type, nullptr) << name;
    for (const QuestionOption& row : questionOptions()) {
      const Option* const option = type->findOption(row.name_of_stages ? row.name_of_stages : row.name);
      ASSERT_EQ(option != nullptr, isOf(row.kind, kind)) << name << ' ' << row.name;
      if (!option) continue;
      EXPECT_EQ(option->doc, row.doc);
      EXPECT_EQ(option->unit, row.unit);
      EXPECT_EQ(option->required, row.required);
      const bool counts = option->kind != Kind::boolean && option->kind != Kind::text;
      EXPECT_EQ(option->least, counts ? 0.0 : -std::numeric_limits<double>::infinity());
      EXPECT_EQ(option->above_least, counts && row.range == OptionRange::above_zero);
    }
  }
}

TEST(StageType, RefusesNamesThatAreTaken)
{
  const auto registering = [](const std::string& name) { return [name] { registerStage(describe<Own>(name, "")); }; };
  EXPECT_THAT(registering("filters.voxel_grid"), refusedWith("'filters.voxel_grid' is taken"));
  EXPECT_THAT(registering("own"), refusedWith("begin its name with readers., filters. or writers."));
  EXPECT_THAT(registering("filters."), refusedWith("begin its name with"));
  EXPECT_THAT([] { registerStage(describe<Own>("filters.own", "").alias("pcl::VoxelGrid")); },
              refusedWith("'pcl::VoxelGrid' is taken"));
  EXPECT_THAT([] { registerStage(describe<Own>("filters.own", "").option(&Own::step, "tag", "")); },
              refusedWith("option 'tag' is taken"));
  EXPECT_EQ(findStageType("filters.own"), nullptr);
}

/// Files of the repository must match the table; the tests' own stages are in the table, too, but come last.
std::string committed(const std::string& file)
{
  return io::contentOf(std::string(PCL_BSH_SOURCE_DIR) + "/" + file);
}

TEST(StageType, DocumentationIsCurrent)
{
  std::string lines = committed("filters/pipeline/STAGES.md");
  ASSERT_FALSE(lines.empty());
  const std::string written = stageDocumentation();
  // Section by section, since the tests have filters of their own.
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find("\n#", begin + 1), lines.size());
    EXPECT_NE(written.find(lines.substr(begin, end - begin)), std::string::npos)
        << "run pcl_bsh_pipeline --print-stages > filters/pipeline/STAGES.md: " << lines.substr(begin, end - begin);
    begin = end;
  }
  for (const StageType& type : stageTypes()) {
    const bool of_tests = type.name.find("test") != std::string::npos;
    EXPECT_TRUE(of_tests || lines.find("### " + type.name + "\n") != std::string::npos) << type.name;
  }
}

TEST(StageType, SchemaIsCurrent)
{
  Json written = io::parseJson(jsonSchema());
  const auto is_of_tests = [](const std::string& name) { return name.find("test") != std::string::npos; };
  const auto leaveOut = [](Json& list, const auto& which) {
    list.erase(std::remove_if(list.begin(), list.end(), which), list.end());
  };
  Json& definitions = written["definitions"];
  for (const StageType& type : stageTypes())
    if (is_of_tests(type.name)) definitions.erase(type.name);
  leaveOut(definitions["stage"]["properties"]["type"]["enum"],
           [&](const Json& name) { return is_of_tests(name.get<std::string>()); });
  leaveOut(definitions["stage"]["allOf"],
           [&](const Json& one) { return is_of_tests(one["then"]["$ref"].get<std::string>()); });
  const Json held = io::parseJson(committed("examples/pipelines/pcl_bsh_pipeline.schema.json"));
  EXPECT_EQ(Json::diff(held, written).dump(), "[]")
      << "run pcl_bsh_pipeline --print-schema > examples/pipelines/pcl_bsh_pipeline.schema.json";
}

/// Not filters alone: an application reads and writes formats of its own.
TEST(StageType, ReadersAndWritersMayBeAdded)
{
  for (const std::string name : {"readers.test_own", "writers.test_own"}) {
    registerStage(describe<Own>(name, ""));
    EXPECT_NE(findStageType(name), nullptr);
    EXPECT_THAT([&] { registerStage(describe<Own>(name, "")); }, refusedWith("is taken"));
  }
  EXPECT_TRUE(findStageType("readers.test_own")->isReader());
  EXPECT_TRUE(findStageType("writers.test_own")->isWriter());
}

} // namespace
} // namespace pcl_bsh::pipeline
