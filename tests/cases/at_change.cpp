/// @file at_change.cpp
/// Loaded before the program: acts just before each change to the file system, that is before a file is
/// renamed or removed. With COPIES the directory `out` is copied to COPIES/N before change N, as a kill
/// (SIGKILL) would leave it then. With KILL_AT_CHANGE the program is killed before that change. Both count
/// from 1.

#include <dlfcn.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace
{

void act_before_change()
{
  static int number = 0;
  ++number;
  const char* copies = std::getenv("COPIES");
  if (copies != nullptr && std::filesystem::exists("out"))
    std::filesystem::copy("out", std::filesystem::path(copies) / std::to_string(number),
                          std::filesystem::copy_options::recursive);
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
  act_before_change();
  return next<int(const char*, const char*)>("rename")(from, to);
}

extern "C" int remove(const char* path) noexcept
{
  act_before_change();
  return next<int(const char*)>("remove")(path);
}

extern "C" int unlink(const char* path) noexcept
{
  act_before_change();
  return next<int(const char*)>("unlink")(path);
}
