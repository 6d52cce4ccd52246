#include "tribound/base/apart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

namespace tribound
{
namespace
{

using ::testing::HasSubstr;

/// Whether this process has children left, dead or alive.
bool has_children()
{
  return ::waitpid(-1, nullptr, WNOHANG) >= 0;
}

TEST(Apart, HandsOverWhatTheWorkReturns)
{
  std::string large(3 << 20, 'x');
  large[1] = '\0';
  const ApartOutcome outcome = run_apart([&] { return large; });
  EXPECT_EQ(outcome.end, ApartEnd::complete);
  EXPECT_EQ(outcome.result, large);
  EXPECT_FALSE(has_children());
}

TEST(Apart, KeepsTheEndOfALongOutput)
{
  const ApartOutcome outcome = run_apart(
      []
      {
        for (int i = 0; i < 100'000; ++i) std::printf("line %d\n", i);
        std::fprintf(stderr, "the last word");
        std::fflush(stdout);
        return std::string("done");
      });
  EXPECT_EQ(outcome.result, "done");
  EXPECT_THAT(outcome.output, HasSubstr("line 99999\n"));
  EXPECT_THAT(outcome.output, HasSubstr("the last word"));
  EXPECT_LT(outcome.output.size(), 1u << 18);
}

TEST(Apart, ACrashIsAnOutcome)
{
  const ApartOutcome outcome = run_apart(
      []() -> std::string
      {
        std::fprintf(stderr, "about to fail");
        std::abort();
      });
  EXPECT_EQ(outcome.end, ApartEnd::crashed);
  EXPECT_THAT(outcome.output, HasSubstr("about to fail"));
  EXPECT_THAT(describe_end(outcome.status), HasSubstr("signal 6"));
  EXPECT_FALSE(has_children());
}

TEST(Apart, AnExitIsAnOutcome)
{
  const ApartOutcome outcome = run_apart([]() -> std::string { ::_exit(3); });
  EXPECT_EQ(outcome.end, ApartEnd::crashed);
  EXPECT_EQ(describe_end(outcome.status), "ended with exit code 3");
}

TEST(Apart, SilenceIsEnded)
{
  const ApartOutcome outcome = run_apart(
      []() -> std::string
      {
        for (;;) ::pause();
      },
      {.silence = 0.2});
  EXPECT_EQ(outcome.end, ApartEnd::silent);
  EXPECT_FALSE(has_children());
}

TEST(Apart, TheFlagEndsIt)
{
  std::atomic<bool> stop = false;
  std::thread user(
      [&]
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        stop = true;
      });
  const ApartOutcome outcome = run_apart(
      []() -> std::string
      {
        for (;;) ::pause();
      },
      {.stop = &stop});
  user.join();
  EXPECT_EQ(outcome.end, ApartEnd::stopped);
  EXPECT_FALSE(has_children());
}

#ifndef __SANITIZE_ADDRESS__  // its malloc ends the program where others return null
TEST(Apart, MemoryIsLimited)
{
  const ApartOutcome outcome = run_apart(
      []
      {
        void* block = std::malloc(std::size_t{1} << 30);
        const std::string answer = block == nullptr ? "none" : "some";
        std::free(block);
        return answer;
      },
      {.memory = 1 << 28});
  EXPECT_EQ(outcome.result, "none");
}
#endif

#ifndef __SANITIZE_ADDRESS__
TEST(Apart, WorkLimitsItsOwnMemory)
{
  const ApartOutcome outcome = run_apart(
      []
      {
        void* before = std::malloc(std::size_t{1} << 29);
        limit_from_here(1 << 28, HUGE_VAL);
        void* after = std::malloc(std::size_t{1} << 29);
        const std::string answer = std::string(before ? "some" : "none") + (after ? ", some" : ", none");
        std::free(before);
        std::free(after);
        return answer;
      });
  EXPECT_EQ(outcome.result, "some, none");
}
#endif

TEST(Apart, WorkLimitsItsOwnTime)
{
  const ApartOutcome outcome = run_apart(
      []() -> std::string
      {
        limit_from_here(HUGE_VAL, 0.5);
        for (volatile bool is_busy = true; is_busy;)
          ;
        return "ended";
      });
  EXPECT_EQ(outcome.end, ApartEnd::out_of_time);
}

#ifdef __linux__
TEST(Apart, EndsWithTheProcessThatStartedIt)
{
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t parent = ::fork();
  if (parent == 0)
  {
    (void)run_apart(
        [&]() -> std::string
        {
          (void)!::write(ends[1], "x", 1);
          for (;;) ::pause();
        });
    ::_exit(0);
  }
  ::close(ends[1]);
  char x = 0;
  ASSERT_EQ(::read(ends[0], &x, 1), 1);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_EQ(::read(ends[0], &x, 1), 0) << "until nobody can write any more";
  ::close(ends[0]);
}
#endif

}  // namespace
}  // namespace tribound
