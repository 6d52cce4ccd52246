#include "app/page/report_page.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/page/page_template.h"
#include "app/result/study.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound
{
namespace
{

using nlohmann::json;

class StudyPageFile : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_ / "figures");
    std::filesystem::create_directories(directory_ / "adaptive");
    std::ofstream(template_) << "<!doctype html>" << app::page_data_marker;
  }

  /// The data in the page.
  json data() const
  {
    const std::string page = io::read_text(directory_ / "report.html");
    const std::string begin = R"(<!doctype html><script type="application/json" id="study-data">)";
    const std::string end = "</script>";
    EXPECT_TRUE(page.starts_with(begin) && page.ends_with(end));
    return json::parse(page.substr(begin.size(), page.size() - begin.size() - end.size()));
  }

  const std::filesystem::path directory_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("study_page_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::filesystem::path template_ = directory_ / "template.html";
};

TEST_F(StudyPageFile, HoldsTheStudyAndWhereItWasMade)
{
  app::Study study;
  study.facts.title = "</script> \"Bl\u00f6cke\"";
  study.build.version = "1.2.3";
  study.variants = {{"adaptive", certify::RunStatus::certified, {}, {}}};
  app::write_study_page(template_, directory_, study);
  const json read = data();
  EXPECT_EQ(read["study"], json::parse(app::study_json(study)));
  EXPECT_EQ(read["study"]["title"], study.facts.title);
  EXPECT_EQ(read["study"]["program"]["version"], "1.2.3");
  EXPECT_FALSE(read["machine"]["written"].get<std::string>().empty());
}

TEST_F(StudyPageFile, LinksToWhatIsThere)
{
  app::Study study;
  study.variants = {{"adaptive", certify::RunStatus::certified, {}, {}},
                    {"uniform", certify::RunStatus::budget, "too large", {}}};
  for (const char* name : {"study.csv", "adaptive/report.html", "figures/newton.svg", "figures/maps.svg",
                           "figures/notes.txt", "figures/old.svg"})
    std::ofstream(directory_ / name) << "";
  std::filesystem::last_write_time(
      directory_ / "figures/old.svg",
      std::filesystem::last_write_time(directory_ / "study.csv") - std::chrono::hours(1));
  app::write_study_page(template_, directory_, study);
  EXPECT_EQ(data()["files"],
            json::array({"study.csv", "adaptive/report.html", "figures/maps.svg", "figures/newton.svg"}));
}

TEST_F(StudyPageFile, IsNotWrittenWithoutATemplate)
{
  app::write_study_page(directory_ / "missing.html", directory_, app::Study{});
  EXPECT_FALSE(std::filesystem::exists(directory_ / "report.html"));
}

}  // namespace
}  // namespace tribound
