#include "app/output_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "support/input_error.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound
{
namespace
{

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class OutputDirectoryTest : public ::testing::Test
{
 protected:
  OutputDirectoryTest()
      : directory(fs::path(::testing::TempDir()) /
                  (std::string("output_") + ::testing::UnitTest::GetInstance()->current_test_info()->name()))
  {
    fs::remove_all(directory);
    fs::create_directories(directory);
  }
  ~OutputDirectoryTest() override { fs::remove_all(directory); }

  static std::string message(const fs::path& path)
  {
    return test::message_of([&] { const io::OutputDirectory opened(path); });
  }

  const fs::path directory;
};

TEST_F(OutputDirectoryTest, IsCreatedAndLeftEmpty)
{
  const fs::path out = directory / "a" / "b";
  EXPECT_EQ(message(out), "");
  EXPECT_TRUE(fs::is_empty(out));
  EXPECT_EQ(message(out), "");
}

TEST_F(OutputDirectoryTest, WithoutALockIsNotTaken)
{
  fs::create_directories(directory / ".tribound.lock");
  EXPECT_THAT(message(directory), HasSubstr("cannot lock this directory: Is a directory"));
}

TEST_F(OutputDirectoryTest, ThatCannotBe)
{
  const fs::path file = directory / "file";
  io::write_file(file, "text");
  EXPECT_THAT(message(file), AllOf(HasSubstr("output.directory"), HasSubstr("not a directory")));
  EXPECT_THAT(message(file / "out"), AllOf(HasSubstr("output.directory"), HasSubstr("Not a directory")));
  EXPECT_THAT(message("/proc/tribound"), HasSubstr("/proc/tribound"));
}

TEST_F(OutputDirectoryTest, BelongsToOne)
{
  {
    const io::OutputDirectory mine(directory);
    EXPECT_THAT(message(directory), HasSubstr("another run is writing to it: process "));
  }
  EXPECT_EQ(message(directory), "");
}

TEST_F(OutputDirectoryTest, RemovesWhatKilledProgramsLeft)
{
  for (const char* name : {".a.csv.123.part", ".part", "a.123.part", ".a.part", ".a.12x.part"})
    io::write_file(directory / name, "");
  const io::OutputDirectory mine(directory);
  EXPECT_FALSE(fs::exists(directory / ".a.csv.123.part"));
  for (const char* name : {".part", "a.123.part", ".a.part", ".a.12x.part"})
    EXPECT_TRUE(fs::exists(directory / name)) << name;
}

TEST_F(OutputDirectoryTest, TryingLeavesNothing)
{
  io::try_output_directory(directory / "a" / "b");
  EXPECT_TRUE(fs::is_empty(directory));
}

TEST_F(OutputDirectoryTest, RemovesResultsByName)
{
  for (const char* name : {"a.json", "b.csv", "mine.csv"}) io::write_file(directory / name, "");
  io::remove_results(directory, {"a.json", "b.csv", "c.html"});
  EXPECT_EQ(std::distance(fs::directory_iterator(directory), fs::directory_iterator()), 1);
  EXPECT_TRUE(fs::exists(directory / "mine.csv"));
}

/// A case file in the output directory is not replaced by something else.
TEST(OutputDirectory, EffectiveCaseDoesNotReplaceTheCaseOfTheUser)
{
  const std::filesystem::path directory = std::filesystem::path(::testing::TempDir()) / "effective_case";
  std::filesystem::create_directories(directory);
  case_file::Config config;
  config.output.directory = directory;
  config.effective.text = "degree = 1\n";
  config.file = "elsewhere.toml";
  EXPECT_EQ(app::effective_file_name(config), "case.toml");
  config.file = directory / "case.toml";
  std::ofstream(config.file) << "degree = 1 # with a comment\n";
  EXPECT_EQ(app::effective_file_name(config), "case_effective.toml");
  std::ofstream(config.file) << "degree = 1\n";
  EXPECT_EQ(app::effective_file_name(config), "case.toml");
}

}  // namespace
}  // namespace tribound
