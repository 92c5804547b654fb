// SPDX-License-Identifier: BSD-3-Clause
// Documents, right and wrong. Every kind of error with its message.
#include <pcl_bsh/filters/pipeline/graph.h>

#include "io/clouds/samples.h"
#include "run_stage.h"

namespace pcl_bsh::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

Graph parse(const std::string& json, const std::vector<OptionOverride>& overrides = {})
{
  return parseGraph(json, overrides, "p.json");
}

std::string refusal(const std::string& json, const std::vector<OptionOverride>& overrides = {})
{
  return errorOf([&] { parse(json, overrides); });
}

/// Between a reader and a writer.
std::string around(const std::string& stage)
{
  return R"({"pipeline": ["in.pcd", )" + stage + R"(, "out.pcd"]})";
}

TEST(ParseGraph, StringsAreReadersAndTheLastAWriter)
{
  const Graph graph = parse(R"(["a.pcd", {"type": "filters.voxel_grid", "leaf_size": 1}, "b.PLY"])");
  ASSERT_EQ(graph.nodes.size(), 3U);
  EXPECT_EQ(graph.nodes[0].type->name, "readers.pcd");
  EXPECT_EQ(graph.nodes[2].type->name, "writers.ply");
  EXPECT_EQ(graph.nodes[0].tag, "readers_pcd1");
  EXPECT_EQ(graph.nodes[1].tag, "filters_voxel_grid1");
  EXPECT_EQ(graph.nodes[1].path, "/1");
  EXPECT_THAT(graph.nodes[1].inputs, ElementsAre(0));
  EXPECT_THAT(graph.nodes[2].inputs, ElementsAre(1));
  EXPECT_EQ(parse(R"({"pipeline": ["a.xyz"]})").nodes[0].type->name, "readers.text");
}

TEST(ParseGraph, AFileNeedsNoType)
{
  const Graph graph = parse(R"({"pipeline": [{"filename": "a.obj", "tag": "in"}, {"filename": "b.txt"}]})");
  EXPECT_EQ(graph.nodes[0].type->name, "readers.obj");
  EXPECT_EQ(graph.nodes[1].type->name, "writers.text");
}

TEST(ParseGraph, ClassNamesOfPclAreTypes)
{
  EXPECT_EQ(parse(around(R"({"type": "pcl::CropBox", "min": [0,0,0], "max": [1,1,1]})")).nodes[1].type->name,
            "filters.crop_box");
}

TEST(ParseGraph, InputsNameEarlierStages)
{
  const Graph graph = parse(R"({"pipeline": [
      {"type": "readers.pcd", "tag": "a", "filename": "a.pcd"},
      {"type": "readers.pcd", "tag": "b", "filename": "b.pcd"},
      {"type": "filters.merge", "inputs": ["a", "b"]},
      {"type": "filters.bsh_flag", "inputs": "a", "obstacle": "b", "clearance": 1},
      {"type": "filters.merge", "inputs": ["filters_merge1"]},
      {"type": "writers.pcd", "filename": "c.pcd"},
      {"type": "writers.pcd", "filename": "d.pcd", "inputs": ["filters_bsh_flag1"]}]})");
  EXPECT_THAT(graph.nodes[2].inputs, ElementsAre(0, 1));
  EXPECT_THAT(graph.nodes[3].inputs, ElementsAre(0));
  ASSERT_EQ(graph.nodes[3].clouds.size(), 1U);
  EXPECT_EQ(graph.nodes[3].clouds[0].node, 1U);
  EXPECT_THAT(countReaders(graph), ElementsAre(2, 2, 1, 1, 1, 0, 0));
}

TEST(ParseGraph, AFileInPlaceOfATagGetsAReader)
{
  const Graph graph = parse(around(R"({"type": "filters.bsh_flag", "obstacle": "robot.ply", "clearance": 1})"));
  ASSERT_EQ(graph.nodes.size(), 4U);
  EXPECT_EQ(graph.nodes[1].type->name, "readers.ply");
  EXPECT_EQ(graph.nodes[1].path, "/pipeline/1/obstacle");
  EXPECT_FALSE(graph.nodes[1].in_document);
  EXPECT_THAT(graph.nodes[2].inputs, ElementsAre(0));
  EXPECT_EQ(graph.nodes[2].clouds[0].node, 1U);
  EXPECT_EQ(documentOf(graph)["pipeline"].size(), 3U);
}

TEST(ParseGraph, UserDataIsCarriedThrough)
{
  const Graph graph = parse(R"({"$schema": "s.json", "user_data": [1], "pipeline": [
      {"filename": "a.pcd", "user_data": {"owner": "x", "any": [null]}}, "b.pcd"]})");
  const Json document = documentOf(graph);
  EXPECT_EQ(document["user_data"].dump(), "[1]");
  EXPECT_EQ(document["pipeline"][0]["user_data"].dump(), R"({"owner":"x","any":[null]})");
}

TEST(ParseGraph, TheDocumentWrittenOutReadsTheSame)
{
  const std::string json = around(R"({"type": "pcl::VoxelGrid", "leaf_size": 0.1},
      {"type": "filters.bsh_collision", "obstacle": "r.pcd", "clearance": 1, "pose": [1,2,3,0,0,1], "keep": "colliding"},
      {"type": "filters.pass_through", "filter_field_name": "z", "filter_limits": [null, 0.3]})");
  const Json document = documentOf(parse(json));
  EXPECT_EQ(documentOf(parse(document.dump())), document);
  EXPECT_EQ(document["pipeline"][1]["downsample_all_data"], true) << "defaults are written out";
}

TEST(ParseGraph, OverridesReplaceOptions)
{
  const std::string json = R"(["a.pcd", {"type": "filters.voxel_grid", "tag": "thin", "leaf_size": 1}, "b.pcd"])";
  const Json document = documentOf(parse(json, {{"thin", "leaf_size", "0.5"}, {"readers_pcd1", "filename", "c.pcd"}}));
  EXPECT_EQ(document["pipeline"][1]["leaf_size"].dump(), "[0.5,0.5,0.5]");
  EXPECT_EQ(document["pipeline"][0]["filename"], "c.pcd");
  EXPECT_EQ(refusal(json, {{"thick", "leaf_size", "1"}}),
            "p.json: --stage.thick.leaf_size: no stage has the tag 'thick': did you mean 'thin'?");
  EXPECT_EQ(refusal(json, {{"thin", "leafsize", "1"}}),
            "p.json: thin: /1/leafsize: is no option of filters.voxel_grid: did you mean 'leaf_size'?");
  for (const std::string key : {"tag", "inputs", "type", "user_data"})
    EXPECT_EQ(refusal(json, {{"thin", key, "x"}}), "p.json: --stage.thin." + key + ": '" + key +
                                                       "' is no option, but what the document is made of: change it "
                                                       "there");
  EXPECT_EQ(refusal(json, {{"thin", "leaf_size", "wide"}}),
            "p.json: thin: /1/leaf_size: is \"wide\": give a number or [x, y, z], each above 0, in m");
}

TEST(ParseGraph, RefusesDocumentsThatAreNoPipeline)
{
  EXPECT_THAT(refusal("{"), StartsWith("p.json: is no JSON: line 1, column "));
  EXPECT_EQ(refusal("3"), "p.json: is 3: give {\"pipeline\": [...]}");
  EXPECT_EQ(refusal("{}"), "p.json: /pipeline: is missing: give a list of stages");
  EXPECT_EQ(refusal(R"({"pipeline": "a.pcd"})"), "p.json: /pipeline: is \"a.pcd\": give a list of stages");
  EXPECT_EQ(refusal(R"({"pipeline": []})"), "p.json: /pipeline: is []: give a list of stages");
  EXPECT_EQ(refusal(R"({"pipelin": ["a.pcd"]})"),
            "p.json: /pipelin: is no key of a pipeline: did you mean 'pipeline'?");
  EXPECT_EQ(refusal(R"({"pipeline": [7]})"), "p.json: /pipeline/0: is 7: give a file name or {\"type\": ...}");
  EXPECT_THAT(refusal(R"({"pipeline": ["a.pcd", {"type": "x", "type": "y"}]})"),
              HasSubstr("says the key \"type\" twice"));
}

TEST(ParseGraph, RefusesUnknownTypes)
{
  EXPECT_EQ(refusal(around(R"({"type": "filters.voxelgrid", "leaf_size": 1})")),
            "p.json: /pipeline/1/type: \"filters.voxelgrid\" is no type of stage: did you mean 'filters.voxel_grid'?");
  EXPECT_EQ(refusal(around(R"({"type": "pcl::VoxelGrd"})")),
            "p.json: /pipeline/1/type: \"pcl::VoxelGrd\" is no type of stage: did you mean 'pcl::VoxelGrid'?");
  EXPECT_EQ(refusal(around(R"({"type": 4})")), "p.json: /pipeline/1/type: is 4: give the name of a stage");
  EXPECT_EQ(refusal(around(R"({"leaf_size": 4})")), "p.json: /pipeline/1/type: is missing: give the type of the stage");
  EXPECT_EQ(refusal(around(R"({"filename": 4})")), "p.json: /pipeline/1/filename: is 4: give the name of a file");
  EXPECT_EQ(refusal(R"(["a.rcp", "b.pcd"])"),
            "p.json: /0: \"a.rcp\" has none of the extensions that can be read: give "
            ".pcd .ply .obj .off .stl .las .laz .e57 .pts .ptx .txt .xyz .asc .csv, or a "
            "type");
  EXPECT_THAT(refusal(R"(["a.pcd", "b.off"])"),
              HasSubstr("can be written: give .pcd .ply .las .laz .pts .ptx .obj .txt .xyz .asc .csv, or a type"));
}

TEST(ParseGraph, RefusesUnknownKeysAndWrongValues)
{
  EXPECT_EQ(refusal(around(R"({"type": "filters.voxel_grid", "tag": "thin", "leafsize": 1})")),
            "p.json: thin: /pipeline/1/leafsize: is no option of filters.voxel_grid: did you mean 'leaf_size'?");
  EXPECT_EQ(
      refusal(around(R"({"type": "filters.voxel_grid", "leaf_size": 1, "a/b~": 1})")),
      "p.json: filters_voxel_grid1: /pipeline/1/a~1b~0: is no option of filters.voxel_grid: did you mean 'type'?");
  EXPECT_EQ(refusal(around(R"({"type": "filters.voxel_grid", "tag": "thin", "leaf_size": -1})")),
            "p.json: thin: /pipeline/1/leaf_size: is -1: give a number or [x, y, z], each above 0, in m");
  EXPECT_EQ(
      refusal(around(R"({"type": "filters.voxel_grid"})")),
      "p.json: filters_voxel_grid1: /pipeline/1/leaf_size: is missing: give a number or [x, y, z], each above 0, in m");
  EXPECT_EQ(refusal(around(R"({"type": "filters.bsh_collision", "obstacle": "r.pcd", "clearance": 1, "keep": "fre"})")),
            "p.json: filters_bsh_collision1: /pipeline/1/keep: is \"fre\": give one of free, colliding");
}

TEST(ParseGraph, RefusesTagsThatAreNoneOrTaken)
{
  EXPECT_EQ(refusal(R"([{"filename": "a.pcd", "tag": "1a"}])"),
            "p.json: /0/tag: is \"1a\": give letters, digits and underscores, no digit first");
  EXPECT_THAT(refusal(R"([{"filename": "a.pcd", "tag": "a.b"}])"), HasSubstr("/0/tag: is \"a.b\": give letters"));
  EXPECT_THAT(refusal(R"([{"filename": "a.pcd", "tag": 3}])"), HasSubstr("/0/tag: is 3: give letters"));
  EXPECT_EQ(refusal(R"([{"filename": "a.pcd", "tag": "a"}, {"filename": "b.pcd", "tag": "a"}])"),
            "p.json: /1/tag: is \"a\" a second time: rename one");
  const Graph graph = parse(R"(["a.pcd", {"type": "filters.merge", "tag": "readers_pcd1"}, "b.pcd"])");
  EXPECT_EQ(graph.nodes[0].tag, "readers_pcd2") << "a tag that is made up avoids those that are given";
}

struct Row : Stage {
  StageCloudPtr run(StageClouds&& inputs) override { return inputs[0]; }
};

/// The eleventh of test_row and the first of test_row1 have the same letters.
TEST(ParseGraph, MadeUpTagsAreOfOneStageEach)
{
  if (!findStageType("filters.test_row")) {
    registerStage(describe<Row>("filters.test_row", ""));
    registerStage(describe<Row>("filters.test_row1", ""));
  }
  std::string stages;
  for (int i = 0; i < 11; ++i) stages += R"({"type": "filters.test_row"}, )";
  const Graph graph = parse(around(stages + R"({"type": "filters.test_row1"})"));
  EXPECT_EQ(graph.nodes[11].tag, "filters_test_row11");
  EXPECT_EQ(graph.nodes[12].tag, "filters_test_row12");
}

TEST(ParseGraph, ReadsFiles)
{
  const io::TemporaryFolder folder;
  EXPECT_EQ(errorOf([&] { Pipeline::read(folder / "none.json"); }),
            (folder / "none.json").string() + ": no such file: check the name");
  const auto file = folder.write("p.json", "{}");
  EXPECT_THAT(errorOf([&] { Pipeline::read(file); }), StartsWith(file.string() + ": "));
  Pipeline pipeline = Pipeline::parse(R"(["a.pcd"])");
  pipeline = Pipeline::parse(R"(["b.pcd"])", {}, "b.json");
  const Pipeline moved = std::move(pipeline);
  EXPECT_THAT(errorOf([&] { Pipeline(Pipeline::parse(R"(["c.pcd"])", {}, "c.json")).setCloud("d", nullptr); }),
              StartsWith("c.json: "));
}

TEST(ParseGraph, RefusesInputsThatAreNotThere)
{
  EXPECT_EQ(
      refusal(around(R"({"type": "filters.merge", "inputs": ["readers_pcd2"]})")),
      "p.json: filters_merge1: /pipeline/1/inputs/0: is \"readers_pcd2\", which is no earlier stage's tag: did you "
      "mean 'readers_pcd1'?");
  EXPECT_EQ(refusal(R"(["a.pcd", {"type": "filters.merge", "inputs": "late"}, {"filename": "b.pcd", "tag": "late"}])"),
            "p.json: filters_merge1: /1/inputs: is \"late\", which comes later: put that stage before this one");
  EXPECT_THAT(refusal(around(R"({"type": "filters.merge", "inputs": 3})")),
              HasSubstr("inputs: is 3: give a list of tags"));
  EXPECT_THAT(refusal(around(R"({"type": "filters.merge", "inputs": [3]})")),
              HasSubstr("inputs/0: is 3: give the tag of a stage"));
  EXPECT_EQ(
      refusal(R"([{"filename": "a.pcd"}, {"type": "readers.pcd", "filename": "b.pcd", "inputs": ["readers_pcd1"]}])"),
      "p.json: readers_pcd2: /1/inputs: is given to a reader: remove it");
  EXPECT_EQ(refusal(R"([{"type": "filters.merge"}])"),
            "p.json: filters_merge1: /0: has nothing to read: begin with a reader");
  EXPECT_EQ(refusal(around(R"({"type": "filters.merge", "inputs": []})")),
            "p.json: filters_merge1: /pipeline/1/inputs: names 0 stages: filters.merge takes at least 1");
  EXPECT_EQ(
      refusal(around(R"({"type": "filters.voxel_grid", "leaf_size": 1, "inputs": ["readers_pcd1", "readers_pcd1"]})")),
      "p.json: filters_voxel_grid1: /pipeline/1/inputs: names 2 stages: filters.voxel_grid takes 1");
}

TEST(ParseGraph, RefusesCloudsThatNobodyReads)
{
  EXPECT_EQ(refusal(R"(["a.pcd", "b.pcd", "c.pcd"])"),
            "p.json: readers_pcd1: /0: is read by no other stage: name it in one's `inputs`, or remove it");
}

TEST(ParseGraph, RefusesObstaclesThatAreNeitherTagNorFile)
{
  EXPECT_EQ(
      refusal(
          R"([{"filename": "a.pcd", "tag": "robot"}, {"type": "filters.bsh_flag", "obstacle": "robo", "clearance": 1}])"),
      "p.json: filters_bsh_flag1: /1/obstacle: is \"robo\", neither an earlier stage's tag nor a cloud file: did "
      "you mean 'robot'?");
}

TEST(ParseGraph, MessagesAreOneCleanLine)
{
  const std::string message =
      refusal("[{\"type\": \"filters.\\u001b[31m\"}, {\"type\": \"readers.pcd\", \"filename\": \"a\"}]");
  EXPECT_EQ(message.find_first_of("\x1b\n"), std::string::npos) << message;
  EXPECT_THAT(refusal("[{\"filename\": \"a.pcd\", \"\\u001b\": 1}]").find('\x1b'), testing::Eq(std::string::npos));
}

} // namespace
} // namespace pcl_bsh::pipeline
