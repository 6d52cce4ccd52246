#include "app/page/report_page.h"
#include "app/page/page_level.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "unit/app/packed_array.h"
#include "unit/io/constant_stress.h"

namespace tribound::test
{
namespace
{

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class ReportPageFile : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
    std::ofstream(template_) << "<html>head " << app::page_data_marker << " tail</html>";
  }

  /// The data of the page; checks that they are in a single script element.
  json data() const
  {
    std::ifstream file(directory_ / "report.html");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    const std::string begin = R"(<html>head <script type="application/json" id="run-data">)";
    const std::string end = "</script> tail</html>";
    EXPECT_TRUE(page.starts_with(begin));
    EXPECT_TRUE(page.ends_with(end));
    const std::string text = page.substr(begin.size(), page.size() - begin.size() - end.size());
    EXPECT_THAT(text, Not(HasSubstr("<")));
    return json::parse(text);
  }

  const std::filesystem::path directory_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("report_page_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::filesystem::path template_ = directory_ / "template.html";
};

TEST_F(ReportPageFile, LevelsAreSampledOnceAndThoseTooLargeAreNot)
{
  const DiscreteProblem<2> small = constant_stress_problem<2>(1, 2);
  const DiscreteProblem<2> large = constant_stress_problem<2>(1, 150);  // 45 000 triangles
  app::ReportPage page(template_);
  page.add(0, small.form, constant_stress_level(small));
  page.add(1, large.form, constant_stress_level(large));
  page.add_last(2, large.form, constant_stress_level(large));
  page.write(directory_, {});
  const json fields = data()["fields"];
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[0]["level"], 0);
  EXPECT_EQ(fields[1]["level"], 2);
}

TEST_F(ReportPageFile, HoldsTheRunAndTheUsersStringsAsTheyAre)
{
  io::RunRecord run;
  run.facts.title = "</script><script>alert(1)</script> \"Bl\u00f6cke\" \u4e2d";
  run.status = certify::RunStatus::failed;
  run.reason = "the matrix is <singular>";
  const app::ReportPage page(template_);
  page.write(directory_, run);
  const json read = data();
  EXPECT_EQ(read["certificate"]["title"], run.facts.title);
  EXPECT_EQ(read["certificate"]["reason"], run.reason);
  EXPECT_EQ(read["newton"], json::array());
  EXPECT_THAT(unpack_text(read["tables"]["newton.csv"]), HasSubstr("level,step"));
  EXPECT_EQ(read["components"].size(), 10u);
  EXPECT_TRUE(read["fields"].empty());
  EXPECT_TRUE(read["files"].empty());
  EXPECT_FALSE(read["machine"]["written"].get<std::string>().empty());
}

TEST_F(ReportPageFile, StringsThatAreNotUtf8AreReplaced)
{
  io::RunRecord run;
  run.facts.title = "\xff";
  app::ReportPage(template_).write(directory_, run);
  EXPECT_EQ(data()["certificate"]["title"], "\uFFFD");
}

TEST_F(ReportPageFile, FieldsOfALevel)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(2, 3);
  app::ReportPage page(template_);
  page.add_last(0, box.form, constant_stress_level(box));
  std::ofstream(directory_ / "newton.csv") << "";
  std::ofstream(directory_ / "contact.csv") << "boundary,facet\n";
  page.write(directory_, {});
  const json read = data();
  EXPECT_EQ(read["files"], json::array({"newton.csv", "contact.csv"}));
  EXPECT_TRUE(read["volume"].is_null());
  EXPECT_EQ(unpack_text(read["tables"]["contact.csv"]), "boundary,facet\n");
  EXPECT_THAT(unpack_text(read["tables"]["convergence.csv"]), HasSubstr("level,cells,dofs"));
  ASSERT_EQ(read["fields"].size(), 1u);
  const json& level = read["fields"][0];
  EXPECT_EQ(level["dimension"], 2);
  EXPECT_EQ(level["cells"], 18);
  EXPECT_EQ(unpack(level["points"]).size(), 2u * 49);
  EXPECT_EQ(unpack(level["faces"]).size(), 18u * 6);
  ASSERT_EQ(level["stress"].size(), 3u);
  EXPECT_EQ(unpack(level["stress"][0]).size(), 18u * 6);
  for (const double shear : unpack(level["stress"][2])) EXPECT_EQ(shear, 0.0);  // round-off beside the others
  EXPECT_NEAR(level["out_of_plane"][0].get<double>(), 0.25, 1e-15);
  EXPECT_EQ(unpack(level["eta"]["tot"]).size(), 18u);
  EXPECT_EQ(level["profiles"][0]["boundary"], "bottom");
  for (const double gap : unpack(level["profiles"][0]["gap"])) EXPECT_EQ(gap, 0.0);
  EXPECT_FALSE(level.contains("contact"));
  EXPECT_FALSE(level.contains("region"));
}

TEST_F(ReportPageFile, ContactIn3D)
{
  const DiscreteProblem<3> box = constant_stress_problem<3>(1, 2);
  const json level = app::page_level(3, box.form, constant_stress_level(box)).json;
  EXPECT_EQ(level["level"], 3);
  EXPECT_EQ(unpack(level["contact"]["pressure"]).size(), 8u * 3);
  EXPECT_FALSE(level.contains("profiles"));
}

TEST_F(ReportPageFile, TablesThatAreTooLargeAreLeftOut)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(1, 2);
  app::ReportPage page(template_);
  page.add_last(0, box.form, constant_stress_level(box));
  std::string text;
  for (std::uint32_t i = 0, digits = 1; i < 100'000; ++i, digits *= 2654435761U)
    text += std::to_string(digits) + "\n";
  std::ofstream(directory_ / "contact.csv") << text;
  page.write(directory_, {});
  EXPECT_TRUE(data()["tables"]["contact.csv"].is_null());
}

TEST_F(ReportPageFile, TheInsideOfABodyIn3D)
{
  const DiscreteProblem<3> box = constant_stress_problem<3>(2, 2);
  const json volume = app::page_volume(box.form, constant_stress_level(box));
  EXPECT_EQ(unpack(volume["points"]).size(), 3u * 27);
  EXPECT_EQ(unpack(volume["cells"]).size(), 4u * 48);
  const std::vector<double> points = unpack(volume["points"]);
  const std::vector<double> u = unpack(volume["displacement"]);
  for (std::size_t v = 0; v < 27; ++v)
  {
    const Point<3> exact = constant_stress_displacement<3>(Point<3>(points.data() + 3 * v));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(u[3 * v + c], exact[c], 1e-4);
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (const double value : unpack(volume["stress"][i])) EXPECT_NEAR(value, constant_stress<3>()[i], 1e-9);
}

TEST_F(ReportPageFile, NothingIsWrittenWithoutATemplate)
{
  app::ReportPage(directory_ / "missing.html").write(directory_, {});
  EXPECT_FALSE(std::filesystem::exists(directory_ / "report.html"));
}

TEST_F(ReportPageFile, TrueErrorsOfAStudyAreAddedOnce)
{
  std::ofstream(template_) << "<html>" << app::page_data_marker << app::true_errors_marker << "</html>";
  io::RunRecord run;
  run.facts.title = app::true_errors_marker;  // a title is not mistaken for the place
  app::ReportPage(template_).write(directory_, run);
  const std::vector<app::TrueErrors> errors = {{0, 0.5, 0.25}, {1, {}, {}}, {2, {}, 0.125}};
  for (int i = 0; i < 2; ++i) app::add_true_errors(directory_ / "report.html", errors);
  std::ifstream file(directory_ / "report.html");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_TRUE(page.ends_with(
      R"(</script><script type="application/json" id="true-errors">[{"level":0,"stress_error":0.5,"dual_norm":0.25},)"
      R"({"level":1},{"level":2,"dual_norm":0.125}]</script></html>)"));
  app::add_true_errors(directory_ / "missing.html", errors);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "missing.html"));
}

/// The size that keeps a page with 200 000 cells below 10 MB.
TEST_F(ReportPageFile, SizeOfALevel)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(1, 100);
  const app::PageLevel level = app::page_level(0, box.form, constant_stress_level(box), {.subdivided = 0});
  EXPECT_EQ(level.n_triangles, 20'000u);
  EXPECT_LT(level.json.dump().size() / static_cast<double>(level.n_triangles), 35.0);
}

}  // namespace
}  // namespace tribound::test
