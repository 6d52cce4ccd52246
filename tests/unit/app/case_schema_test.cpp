// The schema of the case format, and its descriptions from the guide.

#include "app/result/case_schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/result/case_guide.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{
namespace
{

using testing::IsEmpty;

/// The keys below `schema` that are not described or do not accept their own default.
void collect(const io::Json& schema, const std::string& path, std::vector<std::string>& faults)
{
  if (!schema.is_object()) return;
  for (const char* const inner : {"items", "additionalProperties"})
    if (schema.contains(inner)) collect(schema[inner], path + ".*", faults);
  if (schema.contains("anyOf"))
    for (const io::Json& form : schema["anyOf"]) collect(form, path, faults);
  if (!schema.contains("properties")) return;
  for (const auto& [key, value] : schema["properties"].items())
  {
    const std::string name = path + "." + key;
    if (value.value("description", "").empty()) faults.push_back(name + " is not described");
    if (value.contains("enum") && value.contains("default"))
      if (std::ranges::count(value["enum"], value["default"]) != 1)
        faults.push_back(name + " has another default");
    collect(value, name, faults);
  }
}

TEST(CaseSchema, DescribesEveryKey)
{
  const io::Json schema = io::Json::parse(case_schema());
  EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
  std::vector<std::string> faults;
  collect(schema, "", faults);
  EXPECT_THAT(faults, IsEmpty());
}

TEST(CaseSchema, SaysWhatTheParserChecks)
{
  const io::Json schema = io::Json::parse(case_schema());
  EXPECT_EQ(schema["required"], io::Json({"mesh", "material"}));
  const io::Json& adapt = schema["properties"]["adapt"];
  EXPECT_EQ(adapt["additionalProperties"], false);
  EXPECT_EQ(adapt["properties"]["theta"]["exclusiveMinimum"], 0);
  EXPECT_EQ(adapt["properties"]["theta"]["maximum"], 1);
  EXPECT_EQ(adapt["properties"]["theta"]["default"], 0.6);
  EXPECT_EQ(adapt["properties"]["marking"]["enum"], io::Json({"doerfler", "maximum", "uniform"}));
  EXPECT_EQ(adapt["properties"]["max_dofs"]["default"], 2'000'000);
  // Numbers may be formulas of parameters.
  EXPECT_EQ(schema["properties"]["degree"]["type"], io::Json({"integer", "string"}));
  // A region may bear the name of a key of the material.
  const io::Json& material = schema["properties"]["material"];
  EXPECT_EQ(material["additionalProperties"]["required"], io::Json({"E", "nu"}));
  EXPECT_EQ(material["properties"]["E"]["type"], io::Json({"number", "string", "object"}));
  EXPECT_EQ(schema["properties"]["parameters"]["additionalProperties"]["type"],
            io::Json({"number", "object"}));
}

TEST(CaseGuide, ReadsTablesAndSentences)
{
  const CaseGuide guide = read_case_guide(
      "# Cases\n\nWords.\n\n## Top\n\n| key | type | meaning |\n|---|---|---|\n| `title` | string | a name "
      "|\n\n"
      "## [[contact]]\n\n```toml\n# no heading\n```\n\nFirst [words](a.md) on\ntwo lines. More.\n\n"
      "| key | type | default | meaning |\n|---|---|---|---|\n"
      "| `a`, `b` | number | 2 | see [`[shape.NAME]`](#shape) and [this](x.md) |\n\n"
      "| key of `law` | type | meaning |\n|---|---|---|\n| `c` | string | |\n\n| other | |\n|---|---|\n| `d` "
      "| |\n");
  EXPECT_EQ(guide.tables.at("contact"), "First words on two lines.");
  EXPECT_EQ(guide.keys.at("title").meaning, "a name");
  EXPECT_EQ(guide.keys.at("contact.a").standard, "2");
  EXPECT_EQ(guide.keys.at("contact.b").meaning, "see `[shape.NAME]` and this");
  EXPECT_EQ(guide.keys.at("contact.law.c").meaning, "");
  EXPECT_EQ(guide.keys.size(), 4u);
}

}  // namespace
}  // namespace tribound::app
