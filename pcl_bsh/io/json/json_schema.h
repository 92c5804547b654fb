// SPDX-License-Identifier: BSD-3-Clause
// The structure of documents as a JSON schema says it, with errors that name the place and the remedy.
#pragma once

#include <pcl_bsh/io/json/json_reader.h>

#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// A schema of draft 7 with these keywords: type, properties, required, additionalProperties, minProperties,
/// maxProperties, items, minItems, maxItems, minimum, maximum, exclusiveMinimum, minLength, enum (of texts), oneOf, and
/// $ref into #/definitions. `pattern` is for editors: the code that reads the text has to check it.
///
/// An error about a value of a definition that has a title says the title and the description: of {"title": "pair",
/// "description": "two names", ...}, "[1] is no pair: give two names".
class JsonSchema {
public:
  /// @throws std::logic_error for what is no schema, or one with another keyword
  explicit JsonSchema(std::string_view text);

  /// @throws JsonError for the first value, in the document's order, that the schema does not allow
  void check(const JsonReader& document) const;

private:
  void check(const JsonReader& value, const Json& schema) const;
  void checkObject(const JsonReader& value, const Json& schema) const;
  void checkArray(const JsonReader& value, const Json& schema) const;
  void checkNumber(const JsonReader& value, const Json& schema) const;
  void checkAlternatives(const JsonReader& value, const Json& schema) const;
  bool allows(const Json& schema, const JsonReader& value) const;
  [[noreturn]] void failAs(const JsonReader& value, const Json& schema, std::string noun, std::string remedy) const;
  const Json& resolved(const Json& schema) const;

  Json schema_;
};

} // namespace pcl_bsh::io
