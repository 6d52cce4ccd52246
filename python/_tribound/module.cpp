/// @file module.cpp
/// The extension module tribound._tribound. Its names are for the package tribound, not for users.

#include <dlfcn.h>
#include <pybind11/pybind11.h>

#include <exception>
#include <filesystem>
#include <utility>

#include "app/host.h"
#include "python/_tribound/commands.h"
#include "python/_tribound/document.h"
#include "python/_tribound/level.h"
#include "python/_tribound/mesh.h"
#include "tribound/base/error.h"
#include "tribound/base/version.h"
#include "tribound/io/file/atomic_file.h"

namespace py = pybind11;
using namespace tribound;

namespace
{

/// Raises an exception of tribound.errors.
void raise(const char* name, const py::object& arguments)
{
  const py::object type = py::module_::import("tribound.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(*arguments).ptr());
}

void translate(std::exception_ptr failure)
{
  try
  {
    if (failure) std::rethrow_exception(std::move(failure));
  }
  catch (const InputError& error)
  {
    const Where& where = error.where();
    raise("InputError",
          py::make_tuple(error.what(), where.file, where.key, where.line, error.problem(), error.hint()));
  }
  catch (const SolveError& error)
  {
    raise("SolveError", py::make_tuple(error.what()));
  }
  catch (const io::WriteError& error)
  {
    raise("WriteError", py::make_tuple(error.what()));
  }
}

/// Where the program is, or would be: the files that it shares with the module are found from there.
std::filesystem::path program()
{
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&translate), &here) == 0) return {};
  const std::filesystem::path folder = std::filesystem::path(here.dli_fname).parent_path();
  for (const char* relative : {TRIBOUND_INSTALLED_PROGRAM, TRIBOUND_BUILT_PROGRAM})
    if (std::filesystem::exists(folder / relative)) return folder / relative;
  return {};
}

}  // namespace

PYBIND11_MODULE(_tribound, module)
{
  py::register_exception_translator(&translate);
  app::host() = {.is_present = true, .program = program()};
  module.attr("version") = version();
  python::bind_documents(module);
  python::bind_meshes(module);
  python::bind_levels(module);
  python::bind_commands(module);
}
