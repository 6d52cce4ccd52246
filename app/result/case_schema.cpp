#include "app/result/case_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "app/result/case_guide.h"
#include "app/shared_file.h"
#include "tribound/base/version.h"
#include "tribound/case/keys.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

namespace
{

using case_file::Interval;
using case_file::Key;
using case_file::KeyGroup;
using case_file::Relation;
using case_file::Table;
using case_file::Value;
using io::Json;

void set_limits(const Interval& interval, bool is_integer, Json& schema)
{
  const auto end = [&](double limit, bool included, const char* inclusive, const char* exclusive)
  {
    if (std::isinf(limit)) return;
    schema[included ? inclusive : exclusive] = is_integer ? Json(std::lround(limit)) : Json(limit);
  };
  end(interval.lower, interval.includes_lower, "minimum", "exclusiveMinimum");
  end(interval.upper, interval.includes_upper, "maximum", "exclusiveMaximum");
}

/// A schema with `false` for these keys: none of them may be given.
Json refused(const std::vector<std::string>& keys)
{
  Json properties = Json::object();
  for (const std::string& key : keys) properties[key] = false;
  return properties;
}

/// The relations of a key to others, and keys that must be given together where tables are also named by the
/// user.
Json dependencies(const Table& table)
{
  Json all = Json::object();
  for (const Relation& relation : table.relations)
  {
    Json& one = all[relation.key];
    if (!relation.needs.empty()) one["required"] = relation.needs;
    if (!relation.excludes.empty()) one["properties"] = refused(relation.excludes);
  }
  if (table.named)
    for (const Key& key : table.keys)
      for (const Key& other : table.keys)
        if (!key.missing.empty() && !other.missing.empty() && key.name != other.name)
          all[key.name].push_back(other.name);
  return all;
}

/// If the choice names the group, its keys; else the same for the groups after it. Does not use allOf:
/// editors would then no longer offer the other keys.
Json choice(const Table& table, bool is_required, std::size_t first = 0)
{
  const KeyGroup& group = table.groups[first];
  std::vector<std::string> others;
  for (const KeyGroup& other : table.groups)
    for (const std::string& key : other.keys)
      if (std::ranges::count(group.keys, key) == 0 && std::ranges::count(others, key) == 0)
        others.push_back(key);
  Json schema = Json::object();
  schema["if"]["properties"][table.choice]["const"] = group.word;
  if (is_required || first > 0) schema["if"]["required"] = Json::array({table.choice});
  schema["then"] = Json::object();
  if (!others.empty()) schema["then"]["properties"] = refused(others);
  if (!group.required.empty()) schema["then"]["required"] = group.required;
  if (first + 1 < table.groups.size()) schema["else"] = choice(table, is_required, first + 1);
  return schema;
}

/// The default, if the guide gives it as in a case: `0.01`, `2 000 000`, `"auto"`.
Json literal(std::string text)
{
  std::erase_if(text, [](char c) { return c == '`' || c == ' '; });
  return Json::parse(text, nullptr, false);
}

/// Makes the schema of the case and everything in it.
class Schema
{
 public:
  explicit Schema(CaseGuide guide) : guide_(std::move(guide)) {}

  /// The requirements on an object, if the value is one.
  [[nodiscard]] Json table(const Table& table) const
  {
    Json schema = Json::object();
    std::vector<std::string> required;
    for (const Key& key : table.keys)
    {
      schema["properties"][key.name] = property(table, key);
      if (!key.missing.empty() && !table.named) required.push_back(key.name);
    }
    schema["additionalProperties"] = table.named ? value(*table.named) : Json(false);
    if (table.named && table.named->table != nullptr)
      describe(words_of(*table.named->table), schema["additionalProperties"]);
    if (!required.empty()) schema["required"] = required;
    for (const std::string& key : table.one_of)
      schema["oneOf"].push_back(Json{{"required", Json::array({key})}});
    if (const Json all = dependencies(table); !all.empty()) schema["dependencies"] = all;
    if (!table.choice.empty()) schema.update(choice(table, std::ranges::count(required, table.choice) > 0));
    return schema;
  }

 private:
  /// Any of the forms of the value, or of another one; each keyword applies to one type. Words are separate.
  [[nodiscard]] Json value(const Value& value, const Value* other = nullptr) const
  {
    Json schema = Json::object();
    std::vector<std::string> types;
    add_forms(value, types, schema);
    if (other != nullptr) add_forms(*other, types, schema);
    if (!types.empty()) schema["type"] = types.size() == 1 ? Json(types.front()) : Json(types);
    if (value.words.empty()) return schema;
    const Json words{{"enum", value.words}};
    return types.empty() ? words : Json{{"anyOf", Json::array({words, schema})}};
  }

  void add_forms(const Value& value, std::vector<std::string>& types, Json& schema) const
  {
    if (value.truth) types.emplace_back("boolean");
    if (value.number)
    {
      types.emplace_back(value.is_integer ? "integer" : "number");
      set_limits(*value.number, value.is_integer, schema);
    }
    if (value.number && !value.text && !value.is_literal)  // a formula of parameters
    {
      types.emplace_back("string");
      schema["pattern"] = "[A-Za-z_]";
    }
    if (value.text)
    {
      types.emplace_back("string");
      if (value.items.empty() && value.least > 0) schema["minLength"] = value.least;
    }
    if (!value.items.empty())
    {
      types.emplace_back("array");
      schema["items"] = this->value(value.items.front());
      if (value.least > 0) schema["minItems"] = value.least;
      if (value.most < std::numeric_limits<std::size_t>::max()) schema["maxItems"] = value.most;
      if (value.has_length) schema["contains"]["not"]["const"] = 0;
    }
    if (value.table != nullptr)
    {
      types.emplace_back("object");
      schema.update(table(*value.table));
    }
  }

  /// The value of a key, described. Where users name tables, a table may have the name of the key.
  [[nodiscard]] Json property(const Table& table, const Key& key) const
  {
    Json schema = Json::object();
    const Value& taken = key.value;
    const auto entry = guide_.keys.find(table.name.empty() ? key.name : table.name + "." + key.name);
    if (entry != guide_.keys.end())
    {
      const auto& [standard, meaning] = entry->second;
      describe(meaning + (standard.empty() ? "" : (meaning.empty() ? "Default: " : ". Default: ") + standard),
               schema);
      if (const Json literal_value = literal(standard); !taken.text && !literal_value.is_discarded())
        schema["default"] = literal_value;
    }
    else if (const Table* inner = !taken.items.empty() ? taken.items.front().table : taken.table)
      describe(words_of(*inner), schema);
    if (!schema.contains("description")) describe(!key.missing.empty() ? key.missing : taken.hint, schema);
    schema.update(value(taken, table.named ? &*table.named : nullptr));
    return schema;
  }

  static void describe(const std::string& words, Json& schema)
  {
    if (!words.empty()) schema["description"] = words;
  }

  /// The guide's description of the table, or of its subtables named by the user.
  [[nodiscard]] std::string words_of(const Table& table) const
  {
    const auto section = guide_.tables.find(table.name);
    if (section != guide_.tables.end()) return section->second;
    return table.named && table.named->table != nullptr ? words_of(*table.named->table) : std::string();
  }

  CaseGuide guide_;
};

}  // namespace

std::string case_schema()
{
  const auto guide = std::ranges::find(embedded_files(), "case-format.md", &EmbeddedFile::name);
  const Schema schema(read_case_guide(guide->text));
  Json json{{"$schema", "http://json-schema.org/draft-07/schema#"},
            {"title", fmt::format("A case of Tribound {}", version())}};
  json.update(schema.table(case_file::case_table()));
  return io::json_text(json);
}

}  // namespace tribound::app
