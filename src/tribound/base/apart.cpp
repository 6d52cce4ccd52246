#include "tribound/base/apart.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>

#include "tribound/base/clock.h"
#include "tribound/base/error.h"

namespace tribound
{

namespace
{

/// Output longer than most_output is cut to its last kept_output bytes.
constexpr std::size_t most_output = 1 << 17;
constexpr std::size_t kept_output = 1 << 16;

/// How long the parent waits before it looks at its flag and its clock again.
constexpr int tick_milliseconds = 50;

/// Both ends of a pipe, closed on destruction.
class Pipe
{
 public:
  Pipe()
  {
    if (::pipe(ends_.data()) != 0)
      throw SolveError(std::string("cannot open a pipe: ") + std::strerror(errno));
    for (const int end : ends_) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  }
  ~Pipe()
  {
    close_reading();
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] int reading() const { return ends_[0]; }
  [[nodiscard]] int writing() const { return ends_[1]; }
  void close_reading() { close(ends_[0]); }
  void close_writing() { close(ends_[1]); }

 private:
  static void close(int& end)
  {
    if (end >= 0) ::close(end);
    end = -1;
  }

  std::array<int, 2> ends_{-1, -1};
};

/// The address space in use, bytes; 0 where the system does not tell.
double address_space()
{
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_AS) resource, double most)
{
  rlimit current{};
  if (std::isinf(most) || ::getrlimit(resource, &current) != 0) return;
  if (current.rlim_cur != RLIM_INFINITY && static_cast<double>(current.rlim_cur) <= most) return;
  current.rlim_cur = static_cast<rlim_t>(most);
  ::setrlimit(resource, &current);
}

/// Limits the address space to what is in use and `bytes` more.
void limit_memory(double bytes)
{
  if (const double in_use = address_space(); in_use > 0) limit(RLIMIT_AS, in_use + bytes);
}

/// A crash must end the child alone: the signal handlers of this program and of libraries (MPI would abort
/// all its processes) are reset. Interrupts are for the parent to handle; the child ends with it.
void prepare_child(pid_t parent, double memory)
{
  for (const int signal :
       {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGPIPE, SIGXFSZ, SIGXCPU, SIGCHLD})
    std::signal(signal, SIG_DFL);
#ifdef __linux__
  std::signal(SIGINT, SIG_IGN);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
#else
  std::signal(SIGINT, SIG_DFL);
  (void)parent;
#endif
  limit(RLIMIT_CORE, 0);
  if (memory > 0) limit_memory(memory);
}

void write_all(int file, const char* bytes, std::size_t size)
{
  while (size > 0)
  {
    const ssize_t n = ::write(file, bytes, size);
    if (n < 0 && errno != EINTR) ::_exit(1);
    if (n < 0) continue;
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
}

/// Runs `work`, then writes the size of the result and the result.
[[noreturn]] void be_child(const std::function<std::string()>& work, int result_end, int output_end)
{
  ::dup2(output_end, STDOUT_FILENO);
  ::dup2(output_end, STDERR_FILENO);
  const std::string result = work();
  const std::size_t size = result.size();
  std::array<char, sizeof(size)> head{};
  std::memcpy(head.data(), &size, sizeof(size));
  write_all(result_end, head.data(), head.size());
  write_all(result_end, result.data(), size);
  ::_exit(0);
}

/// Appends what can be read; false at the end of the file.
bool take(int file, std::string& to)
{
  std::array<char, 1 << 16> buffer;
  const ssize_t n = ::read(file, buffer.data(), buffer.size());
  if (n > 0) to.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

/// Reads both pipes until they end or a limit is reached.
ApartEnd listen(int result_end, int output_end, const ApartLimits& limits, ApartOutcome& outcome)
{
  std::array<pollfd, 2> files = {pollfd{result_end, POLLIN, 0}, pollfd{output_end, POLLIN, 0}};
  // Counted in ticks, not by a clock: the time for which both processes are suspended does not count.
  double silence = 0;
  while (files[0].fd >= 0)
  {
    if (limits.stop != nullptr && *limits.stop) return ApartEnd::stopped;
    const int n = ::poll(files.data(), files.size(), tick_milliseconds);
    if (n == 0) silence += 1e-3 * tick_milliseconds;
    if (silence > limits.silence) return ApartEnd::silent;
    if (n <= 0) continue;
    silence = 0;
    if (files[0].revents != 0 && !take(result_end, outcome.result)) files[0].fd = -1;
    if (files[1].fd >= 0 && files[1].revents != 0 && !take(output_end, outcome.output)) files[1].fd = -1;
    if (outcome.output.size() > most_output) outcome.output.erase(0, outcome.output.size() - kept_output);
  }
  while (files[1].fd >= 0 && ::poll(&files[1], 1, 0) > 0)
    if (!take(output_end, outcome.output)) files[1].fd = -1;
  return ApartEnd::complete;
}

}  // namespace

ApartOutcome run_apart(const std::function<std::string()>& work, const ApartLimits& limits)
{
  Pipe result;
  Pipe output;
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw SolveError(std::string("cannot start a process: ") + std::strerror(errno));
  if (child == 0)
  {
    prepare_child(parent, limits.memory);
    be_child(work, result.writing(), output.writing());
  }
  result.close_writing();
  output.close_writing();

  ApartOutcome outcome;
  outcome.end = listen(result.reading(), output.reading(), limits, outcome);
  if (outcome.end != ApartEnd::complete) ::kill(child, SIGKILL);
  while (::waitpid(child, &outcome.status, 0) < 0 && errno == EINTR)
  {
  }
  if (outcome.end != ApartEnd::complete) return outcome;

  std::size_t size = 0;
  const bool has_head = outcome.result.size() >= sizeof(size);
  if (has_head) std::memcpy(&size, outcome.result.data(), sizeof(size));
  if (has_head && outcome.result.size() == sizeof(size) + size)
    outcome.result.erase(0, sizeof(size));
  else
    outcome.end = WIFSIGNALED(outcome.status) && WTERMSIG(outcome.status) == SIGXCPU ? ApartEnd::out_of_time
                                                                                     : ApartEnd::crashed;
  return outcome;
}

void limit_from_here(double memory, double seconds)
{
  limit_memory(memory);
  limit(RLIMIT_CPU, std::ceil(cpu_seconds() + seconds));
}

std::string describe_end(int status)
{
  if (WIFSIGNALED(status))
    return "was ended by signal " + std::to_string(WTERMSIG(status)) + " (" + ::strsignal(WTERMSIG(status)) +
           ")";
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  return code == 0 ? std::string{} : "ended with exit code " + std::to_string(code);
}

}  // namespace tribound
