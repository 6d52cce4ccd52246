#include "tribound/io/file/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

namespace tribound
{
namespace
{

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class AtomicFileTest : public ::testing::Test
{
 protected:
  AtomicFileTest()
      : directory(fs::path(::testing::TempDir()) /
                  ::testing::UnitTest::GetInstance()->current_test_info()->name())
  {
    fs::remove_all(directory);
    fs::create_directories(directory);
  }
  ~AtomicFileTest() override { fs::remove_all(directory); }

  [[nodiscard]] static std::string content(const fs::path& path)
  {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] long n_files() const
  {
    return std::distance(fs::directory_iterator(directory), fs::directory_iterator());
  }

  const fs::path directory;
};

TEST_F(AtomicFileTest, AppearsOnCommitOnly)
{
  const fs::path path = directory / "a.txt";
  io::AtomicFile file(path);
  file.write("hello");
  EXPECT_FALSE(fs::exists(path));
  file.commit();
  EXPECT_EQ(content(path), "hello");
  EXPECT_EQ(n_files(), 1);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStays)
{
  const fs::path path = directory / "a.txt";
  io::write_file(path, "old");
  {
    io::AtomicFile file(path);
    file.write("new");
  }
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(n_files(), 1);
}

TEST_F(AtomicFileTest, OverwritesInPlaceAndGoesOnAtTheEnd)
{
  const fs::path path = directory / "a.txt";
  io::AtomicFile file(path);
  file.write("0123456789");
  EXPECT_EQ(file.position(), 10u);
  file.overwrite(2, std::as_bytes(std::span(std::string_view("ab"))));
  file.write("end");
  EXPECT_EQ(file.position(), 13u);
  file.commit();
  EXPECT_EQ(content(path), "01ab456789end");
}

TEST_F(AtomicFileTest, NamesTheFileAndTheReasonOfAFailure)
{
  const fs::path path = directory / "missing" / "a.txt";
  try
  {
    io::AtomicFile file(path);
    FAIL() << "opened a file in a directory that does not exist";
  }
  catch (const io::WriteError& error)
  {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(path.string()), HasSubstr("No such file or directory"),
                                    HasSubstr("output.directory")));
  }
}

/// Lets no file grow beyond a limit; a write then fails as on a full disk.
class FileSizeLimit
{
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN))
  {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit()
  {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
  void (*handler_)(int);
};

TEST_F(AtomicFileTest, LeavesNothingBehindWhenTheDiskIsFull)
{
  const fs::path path = directory / "big.txt";
  const std::string mebibyte(1 << 20, 'x');
  std::string message;
  {
    const FileSizeLimit limit(100'000);
    try
    {
      io::AtomicFile file(path);
      for (int i = 0; i < 4; ++i) file.write(mebibyte);
      file.commit();
    }
    catch (const io::WriteError& error)
    {
      message = error.what();
    }
  }
  EXPECT_THAT(message, AllOf(HasSubstr(path.string()), HasSubstr("File too large"), HasSubstr("space")));
  EXPECT_EQ(n_files(), 0);
}

TEST_F(AtomicFileTest, ReportsAnErrorThatOnlyFlushingShows)
{
  const fs::path path = directory / "small.txt";
  const FileSizeLimit limit(10);
  EXPECT_THROW(io::write_file(path, std::string(100, 'x')), io::WriteError);
  EXPECT_EQ(n_files(), 0);
}

TEST_F(AtomicFileTest, DoesNotReplaceADirectory)
{
  fs::create_directories(directory / "taken" / "inside");
  EXPECT_THROW(io::write_file(directory / "taken", "text"), io::WriteError);
  EXPECT_EQ(n_files(), 1);
}

}  // namespace
}  // namespace tribound
