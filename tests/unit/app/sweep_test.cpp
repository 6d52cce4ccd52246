#include "app/result/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tribound/io/file/json.h"

namespace tribound
{
namespace
{

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

class SweepTest : public ::testing::Test
{
 protected:
  SweepTest()
      : directory(fs::path(::testing::TempDir()) /
                  (std::string("sweep_") + ::testing::UnitTest::GetInstance()->current_test_info()->name()))
  {
    fs::remove_all(directory);
    fs::create_directories(directory / "0001");
    run.name = "0001";
    run.values = {"1"};
    run.sha256 = "abc";
    run.files_sha256 = "def";
  }
  ~SweepTest() override { fs::remove_all(directory); }

  void leave_certificate(const std::string& status, const std::string& sha256 = "abc")
  {
    std::ofstream(directory / "0001/certificate.json") << io::Json{
        {"case", {{"sha256", sha256}}}, {"status", status}, {"reason", "why"}, {"relative", 0.03}};
  }
  app::SweepRun read(int exit_code)
  {
    run.exit_code = exit_code;
    app::read_results(directory / "0001", run);
    return run;
  }
  std::map<std::string, int> complete_after(int exit_code)
  {
    run.exit_code = exit_code;
    const app::SweepRecord record = {"", "case.toml", {"degree"}, {run}};
    app::write_sweep(directory, record, app::sweep_object(record));
    return app::complete_runs(directory, record);
  }

  const fs::path directory;
  app::SweepRun run;
};

TEST_F(SweepTest, StatusIsThatOfTheCertificateAtTheEnd)
{
  leave_certificate("certified");
  EXPECT_EQ(read(0).status, "certified");
  EXPECT_EQ(run.reason, "why");
  EXPECT_FALSE(run.figures.empty());
  EXPECT_THAT(complete_after(0), ElementsAre(Pair("0001", 0)));
  leave_certificate("failed");
  EXPECT_EQ(read(2).status, "failed");
  EXPECT_THAT(complete_after(2), ElementsAre(Pair("0001", 2)));
}

TEST_F(SweepTest, UnitsAreThoseOfTheCertificates)
{
  const auto units_after = [&](const io::Json& units)
  {
    std::ofstream(directory / "0001/certificate.json") << io::Json{
        {"case", {{"sha256", "abc"}}}, {"status", "certified"}, {"reason", nullptr}, {"units", units}};
    return app::sweep_object({"", "case.toml", {"degree"}, {read(0)}})["units"];
  };
  EXPECT_EQ(units_after({{"force", "N/mm"}})["force"], "N/mm");
  EXPECT_TRUE(units_after(nullptr).is_null());
}

TEST_F(SweepTest, CertificateOfAnEarlierLevelIsNoResult)
{
  leave_certificate("budget");
  EXPECT_EQ(read(2).status, "failed");  // a full disk, a crash
  EXPECT_EQ(run.reason, "");
  EXPECT_THAT(run.figures, IsEmpty());
  EXPECT_THAT(complete_after(2), IsEmpty());
  EXPECT_EQ(read(1).status, "bad input");
  EXPECT_THAT(run.figures, IsEmpty());
  EXPECT_EQ(read(128 + 9).status, "crashed");
  EXPECT_EQ(run.reason, "ended by signal 9");
}

TEST_F(SweepTest, CertificateOfAnotherCaseIsNoResult)
{
  leave_certificate("certified", "of another");
  EXPECT_EQ(read(2).status, "failed");
  EXPECT_THAT(complete_after(0), IsEmpty());
}

TEST_F(SweepTest, AnotherMeshFileIsSolvedAgain)
{
  leave_certificate("certified");
  run.exit_code = 0;
  app::SweepRecord record = {"", "case.toml", {"degree"}, {run}};
  app::write_sweep(directory, record, app::sweep_object(record));
  record.runs[0].files_sha256 = "changed";
  EXPECT_THAT(app::complete_runs(directory, record), IsEmpty());
}

}  // namespace
}  // namespace tribound
