// SPDX-License-Identifier: BSD-3-Clause
// Describes the table of stages, for editors and for readers.
#include <pcl_bsh/filters/pipeline/option_json.h>
#include <pcl_bsh/filters/pipeline/pipeline.h>

#include <cmath>

namespace pcl_bsh::pipeline {
namespace {

constexpr auto tag_pattern = "^[A-Za-z_][A-Za-z0-9_]*$";

Json withRange(Json schema, const Option& option)
{
  if (std::isfinite(option.least)) schema[option.above_least ? "exclusiveMinimum" : "minimum"] = option.least;
  if (std::isfinite(option.most)) schema["maximum"] = option.most;
  return schema;
}

Json rowSchema(const std::vector<Option>& options);

Json formSchema(const Form& form, const Option& option)
{
  Json number = withRange({{"type", "number"}}, option);
  switch (form.type) {
  case Form::Type::boolean:
    return {{"type", "boolean"}};
  case Form::Type::integer:
    return withRange({{"type", "integer"}}, option);
  case Form::Type::number:
    return number;
  case Form::Type::text:
    return option.choices.empty() ? Json{{"type", "string"}} : Json{{"type", "string"}, {"enum", option.choices}};
  case Form::Type::name:
    return {{"type", "string"}, {"minLength", 1}};
  case Form::Type::limits:
    number["type"] = {"number", "null"};
    break;
  case Form::Type::numbers:
    break;
  case Form::Type::texts:
    return {{"type", "array"}, {"items", {{"type", "string"}}}};
  case Form::Type::rows:
    return {{"type", "array"}, {"items", rowSchema(option.of_rows)}};
  }
  return {{"type", "array"}, {"items", number}, {"minItems", form.count}, {"maxItems", form.count}};
}

Json valueSchema(const Option& option)
{
  Json schemas = Json::array();
  for (const Form& form : formsOf(option.kind)) schemas.push_back(formSchema(form, option));
  return schemas.size() == 1 ? schemas[0] : Json{{"anyOf", schemas}};
}

Json optionSchema(const Option& option)
{
  Json schema = valueSchema(option);
  if (option.nullable) schema = {{"anyOf", {schema, {{"type", "null"}}}}};
  const std::string unit = option.unit.empty() ? "" : " (" + option.unit + ")";
  Json described = {{"description", option.doc + unit}};
  described.update(schema);
  if (!option.required) described["default"] = jsonOf(option.standard, option);
  return described;
}

/// An object with these options and no others.
Json rowSchema(const std::vector<Option>& options)
{
  Json properties = Json::object(), required = Json::array();
  for (const Option& option : options) {
    properties[option.name] = optionSchema(option);
    if (option.required) required.push_back(option.name);
  }
  return {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
}

/// Returns the schema of an object whose `type` is one of the names of this type of stage.
Json stageSchema(const StageType& type)
{
  Json names = {type.name};
  for (const std::string& alias : type.aliases) names.push_back(alias);
  Json properties = {{"type", {{"enum", names}}}, {"tag", {{"$ref", "#/definitions/tag"}}}};
  if (!type.isReader()) properties["inputs"] = {{"$ref", "#/definitions/inputs"}};
  properties["user_data"] = Json::object();
  Json required = Json::array();
  for (const Option& option : type.options) {
    properties[option.name] = optionSchema(option);
    if (option.required) required.push_back(option.name);
  }
  return {
      {"description", type.doc}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
}

std::string defaultText(const Option& option)
{
  if (option.required) return "*required*";
  if (option.kind == Kind::pose) return "no motion";
  return "`" + jsonOf(option.standard, option).dump() + "`";
}

void describe(const std::vector<Option>& options, std::string& text)
{
  text += "| option | what | value | default |\n|---|---|---|---|\n";
  for (const Option& option : options) {
    text +=
        "| `" + option.name + "` | " + option.doc + " | " + expectation(option) + " | " + defaultText(option) + " |\n";
  }
  text += "\n";
}

void describe(const StageType& type, std::string& text)
{
  text += "### " + type.name + "\n\n" + type.doc;
  for (std::size_t i = 0; i < type.aliases.size(); ++i) text += (i == 0 ? " Also `" : ", `") + type.aliases[i] + "`";
  text += type.aliases.empty() ? "\n\n" : ".\n\n";
  if (type.most_inputs > 1) text += "Takes any number of `inputs`.\n\n";
  if (type.options.empty()) return;
  describe(type.options, text);
  for (const Option& option : type.options) {
    if (option.kind != Kind::rows) continue;
    text += "Each of `" + option.name + "`:\n\n";
    describe(option.of_rows, text);
  }
}

} // namespace

std::string jsonSchema()
{
  Json types = Json::array();
  Json cases = Json::array();
  const Json list = {{"description", "the stages; a text is a file to read or, when last, to write"},
                     {"type", "array"},
                     {"minItems", 1},
                     {"items", {{"anyOf", {{{"type", "string"}}, {{"$ref", "#/definitions/stage"}}}}}}};
  Json definitions = {
      {"pipeline", list},
      {"tag", {{"description", "names the stage for others' `inputs`"}, {"type", "string"}, {"pattern", tag_pattern}}},
      {"inputs",
       {{"description", "tags of earlier stages; without it, the stage before this one"},
        {"anyOf", {{{"type", "string"}}, {{"type", "array"}, {"items", {{"type", "string"}}}}}}}}};
  for (const StageType& type : stageTypes()) {
    definitions[type.name] = stageSchema(type);
    Json names = definitions[type.name]["properties"]["type"]["enum"];
    types.insert(types.end(), names.begin(), names.end());
    cases.push_back({{"if", {{"required", {"type"}}, {"properties", {{"type", {{"enum", names}}}}}}},
                     {"then", {{"$ref", "#/definitions/" + type.name}}}});
  }
  definitions["stage"] = {{"type", "object"},
                          {"properties", {{"type", {{"description", "what the stage does"}, {"enum", types}}}}},
                          {"anyOf", {{{"required", {"type"}}}, {{"required", {"filename"}}}}},
                          {"allOf", cases}};
  const Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                       {"title", "A pipeline of point cloud filters, for pcl_bsh_pipeline"},
                       {"anyOf", {{{"type", "object"}}, {{"$ref", "#/definitions/pipeline"}}}},
                       {"required", {"pipeline"}},
                       {"properties",
                        {{"$schema", {{"type", "string"}}},
                         {"pipeline", {{"$ref", "#/definitions/pipeline"}}},
                         {"user_data", Json::object()},
                         {"metadata", {{"description", "what a run added; ignored"}}}}},
                       {"additionalProperties", false},
                       {"definitions", definitions}};
  return io::printed(schema);
}

std::string stageDocumentation()
{
  std::string text =
      "# Stages of a pipeline\n\nWritten by `pcl_bsh_pipeline --print-stages`. Every stage also takes `tag`, "
      "`user_data` and, unless it is a reader, `inputs`.\nLengths are in the clouds' own unit, written as "
      "m.\n";
  const std::pair<const char*, const char*> groups[] = {
      {"readers.", "\n## Readers\n\n"}, {"filters.", "## Filters\n\n"}, {"writers.", "## Writers\n\n"}};
  for (const auto& [prefix, title] : groups) {
    text += title;
    for (const StageType& type : stageTypes()) {
      if (type.name.rfind(prefix, 0) == 0) describe(type, text);
    }
  }
  text.pop_back(); // the file ends with one line break
  return text;
}

} // namespace pcl_bsh::pipeline
