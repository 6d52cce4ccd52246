// The examples of docs/case-format.md are read by the program they document.

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tribound/case/config.h"

namespace tribound
{
namespace
{

std::vector<std::string> toml_blocks(const std::string& file)
{
  std::ifstream stream(file);
  std::vector<std::string> blocks;
  bool inside = false;
  for (std::string line; std::getline(stream, line);)
  {
    if (line == "```toml") blocks.emplace_back();
    if (line.starts_with("```"))
      inside = line == "```toml";
    else if (inside)
      blocks.back() += line + "\n";
  }
  return blocks;
}

TEST(Documentation, EveryExampleIsAValidCase)
{
  const std::vector<std::string> blocks = toml_blocks(TRIBOUND_DOCS "/case-format.md");
  EXPECT_GE(blocks.size(), 10u);
  for (std::string block : blocks)
  {
    if (block.find("[mesh]") == std::string::npos) block += "[mesh]\nfile = 'a.msh'\n";
    if (block.find("[material]") == std::string::npos) block += "[material]\nE = 1\nnu = 0\n";
    EXPECT_NO_THROW((void)case_file::parse_config(block)) << block;
  }
}

}  // namespace
}  // namespace tribound
