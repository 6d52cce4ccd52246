/// Units of length of CAD files.

#include "tribound/mesh/import/cad_unit.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::Directory;

TEST(CadUnit, OfAStepFile)
{
  const Directory directory;
  const std::string si = "#1 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({},.METRE.) );\n";
  const auto millimetre = fmt::format(fmt::runtime(si), ".MILLI.");
  const auto metre = fmt::format(fmt::runtime(si), "$");
  const auto converted = [&](const char* name)
  {
    return millimetre + fmt::format(
                            "#2 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#1);\n"
                            "#3=(CONVERSION_BASED_UNIT('{}',#2)\n LENGTH_UNIT()NAMED_UNIT(#4));\n"
                            "#5=(CONVERSION_BASED_UNIT('DEGREE',#6)NAMED_UNIT(#7)PLANE_ANGLE_UNIT());\n",
                            name);
  };
  const std::pair<std::string, std::string> files[] = {{millimetre, "MM"},
                                                       {metre, "M"},
                                                       {fmt::format(fmt::runtime(si), ".DECI."), ""},
                                                       {millimetre + metre, ""},
                                                       {millimetre + millimetre, "MM"},
                                                       {converted("INCH"), "INCH"},
                                                       {converted("inches"), "INCH"},
                                                       {converted("FEET"), "FT"},
                                                       {converted("CUBIT"), ""},
                                                       {"", ""},
                                                       {"LENGTH_UNIT", ""},
                                                       {"#1=(CONVERSION_BASED_UNIT('INCH LENGTH_UNIT", ""}};
  for (const auto& [text, unit] : files)
    EXPECT_EQ(mesh::length_unit(directory.write("part.STEP", "ISO-10303-21;\n" + text).path), unit) << text;
}

/// The global section of an IGES file, in lines of 72 characters and a G.
std::string global_section(const std::string& number, const std::string& name)
{
  const std::string parameters = fmt::format(
      "1H,,1H;,6Hpart 1,10H2HMM,1HM,x,3Hcad,3H1.0,32,38,6,308,15,6Hpart 1,1.,{},{},1,0.01;", number, name);
  std::string text = fmt::format("{:<72}S      1\n", "a part of 2HMM, 1HM");
  for (std::size_t i = 0; i < parameters.size(); i += 72)
    text += fmt::format("{:<72}G{:7}\n", parameters.substr(i, 72), i / 72 + 1);
  return text;
}

TEST(CadUnit, OfAnIgesFile)
{
  const Directory directory;
  const auto unit = [&](const std::string& text)
  { return mesh::length_unit(directory.write("part.igs", text).path); };
  EXPECT_EQ(unit(global_section("2", "2HMM")), "MM");
  EXPECT_EQ(unit(global_section("1", "4HINCH")), "INCH");
  EXPECT_EQ(unit(global_section("1", "2HIN")), "INCH");
  EXPECT_EQ(unit(global_section("6", "")), "M");
  EXPECT_EQ(unit(global_section("99", "5HCUBIT")), "");
  EXPECT_EQ(unit(global_section("", "")), "");
  EXPECT_EQ(unit("no section"), "");
}

}  // namespace

}  // namespace tribound
