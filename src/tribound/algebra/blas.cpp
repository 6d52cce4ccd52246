#include "tribound/algebra/blas.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace tribound::algebra
{

namespace
{

/// The function of this name in the process; null where there is none.
template <typename Function>
Function* find_function(const char* name)
{
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// OpenBLAS's name of the processor whose kernels it runs; empty for another BLAS.
std::string_view kernels()
{
  const auto name = find_function<const char*()>("openblas_get_corename");
  return name ? name() : "";
}

/// The kernels for the vector instructions that this processor has; null where OpenBLAS's choice cannot be
/// improved.
const char* kernels_of_instructions()
{
#ifdef __x86_64__
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

/// The file that provides BLAS (Debian's alternatives are links).
std::string library_file()
{
  Dl_info info{};
  void* dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
  if (!dgemm || dladdr(dgemm, &info) == 0) return "unknown";
  std::error_code error;
  const std::filesystem::path path = std::filesystem::canonical(info.dli_fname, error);
  return error ? info.dli_fname : path.string();
}

}  // namespace

void choose_blas_kernels()
{
  constexpr const char* variable = "OPENBLAS_CORETYPE";
  constexpr std::string_view of_unknown = "Prescott";
  const char* chosen = kernels_of_instructions();
  if (kernels() != of_unknown || !chosen || std::getenv(variable)) return;
  // Repeats what OpenBLAS does when it is loaded: nothing else makes it choose again.
  const auto forget = find_function<void()>("gotoblas_dynamic_quit");
  const auto choose = find_function<void()>("gotoblas_dynamic_init");
  if (!forget || !choose) return;
  ::setenv(variable, chosen, 1);
  forget();
  choose();
  ::unsetenv(variable);
}

BlasFacts blas_facts()
{
  BlasFacts facts{.library = library_file()};
  if (const std::string_view name = kernels(); !name.empty()) facts.library += " (" + std::string(name) + ")";
  if (const auto count = find_function<int()>("openblas_get_num_threads")) facts.threads = count();
  return facts;
}

void set_blas_threads(int n)
{
  if (const auto set = find_function<void(int)>("openblas_set_num_threads")) set(n);
}

}  // namespace tribound::algebra
