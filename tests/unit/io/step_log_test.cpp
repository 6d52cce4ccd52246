#include "tribound/io/state/step_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/io/state/hdf5_file.h"

namespace tribound
{
namespace
{

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class StepLog : public ::testing::Test
{
 protected:
  StepLog()
  {
    fs::remove_all(directory);
    fs::create_directories(directory / "unfinished_pass");
  }
  ~StepLog() override { fs::remove_all(directory); }

  void append(int path, int step, const std::string& what) const
  {
    io::append_step(log, {path, step},
                    {what + "\n", what + "\n" + what + "\n", "{\"what\":\"" + what + "\"}"});
  }
  /// The rows of history.csv.
  [[nodiscard]] std::string history(int path, int last, const fs::path& checkpoint) const
  {
    std::string rows;
    for (const io::StepRows& step : io::read_steps(checkpoint, {path, last}, {})) rows += step.history;
    return rows;
  }

  const fs::path directory = fs::path(::testing::TempDir()) / ("step_log_" + std::to_string(::getpid()));
  const fs::path log = directory / io::step_log_name;
  const fs::path checkpoint = directory / "checkpoint.h5";
};

TEST_F(StepLog, HasTheStepsOfEachPathUpToOne)
{
  for (const int path : {0, 1})
    for (const int step : {1, 2, 3}) append(path, step, std::to_string(path) + "," + std::to_string(step));
  EXPECT_EQ(history(0, 2, checkpoint), "0,1\n0,2\n");
  EXPECT_EQ(history(1, 3, directory / "unfinished_pass" / "checkpoint_003.h5"), "1,1\n1,2\n1,3\n");
}

TEST_F(StepLog, AStepThatComesAgainTakesTheOldPlace)
{
  for (const char* step : {"old", "older"}) append(0, step == std::string("old") ? 1 : 2, step);
  append(0, 2, "new");
  EXPECT_EQ(history(0, 2, checkpoint), "old\nnew\n");
}

TEST_F(StepLog, ALineThatWasCutOffDoesNotCount)
{
  append(0, 1, "one");
  std::ofstream(log, std::ios::app) << "[0,2,\"tw";
  append(0, 2, "two, again");
  EXPECT_EQ(history(0, 2, checkpoint), "one\ntwo, again\n");
}

TEST_F(StepLog, StepsThatAreMissingAreNamed)
{
  append(0, 1, "one");
  EXPECT_THAT(test::message_of([&] { (void)history(0, 2, checkpoint); }),
              HasSubstr("checkpoint_steps.jsonl: lacks the rows of load step 2"));
}

TEST_F(StepLog, AddsUpToTheEarlierSteps)
{
  io::EarlierLevels earlier{.newton = "step\n", .history = "t\n"};
  io::add_steps(earlier, std::vector<io::StepRows>{{"1\n", "1\n1\n", "{}"}, {"2\n", "2\n", "[]"}});
  EXPECT_EQ(earlier.history, "t\n1\n2\n");
  EXPECT_EQ(earlier.newton, "step\n1\n1\n2\n");
  EXPECT_EQ(earlier.steps, "[{},[]]");
}

/// The array is announced, but its data are missing.
TEST_F(StepLog, AnAbsurdNumberOfRowsInACheckpointCostsNoMemory)
{
  const hid_t file = H5Fcreate(checkpoint.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const std::array<hsize_t, 2> shape = {10'000'000'000, 1};
  const hid_t space = H5Screate_simple(2, shape.data(), nullptr);
  H5Dclose(H5Dcreate2(file, "root", H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Fclose(file);
  EXPECT_THAT(test::message_of(
                  [&]
                  {
                    io::Hdf5File damaged(checkpoint, io::Hdf5File::Mode::read, {});
                    (void)damaged.read<std::int64_t>("root", 1);
                  }),
              HasSubstr("is no checkpoint, or a damaged one"));
}

}  // namespace
}  // namespace tribound
