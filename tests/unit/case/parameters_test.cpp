/// @file parameters_test.cpp
/// `[parameters]`: what takes their values, and every mistake.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/case/config.h"

namespace tribound::test
{

namespace
{

using testing::HasSubstr;

const std::string block_text =
    "mesh.box = { lower = [0, 0], upper = ['width', 1], cells = ['2*n', 'n'] }\n"
    "material = { E = '1e3*E0', nu = 0.3 }\n"
    "boundary.bottom.contact = { friction = 'coulomb', coefficient = 'mu', gap = 'mu*x + n2*1e2' }\n";
const std::string values_text =
    "[parameters]\nwidth = 2.5\nn = 4\nE0 = { value = 210, label = \"Young's modulus\", unit = 'GPa' }\n"
    "mu = 0.3\nn2 = -1e-9\n";

case_file::Config parsed(const std::string& text, const std::vector<std::string>& overrides = {})
{
  return case_file::parse_config(text, "case.toml", overrides);
}

TEST(Parameters, StandInFormulasAndForNumbers)
{
  const case_file::Config config = parsed(block_text + values_text);
  const auto& box = std::get<mesh::BoxMesh>(config.mesh);
  EXPECT_EQ(box.upper[0], 2.5);
  EXPECT_EQ(box.cells[0], 8);
  EXPECT_EQ(box.cells[1], 4);
  const problem::Contact& contact = *config.boundaries[0].contact;
  EXPECT_EQ(problem::cone(contact.law).coefficient, 0.3);
  EXPECT_DOUBLE_EQ((*contact.gap)(Point<2>(2, 0)), 0.6 - 1e-7);
  EXPECT_THAT(config.effective.text, HasSubstr("coefficient = \"mu\""));
  EXPECT_THAT(config.effective.text, HasSubstr("mu = 0.3"));
}

TEST(Parameters, AreSetByName)
{
  const case_file::Config config = parsed(block_text + values_text, {"mu=0.5", "E0=70", "width=3"});
  EXPECT_EQ(problem::cone(config.boundaries[0].contact->law).coefficient, 0.5);
  EXPECT_EQ(std::get<mesh::BoxMesh>(config.mesh).upper[0], 3);
  EXPECT_THAT(config.effective.text, HasSubstr("Young's modulus"));
}

TEST(Parameters, RefuseWhatIsNoNumberOrName)
{
  const auto message = [](const std::string& parameters)
  { return message_of([&] { return parsed(block_text + parameters); }); };
  EXPECT_THAT(message(values_text + "k = 1\n"), HasSubstr("parameters.k: nothing uses this parameter"));
  EXPECT_THAT(message(values_text + "x = 1\n"), HasSubstr("formulas give \"x\" another meaning"));
  EXPECT_THAT(message(values_text + "sin = 1\n"), HasSubstr("formulas give \"sin\" another meaning"));
  EXPECT_THAT(message(values_text + "'a b' = 1\n"), HasSubstr("is no name for formulas"));
  EXPECT_THAT(message(values_text + "k = 'mu'\n"), HasSubstr("parameters.k: must be a number"));
  EXPECT_THAT(message(values_text + "k = { unit = 'm' }\n"), HasSubstr("parameters.k.value: is missing"));
  EXPECT_THAT(message(""), HasSubstr("must be"));
  EXPECT_THAT(message_of([] { return parsed(block_text + values_text, {"mu=-1"}); }),
              HasSubstr("coefficient"));
}

}  // namespace

}  // namespace tribound::test
