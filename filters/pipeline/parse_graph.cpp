// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/pipeline/graph.h>
#include <pcl_bsh/filters/pipeline/option_json.h>
#include <pcl_bsh/filters/pipeline/stage_names.h>
#include <pcl_bsh/io/json/nearest_name.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace pcl_bsh::pipeline {
namespace {

const std::vector<std::string> common_keys = {"type", "tag", "inputs", "user_data"};

bool isTag(const std::string& text)
{
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  const auto inner = [&](char c) { return letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; };
  return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), inner);
}

/// A part of a JSON pointer.
std::string escaped(const std::string& key)
{
  std::string pointer;
  for (const char c : key) pointer += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return pointer;
}

class Parser {
public:
  Parser(const std::vector<OptionOverride>& overrides, const std::string& name)
  : overrides_(overrides),
    used_(overrides.size(), false)
  {
    graph_.name = name;
  }

  Graph parse(std::string_view text)
  {
    Json document = read(text);
    const bool bare = document.is_array(); // PDAL allows the list alone, too
    if (bare) document = Json{{"pipeline", document}};
    readTopLevel(document);
    const std::string list = bare ? "" : "/pipeline";
    const Json& stages = document["pipeline"];
    if (!stages.is_array() || stages.empty()) fail(list, "is " + io::shown(stages) + ": give a list of stages");

    noteTags(stages);
    for (std::size_t i = 0; i < stages.size(); ++i) {
      readStage(stages[i], list + "/" + std::to_string(i), i > 0 && i + 1 == stages.size());
    }
    requireOverridesUsed();
    requireEachRead();
    return std::move(graph_);
  }

private:
  [[noreturn]] void fail(const std::string& place, const std::string& wrong) const
  {
    throw PipelineError(graph_.name + ": " + (place.empty() ? "" : place + ": ") + wrong);
  }

  Json read(std::string_view text) const
  {
    try {
      return io::parseJson(text);
    }
    catch (const io::FormatError& error) {
      fail("", error.what() + (": " + error.remedy()));
    }
  }

  void readTopLevel(const Json& document)
  {
    if (!document.is_object()) fail("", "is " + io::shown(document) + ": give {\"pipeline\": [...]}");
    // `metadata` is what a run adds to the pipeline it reports; it says nothing about what to do.
    const std::vector<std::string> keys = {"pipeline", "user_data", "metadata", "$schema"};
    for (const auto& item : document.items()) {
      if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) {
        fail("/" + escaped(item.key()), "is no key of a pipeline: " + io::suggestion(item.key(), keys));
      }
    }
    if (!document.contains("pipeline")) fail("/pipeline", "is missing: give a list of stages");
    if (document.contains("user_data")) graph_.user_data = document["user_data"];
  }

  /// All tags that the document gives, so that none is made up twice.
  void noteTags(const Json& stages)
  {
    for (const Json& stage : stages) {
      if (stage.is_object() && stage.contains("tag") && stage["tag"].is_string()) {
        given_tags_.insert(stage["tag"].get<std::string>());
      }
    }
  }

  void readStage(Json stage, const std::string& path, bool last)
  {
    if (stage.is_string()) stage = Json{{"filename", stage}};
    if (!stage.is_object()) fail(path, "is " + io::shown(stage) + ": give a file name or {\"type\": ...}");
    Node node;
    node.path = path;
    node.type = &readType(stage, path, last);
    node.tag = readTag(stage, node);
    readOptions(withOverrides(stage, node), node);
    readInputs(stage, node);
    readClouds(node);
    if (stage.contains("user_data")) node.user_data = stage["user_data"];
    previous_ = graph_.nodes.size();
    graph_.nodes.push_back(std::move(node));
  }

  /// @param last a file without a type is written when it comes last
  const StageType& readType(const Json& stage, const std::string& path, bool last) const
  {
    if (stage.contains("type")) {
      const Json& name = stage["type"];
      const std::vector<std::string> names = typeNames();
      if (!name.is_string()) fail(path + "/type", "is " + io::shown(name) + ": give the name of a stage");
      const StageType* type = findStageType(name.get<std::string>());
      if (type != nullptr) return *type;
      fail(path + "/type",
           io::shown(name) + " is no type of stage: " + io::suggestion(name.get_ref<const std::string&>(), names));
    }
    if (!stage.contains("filename")) fail(path + "/type", "is missing: give the type of the stage");
    const Json& file = stage["filename"];
    if (!file.is_string()) fail(path + "/filename", "is " + io::shown(file) + ": give the name of a file");
    const StageType* type = typeOfFile(file.get<std::string>(), last);
    if (type != nullptr) return *type;
    fail(path, io::shown(file) + " has none of the extensions that can be " + (last ? "written" : "read") + ": give " +
                   knownExtensions(last) + ", or a type");
  }

  std::string readTag(const Json& stage, const Node& node)
  {
    if (!stage.contains("tag")) return madeUpTag(*node.type);
    const Json& tag = stage["tag"];
    if (!tag.is_string() || !isTag(tag.get<std::string>())) {
      fail(node.path + "/tag", "is " + io::shown(tag) + ": give letters, digits and underscores, no digit first");
    }
    const auto text = tag.get<std::string>();
    if (findTag(text) != nullptr) fail(node.path + "/tag", "is " + io::shown(tag) + " a second time: rename one");
    return text;
  }

  /// Returns a tag such as filters_voxel_grid1.
  std::string madeUpTag(const StageType& type)
  {
    std::string begin = type.name;
    std::replace(begin.begin(), begin.end(), '.', '_');
    while (true) {
      const std::string tag = begin + std::to_string(++made_up_[begin]);
      if (given_tags_.count(tag) == 0 && findTag(tag) == nullptr) return tag;
    }
  }

  const Node* findTag(const std::string& tag) const
  {
    const auto found =
        std::find_if(graph_.nodes.begin(), graph_.nodes.end(), [&](const Node& node) { return node.tag == tag; });
    return found == graph_.nodes.end() ? nullptr : &*found;
  }

  std::size_t positionOf(const Node* node) const { return static_cast<std::size_t>(node - graph_.nodes.data()); }

  std::vector<std::string> earlierTags() const
  {
    std::vector<std::string> tags;
    for (const Node& node : graph_.nodes) tags.push_back(node.tag);
    return tags;
  }

  Json withOverrides(Json stage, const Node& node)
  {
    for (std::size_t i = 0; i < overrides_.size(); ++i) {
      const OptionOverride& given = overrides_[i];
      if (given.tag != node.tag) continue;
      used_[i] = true;
      if (std::find(common_keys.begin(), common_keys.end(), given.option) != common_keys.end()) {
        fail("--stage." + given.tag + "." + given.option,
             "'" + given.option + "' is no option, but what the document is made of: change it there");
      }
      stage[given.option] = jsonOfText(given.value, requireOption(given.option, node));
    }
    return stage;
  }

  const Option& requireOption(const std::string& name, const Node& node) const
  {
    const Option* option = node.type->findOption(name);
    if (option != nullptr) return *option;
    std::vector<std::string> names;
    for (const Option& valid : node.type->options) names.push_back(valid.name);
    names.insert(names.end(), common_keys.begin(), common_keys.end());
    fail(node.tag + ": " + node.path + "/" + escaped(name),
         "is no option of " + node.type->name + ": " + io::suggestion(name, names));
  }

  void readOptions(const Json& stage, Node& node) const
  {
    for (const auto& item : stage.items()) {
      const bool common = std::find(common_keys.begin(), common_keys.end(), item.key()) != common_keys.end();
      if (!common) requireOption(item.key(), node);
    }
    for (const Option& option : node.type->options) {
      Value value = readOption(stage, option, option.name, node);
      node.options.push_back(std::move(value));
    }
  }

  /// @param place the option's place in the stage, for errors
  Value readOption(const Json& object, const Option& option, const std::string& place, Node& node) const
  {
    if (!object.contains(option.name)) {
      if (option.required) throw stageError(graph_, node, place, "is missing: give " + expectation(option));
      return option.standard;
    }
    const Json& said = object[option.name];
    try {
      Value value = valueOf(said, option);
      if (option.kind == Kind::pose && said.is_string()) node.pose_files.emplace_back(place, said.get<std::string>());
      if (option.kind == Kind::pose && said.is_array())
        if (const auto warning = io::warningOfAngles(said.get<std::vector<double>>()))
          node.warnings.push_back(place + ": " + *warning);
      if (option.kind != Kind::rows) return value;
    }
    catch (const std::invalid_argument& error) {
      throw stageError(graph_, node, place, error.what());
    }
    std::vector<Row> rows;
    for (std::size_t i = 0; i < said.size(); ++i)
      rows.push_back(readRow(said[i], option, place + '/' + std::to_string(i), node));
    return rows;
  }

  Row readRow(const Json& said, const Option& option, const std::string& place, Node& node) const
  {
    if (!said.is_object()) throw stageError(graph_, node, place, "is " + io::shown(said) + ": give an object");
    std::vector<std::string> names;
    for (const Option& one : option.of_rows) names.push_back(one.name);
    for (const auto& item : said.items())
      if (std::find(names.begin(), names.end(), item.key()) == names.end())
        throw stageError(graph_, node, place + '/' + escaped(item.key()),
                         "is no option of one of `" + option.name + "`: " + io::suggestion(item.key(), names));
    Row row;
    for (const Option& one : option.of_rows) row.values.push_back(readOption(said, one, place + '/' + one.name, node));
    return row;
  }

  void readInputs(const Json& stage, Node& node) const
  {
    if (stage.contains("inputs")) {
      const Json& inputs = stage["inputs"];
      if (inputs.is_string()) {
        node.inputs.push_back(inputOf(inputs, node, "inputs"));
      }
      else if (inputs.is_array()) {
        for (std::size_t i = 0; i < inputs.size(); ++i) {
          node.inputs.push_back(inputOf(inputs[i], node, "inputs/" + std::to_string(i)));
        }
      }
      else {
        throw stageError(graph_, node, "inputs", "is " + io::shown(inputs) + ": give a list of tags");
      }
    }
    else if (!node.type->isReader() && !graph_.nodes.empty()) {
      node.inputs.push_back(previous_);
    }
    requireInputs(node);
  }

  void requireInputs(const Node& node) const
  {
    const std::size_t count = node.inputs.size();
    const StageType& type = *node.type;
    if (count >= type.least_inputs && count <= type.most_inputs) return;
    if (type.isReader()) throw stageError(graph_, node, "inputs", "is given to a reader: remove it");
    if (graph_.nodes.empty()) throw stageError(graph_, node, "", "has nothing to read: begin with a reader");
    throw stageError(graph_, node, "inputs",
                     "names " + counted(count, "stage") + ": " + type.name +
                         (type.least_inputs == type.most_inputs ? " takes " : " takes at least ") +
                         std::to_string(type.least_inputs));
  }

  std::size_t inputOf(const Json& tag, const Node& node, const std::string& option) const
  {
    if (!tag.is_string()) throw stageError(graph_, node, option, "is " + io::shown(tag) + ": give the tag of a stage");
    const Node* input = findTag(tag.get<std::string>());
    if (input != nullptr) return positionOf(input);
    if (given_tags_.count(tag.get<std::string>()) != 0) {
      throw stageError(graph_, node, option,
                       "is " + io::shown(tag) + ", which comes later: put that stage before this one");
    }
    throw stageError(graph_, node, option,
                     "is " + io::shown(tag) + ", which is no earlier stage's tag: " +
                         io::suggestion(tag.get_ref<const std::string&>(), earlierTags()));
  }

  /// Options that name other clouds: the tag of a stage or else a file, which gets a reader of its own.
  void readClouds(Node& node)
  {
    for (std::size_t i = 0; i < node.options.size(); ++i) {
      const Option& option = node.type->options[i];
      if (option.kind == Kind::cloud && !std::holds_alternative<std::monostate>(node.options[i]))
        node.clouds.push_back({i, nodeOfCloud(node.options[i], option.name, Json::object(), node)});
      if (option.kind != Kind::rows || !option.cloud) continue;
      const auto& rows = std::get<std::vector<Row>>(node.options[i]);
      for (std::size_t row = 0; row < rows.size(); ++row)
        node.clouds.push_back({i, nodeOfRow(rows[row], option, option.name + '/' + std::to_string(row), node), row});
    }
  }

  std::size_t nodeOfRow(const Row& row, const Option& option, const std::string& place, const Node& node)
  {
    Json of_reader = Json::object();
    std::size_t cloud = 0;
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      const Option& one = option.of_rows[i];
      if (one.kind == Kind::cloud) cloud = i;
      if (one.of_reader && !std::holds_alternative<std::monostate>(row.values[i]))
        of_reader[one.name] = jsonOf(row.values[i]);
    }
    return nodeOfCloud(row.values[cloud], place + '/' + option.of_rows[cloud].name, of_reader, node);
  }

  /// @param given the tag of a stage, or a file. @param of_reader more options of the file's reader
  std::size_t nodeOfCloud(const Value& given, const std::string& place, const Json& of_reader, const Node& node)
  {
    const auto& name = std::get<std::string>(given);
    if (const Node* other = findTag(name)) {
      if (!of_reader.empty())
        throw stageError(graph_, node, place,
                         "is " + io::shown(name) + ", a stage, and `" + of_reader.begin().key() +
                             "` is of a file: give that to the stage");
      return positionOf(other);
    }
    const StageType* type = typeOfFile(name, false);
    if (type == nullptr) {
      throw stageError(graph_, node, place,
                       "is " + io::shown(name) +
                           ", neither an earlier stage's tag nor a cloud file: " + io::suggestion(name, earlierTags()));
    }
    Node reader;
    reader.type = type;
    reader.tag = madeUpTag(*type);
    reader.path = node.path + "/" + place;
    reader.in_document = false;
    Json options = {{"filename", name}};
    options.update(of_reader);
    readOptions(options, reader);
    graph_.nodes.push_back(std::move(reader));
    return graph_.nodes.size() - 1;
  }

  void requireOverridesUsed() const
  {
    for (std::size_t i = 0; i < overrides_.size(); ++i) {
      if (used_[i]) continue;
      const OptionOverride& given = overrides_[i];
      fail("--stage." + given.tag + "." + given.option,
           "no stage has the tag '" + given.tag + "': " + io::suggestion(given.tag, earlierTags()));
    }
  }

  /// Refuses a cloud that no stage reads, unless its stage is the last: it is most likely a mistake.
  void requireEachRead() const
  {
    const std::vector<std::size_t> readers = countReaders(graph_);
    for (std::size_t i = 0; i + 1 < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (readers[i] == 0 && !node.type->isWriter()) {
        throw stageError(graph_, node, "", "is read by no other stage: name it in one's `inputs`, or remove it");
      }
    }
  }

  Graph graph_;
  const std::vector<OptionOverride>& overrides_;
  std::vector<bool> used_;                     ///< of the overrides
  std::set<std::string> given_tags_;           ///< of the whole document
  std::map<std::string, std::size_t> made_up_; ///< of tags with this beginning, the last number
  std::size_t previous_ = 0;                   ///< the node of the document's last stage so far
};

} // namespace

Graph parseGraph(std::string_view text, const std::vector<OptionOverride>& overrides, const std::string& name)
{
  return Parser(overrides, name).parse(text);
}

} // namespace pcl_bsh::pipeline
