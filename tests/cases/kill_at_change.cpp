/// @file kill_at_change.cpp
/// Loaded before the program: kills it (SIGKILL) just before a change to the file system. KILL_AT_CHANGE is
/// the number of the change, from 1. A change renames or removes a file.

#include <dlfcn.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace
{

void count_change()
{
  static int number = 0;
  ++number;
  const char* last = std::getenv("KILL_AT_CHANGE");
  if (last != nullptr && number == std::atoi(last)) ::raise(SIGKILL);
}

template <class Function>
Function* next(const char* name)
{
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" int rename(const char* from, const char* to) noexcept
{
  count_change();
  return next<int(const char*, const char*)>("rename")(from, to);
}

extern "C" int remove(const char* path) noexcept
{
  count_change();
  return next<int(const char*)>("remove")(path);
}

extern "C" int unlink(const char* path) noexcept
{
  count_change();
  return next<int(const char*)>("unlink")(path);
}
