// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/json/json_schema.h>

#include <gtest/gtest.h>

#include <stdexcept>

namespace pcl_bsh::io {
namespace {

std::string faultOf(const std::string& schema, const std::string& document)
{
  const Json json = parseJson(document);
  const std::string name = "d.json";
  try {
    JsonSchema(schema).check(JsonReader(json, name));
  }
  catch (const JsonError& error) {
    return error.what();
  }
  return "";
}

TEST(JsonSchema, NamesPlaceFaultAndRemedyOfEachKeyword)
{
  EXPECT_EQ(faultOf(R"({"type": "object"})", "[]"), "d.json: [] is no object: give { ... }");
  EXPECT_EQ(faultOf(R"({"type": "integer"})", "1.5"), "d.json: 1.5 is no whole number: give one");
  EXPECT_EQ(faultOf(R"({"type": "integer"})", "2.0"), "");
  EXPECT_EQ(faultOf(R"({"type": "integer"})", "\"a\""), "d.json: \"a\" is no whole number: give one");
  EXPECT_EQ(faultOf(R"({"type": "integer"})", "[2]"), "d.json: [2] is no whole number: give one");
  EXPECT_EQ(faultOf(R"({"minLength": 1})", "\"\""), "d.json: \"\" is no text: give \"...\"");
  EXPECT_EQ(faultOf(R"({"enum": ["left", "right"]})", "\"lift\""), "d.json: 'lift' is unknown: did you mean 'left'?");
  EXPECT_EQ(faultOf(R"({"minimum": 1})", "0.5"), "d.json: 0.5 is too small: give at least 1");
  EXPECT_EQ(faultOf(R"({"minimum": 1})", "1"), "");
  EXPECT_EQ(faultOf(R"({"exclusiveMinimum": 1})", "1"), "d.json: 1 is too small: give more than 1");
  EXPECT_EQ(faultOf(R"({"maximum": 1})", "2"), "d.json: 2 is too large: give at most 1");
  EXPECT_EQ(faultOf(R"({"minItems": 1})", "[]"), "d.json: is empty: give at least one");
  EXPECT_EQ(faultOf(R"({"items": {"type": "number"}})", "[1, true]"), "d.json: [1]: true is no number: give one");
  EXPECT_EQ(faultOf(R"({"required": ["a"]})", "{}"), "d.json: 'a' is missing: add it");
  EXPECT_EQ(faultOf(R"({"additionalProperties": {"type": "string"}})", R"({"a": 1})"),
            "d.json: a: 1 is no text: give \"...\"");
  EXPECT_EQ(faultOf(R"({"properties": {"first": {}}, "additionalProperties": false})", R"({"frist": 1})"),
            "d.json: key 'frist' is unknown: did you mean 'first'?");
  EXPECT_EQ(faultOf(R"({"oneOf": [{"required": ["a"]}, {"required": ["b"]}]})", R"({"a": 1, "b": 2})"),
            "d.json: has none or several of 'a', 'b': give one");
}

TEST(JsonSchema, SizesAndLimitsAreInclusive)
{
  EXPECT_EQ(faultOf(R"({"minItems": 1, "maxItems": 2})", "[1]"), "");
  EXPECT_EQ(faultOf(R"({"minItems": 1, "maxItems": 2})", "[1, 2]"), "");
  EXPECT_EQ(faultOf(R"({"minItems": 1, "maxItems": 2})", "[1, 2, 3]"),
            "d.json: [1,2,3] is no list of that length: give another");
  EXPECT_EQ(faultOf(R"({"minProperties": 1, "maxProperties": 2})", R"({"a": 1})"), "");
  EXPECT_EQ(faultOf(R"({"minProperties": 1, "maxProperties": 2})", R"({"a": 1, "b": 2})"), "");
  EXPECT_EQ(faultOf(R"({"minProperties": 1, "maxProperties": 2})", "{}"),
            "d.json: {} is no object of that size: give another");
  EXPECT_EQ(faultOf(R"({"maxProperties": 1})", R"({"a": 1, "b": 2})"),
            "d.json: {\"a\":1,\"b\":2} is no object of that size: give another");
  EXPECT_EQ(faultOf(R"({"maximum": 1})", "1"), "");
  EXPECT_EQ(faultOf(R"({"exclusiveMinimum": 1})", "1.5"), "");
}

TEST(JsonSchema, DefinitionsNameWhatTheyAre)
{
  const std::string schema = R"({"title": "not for messages", "items": {"$ref": "#/definitions/pair"}, "definitions":
      {"pair": {"title": "pair", "description": "two names", "type": "array", "minItems": 2, "maxItems": 2}}})";
  EXPECT_EQ(faultOf(schema, R"([["a", "b"], ["c"]])"), "d.json: [1]: [\"c\"] is no pair: give two names");
  EXPECT_EQ(faultOf(schema, "[7]"), "d.json: [0]: 7 is no pair: give two names");
  EXPECT_EQ(faultOf(schema, "[[]]"), "d.json: [0]: [] is no pair: give two names");
  EXPECT_EQ(faultOf(schema, "[]"), "");
}

TEST(JsonSchema, AlternativesTellTheFaultOfTheOneMeant)
{
  const std::string schema =
      R"({"oneOf": [{"type": "number", "minimum": 0}, {"type": "object", "required": ["length"]}]})";
  EXPECT_EQ(faultOf(schema, "1"), "");
  EXPECT_EQ(faultOf(schema, "-1"), "d.json: -1 is too small: give at least 0");
  EXPECT_EQ(faultOf(schema, "{}"), "d.json: 'length' is missing: add it");
  EXPECT_EQ(faultOf(schema, "null"), "d.json: null is no valid value: give another");
}

TEST(JsonSchema, AlternativesMayBeLists)
{
  const std::string schema = R"({"oneOf": [{"type": "number"}, {"type": "array", "minItems": 1, "maxItems": 2},
      {"type": "array", "minItems": 3, "maxItems": 3}]})";
  for (const char* document : {"1", "[1]", "[1, 2]", "[1, 2, 3]"}) EXPECT_EQ(faultOf(schema, document), "") << document;
  EXPECT_NE(faultOf(schema, "[]"), "");
  EXPECT_NE(faultOf(schema, "[1, 2, 3, 4]"), "");
  EXPECT_EQ(faultOf(schema, "\"a\""), "d.json: \"a\" is no valid value: give another");
  EXPECT_EQ(faultOf(R"({"oneOf": [{"minItems": 2}]})", "\"a\""), "") << "a text has no items";
}

TEST(JsonSchema, RefusesKeywordsThatItWouldNotCheck)
{
  EXPECT_THROW(JsonSchema(R"({"items": {"uniqueItems": true}})"), std::logic_error);
  EXPECT_THROW(JsonSchema(R"({"properties": {"a": {"type": "nubmer"}}})"), std::logic_error);
}

/// A schema of its own for each key that has one; any others have one of theirs, or none.
TEST(JsonSchema, MembersAreCheckedByTheirKeys)
{
  const std::string number = R"({"properties": {"a": {"type": "number"}}, )";
  for (const std::string& rest :
       {std::string(R"("additionalProperties": false})"), std::string(R"("additionalProperties": {"type": "string"}})"),
        std::string(R"("minProperties": 0})")})
    EXPECT_EQ(faultOf(number + rest, R"({"a": "x"})"), "d.json: a: \"x\" is no number: give one") << rest;
  const std::string texts = number + R"("additionalProperties": {"type": "string"}})";
  EXPECT_EQ(faultOf(texts, R"({"a": 1, "b": "x"})"), "");
  EXPECT_EQ(faultOf(texts, R"({"a": 1, "b": 2})"), "d.json: b: 2 is no text: give \"...\"");
  EXPECT_EQ(faultOf(number + R"("minProperties": 0})", R"({"b": [null]})"), "") << "nothing is said of others";
}

} // namespace
} // namespace pcl_bsh::io
