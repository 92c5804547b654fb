// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/json/json_schema.h>
#include <pcl_bsh/io/json/nearest_name.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pcl_bsh::io {
namespace {

/// A type: its name, the word for a value of it, the remedy for other values, and whether a value is of it.
struct Type {
  const char* name;
  const char* noun;
  const char* remedy;
  bool (*holds)(const Json&);
};

bool isWhole(const Json& value)
{
  return value.is_number() && value.get<double>() == std::floor(value.get<double>());
}

constexpr std::array<Type, 6> types = {
    {{"object", "object", "{ ... }", [](const Json& value) { return value.is_object(); }},
     {"array", "list", "[ ... ]", [](const Json& value) { return value.is_array(); }},
     {"string", "text", "\"...\"", [](const Json& value) { return value.is_string(); }},
     {"number", "number", "one", [](const Json& value) { return value.is_number(); }},
     {"integer", "whole number", "one", isWhole},
     {"boolean", "boolean", "true or false", [](const Json& value) { return value.is_boolean(); }}}};

const Type& typeNamed(const std::string& name)
{
  const auto* const type = std::find_if(types.begin(), types.end(), [&](const Type& t) { return name == t.name; });
  if (type == types.end()) throw std::logic_error("the schema has an unknown type: " + name);
  return *type;
}

bool hasTypeOf(const Json& value, const Json& schema)
{
  return schema.contains("type") && typeNamed(schema["type"].get<std::string>()).holds(value);
}

std::vector<std::string> keysOf(const Json& object)
{
  std::vector<std::string> keys;
  for (const auto& member : object.items()) keys.push_back(member.key());
  return keys;
}

/// Whether a count is within the limits, if there are any.
bool countFits(std::size_t count, const Json& schema, const char* least, const char* most)
{
  return (!schema.contains(least) || count >= schema[least].get<std::size_t>()) &&
         (!schema.contains(most) || count <= schema[most].get<std::size_t>());
}

/// Refuses keywords that check() would leave out.
void requireKnown(const Json& schema)
{
  if (schema.is_boolean()) return;
  static const std::vector<std::string> known = {
      "$schema", "$ref",     "title",    "description", "default",          "definitions",   "type",
      "items",   "minItems", "maxItems", "properties",  "required",         "minProperties", "maxProperties",
      "minimum", "maximum",  "oneOf",    "enum",        "exclusiveMinimum", "minLength",     "additionalProperties",
      "pattern"};
  for (const auto& [keyword, value] : schema.items()) {
    if (std::find(known.begin(), known.end(), keyword) == known.end())
      throw std::logic_error("the schema has an unknown keyword: " + keyword);
    if (keyword == "definitions" || keyword == "properties" || keyword == "oneOf")
      for (const Json& inner : value) requireKnown(inner);
    if (keyword == "items" || keyword == "additionalProperties") requireKnown(value);
    if (keyword == "type") typeNamed(value.get<std::string>());
  }
}

} // namespace

JsonSchema::JsonSchema(std::string_view text) : schema_(Json::parse(text))
{
  requireKnown(schema_);
}

void JsonSchema::check(const JsonReader& document) const
{
  check(document, schema_);
}

const Json& JsonSchema::resolved(const Json& schema) const
{
  if (!schema.contains("$ref")) return schema;
  return schema_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1)));
}

/// @param noun, remedy where the schema has no title
void JsonSchema::failAs(const JsonReader& value, const Json& schema, std::string noun, std::string remedy) const
{
  if (schema.contains("title") && &schema != &schema_) { // the whole schema's title is for editors
    noun = schema["title"].get<std::string>();
    remedy = schema["description"].get<std::string>();
  }
  value.fail(shown(value.json()) + " is no " + noun, "give " + remedy);
}

void JsonSchema::check(const JsonReader& value, const Json& referring) const
{
  const Json& schema = resolved(referring);
  const Json& json = value.json();
  if (schema.contains("type")) {
    const Type& type = typeNamed(schema["type"].get<std::string>());
    if (!type.holds(json)) failAs(value, schema, type.noun, type.remedy);
  }
  if (json.is_object()) checkObject(value, schema);
  if (json.is_array()) checkArray(value, schema);
  if (json.is_number()) checkNumber(value, schema);
  if (json.is_string() && json.get_ref<const std::string&>().size() < schema.value("minLength", std::size_t{0}))
    failAs(value, schema, "text", "\"...\"");
  if (schema.contains("enum")) value.oneOf(schema["enum"].get<std::vector<std::string>>());
  if (schema.contains("oneOf")) checkAlternatives(value, schema);
}

void JsonSchema::checkObject(const JsonReader& value, const Json& schema) const
{
  static const Json none = Json::object();
  const Json& properties = schema.contains("properties") ? schema["properties"] : none;
  const bool closed = schema.contains("additionalProperties") && schema["additionalProperties"].is_boolean();
  if (closed) value.requireKeys(keysOf(properties));
  if (!countFits(value.json().size(), schema, "minProperties", "maxProperties"))
    failAs(value, schema, "object of that size", "another");
  if (schema.contains("required"))
    for (const Json& key : schema["required"]) value.at(key.get_ref<const std::string&>().c_str());
  for (const auto& [key, member] : value.members()) {
    if (properties.contains(key))
      check(member, properties[key]);
    else if (schema.contains("additionalProperties")) // a boolean forbids other keys: there are none here
      check(member, schema["additionalProperties"]);
  }
}

void JsonSchema::checkArray(const JsonReader& value, const Json& schema) const
{
  if (!countFits(value.json().size(), schema, "minItems", "maxItems")) {
    if (value.json().empty() && !schema.contains("title")) value.fail("is empty", "give at least one");
    failAs(value, schema, "list of that length", "another");
  }
  if (!schema.contains("items")) return;
  for (const JsonReader& element : value.elements()) check(element, schema["items"]);
}

void JsonSchema::checkNumber(const JsonReader& value, const Json& schema) const
{
  const Json& json = value.json();
  const auto number = json.get<double>();
  const auto limit = [&](const char* keyword) { return schema[keyword].get<double>(); };
  if (schema.contains("exclusiveMinimum") && !(number > limit("exclusiveMinimum")))
    value.fail(shown(json) + " is too small", "give more than " + shown(schema["exclusiveMinimum"]));
  if (schema.contains("minimum") && !(number >= limit("minimum")))
    value.fail(shown(json) + " is too small", "give at least " + shown(schema["minimum"]));
  if (schema.contains("maximum") && !(number <= limit("maximum")))
    value.fail(shown(json) + " is too large", "give at most " + shown(schema["maximum"]));
}

/// Reports the fault in the alternative for values of this type, if one of several ways to write a value has this type.
void JsonSchema::checkAlternatives(const JsonReader& value, const Json& schema) const
{
  const Json& ways = schema["oneOf"];
  if (std::count_if(ways.begin(), ways.end(), [&](const Json& way) { return allows(way, value); }) == 1) return;
  std::vector<std::string> keys;
  for (const Json& referring : ways) {
    const Json& way = resolved(referring);
    if (hasTypeOf(value.json(), way)) check(value, way);
    if (way.contains("required")) keys.push_back("'" + way["required"][0].get<std::string>() + "'");
  }
  if (keys.size() == ways.size()) value.fail("has none or several of " + listed(keys), "give one");
  failAs(value, schema, "valid value", "another");
}

bool JsonSchema::allows(const Json& referring, const JsonReader& value) const
{
  const Json& schema = resolved(referring);
  const Json& json = value.json();
  if (schema.contains("type") && !hasTypeOf(json, schema)) return false;
  if (json.is_array() && !countFits(json.size(), schema, "minItems", "maxItems")) return false;
  try {
    check(value, schema);
    return true;
  }
  catch (const JsonError&) {
    return false;
  }
}

} // namespace pcl_bsh::io
