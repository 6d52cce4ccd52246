#include "app/background.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <future>
#include <optional>
#include <stdexcept>
#include <thread>

namespace tribound
{
namespace
{

class BackgroundTest : public ::testing::Test
{
 protected:
  void SetUp() override { omp_set_num_threads(2); }
  void TearDown() override { omp_set_num_threads(before_); }

 private:
  const int before_ = omp_get_max_threads();
};

TEST_F(BackgroundTest, AJobGoesOnBesideItsCaller)
{
  app::Background background;
  std::promise<void> caller_went_on;
  std::thread::id thread;
  background.start(
      [&]
      {
        caller_went_on.get_future().wait();
        thread = std::this_thread::get_id();
      });
  caller_went_on.set_value();
  background.wait();
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST_F(BackgroundTest, WithOneThreadAJobIsDoneInPlace)
{
  omp_set_num_threads(1);
  app::Background background;
  std::thread::id thread;
  background.start([&] { thread = std::this_thread::get_id(); });
  EXPECT_EQ(thread, std::this_thread::get_id());
  EXPECT_THROW(background.start([] { throw std::runtime_error("in place"); }), std::runtime_error);
  EXPECT_NO_THROW(background.wait());
}

TEST_F(BackgroundTest, JobsFollowEachOther)
{
  app::Background background;
  int sum = 0;  // used by one thread at a time
  for (int i = 0; i < 100; ++i) background.start([&sum, i] { sum += i; });
  background.wait();
  EXPECT_EQ(sum, 4950);
}

TEST_F(BackgroundTest, WhatAJobThrowsIsThrownOnOnce)
{
  app::Background background;
  const auto fail = [] { throw std::runtime_error("no space"); };
  background.start(fail);
  bool started = false;
  EXPECT_THROW(background.start([&] { started = true; }), std::runtime_error);
  EXPECT_NO_THROW(background.wait());
  EXPECT_FALSE(started);
  background.start(fail);
  EXPECT_THROW(background.wait(), std::runtime_error);
}

TEST_F(BackgroundTest, TheEndWaitsForTheJob)
{
  bool done = false;
  std::promise<void> end;
  std::optional<app::Background> background(std::in_place);
  background->start(
      [&]
      {
        end.get_future().wait();
        done = true;
        throw std::runtime_error("dropped");
      });
  end.set_value();
  background.reset();
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace tribound
