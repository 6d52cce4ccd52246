/// @file interrupt.cpp
/// Signals: Ctrl-C ends a run cleanly, a closed pipe does not end it, a crash ends it with a message.

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <string_view>

#include "app/command/commands.h"
#include "app/host.h"

namespace tribound::app
{

namespace
{

std::atomic<bool> stop_requested = false;

constexpr std::array stop_signals = {SIGINT, SIGTERM, SIGUSR1};  // the last one comes by way of mpirun

void stop_once(int)
{
  stop_requested = true;
  for (const int signal : stop_signals) std::signal(signal, SIG_DFL);
}

/// Calls only async-signal-safe functions.
void report_crash(int)
{
  constexpr std::string_view text =
      "tribound: crashed: an internal error, please report the case\n"
      "  hint: are numbers absurdly large or small? Results written before hold\n";
  (void)!::write(STDERR_FILENO, text.data(), text.size());
  ::_exit(static_cast<int>(ExitCode::failed));
}

/// The handler has its own stack, since an overflowed one is unusable.
void catch_crashes()
{
  static std::array<char, 1 << 16> memory;
  stack_t stack{};
  stack.ss_sp = memory.data();
  stack.ss_size = memory.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action
  {
  };
  action.sa_handler = report_crash;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

}  // namespace

void prepare_signals()
{
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGCHLD, SIG_DFL);  // ignored, as by the shell's trap '' CHLD, children could not be waited for
  catch_crashes();
}

const std::atomic<bool>& stop_on_signals()
{
  for (const int signal : stop_signals)
    if (!stop_requested && !host().is_present) std::signal(signal, stop_once);
  return stop_requested;
}

void request_stop()
{
  stop_requested = true;
}

void forget_stop()
{
  stop_requested = false;
}

}  // namespace tribound::app
