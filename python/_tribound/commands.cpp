#include "python/_tribound/commands.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/command/commands.h"
#include "app/command/run.h"
#include "app/host.h"
#include "app/result/sweep.h"
#include "python/_tribound/document.h"
#include "python/_tribound/level.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/ranks.h"

namespace tribound::python
{

namespace py = pybind11;

namespace
{

/// MPI and PETSc, from the first command to the end of the interpreter.
std::unique_ptr<algebra::Libraries>& libraries()
{
  static std::unique_ptr<algebra::Libraries> started;
  return started;
}

void start()
{
  if (!libraries()) libraries() = std::make_unique<algebra::Libraries>();
}

/// The text of the first process on all.
std::string from_first(const std::string& text)
{
  std::vector<char> characters(text.begin(), text.end());
  if (app::n_processes() > 1) Ranks::world().copy_from_first(characters);
  return {characters.begin(), characters.end()};
}

/// Of an object with the function `level`, and `mark` and `stop`, functions or None.
template <int dim>
app::LoopHooks<dim> loop_hooks(const py::object& hooks)
{
  app::LoopHooks<dim> result;
  using Kept = std::shared_ptr<const app::KeptLevel<dim>>;
  result.level = [&hooks](const Kept& kept, const io::LevelRecord& record)
  {
    const py::gil_scoped_acquire lock;
    hooks.attr("level")(to_level<dim>(kept, record));
  };
  if (!hooks.attr("mark").is_none())
    result.mark = [&hooks](const Kept& kept)
    {
      const py::gil_scoped_acquire lock;
      return hooks.attr("mark")(Level<dim>{kept}).template cast<std::vector<Index>>();
    };
  if (!hooks.attr("stop").is_none())
    result.stop = [&hooks](const Kept& kept)
    {
      const py::gil_scoped_acquire lock;
      return hooks.attr("stop")(Level<dim>{kept}).template cast<std::string>();
    };
  return result;
}

/// Of an object that also has the function `step`.
app::RunHooks run_hooks(const py::object& hooks)
{
  const auto after_step = [&hooks](const adapt::CertifiedStep& step)
  {
    const py::gil_scoped_acquire lock;
    hooks.attr("step")(step.step.step, step.step.residual, step.relative, step.step.seconds);
  };
  return {.step = after_step, .plane = loop_hooks<2>(hooks), .space = loop_hooks<3>(hooks)};
}

app::CaseRequest request(const Document& document, const std::vector<std::string>& overrides, bool quiet)
{
  return {.case_file = document.name, .overrides = overrides, .quiet = quiet, .document = &document.node};
}

int run(const Document& document, const std::vector<std::string>& overrides, bool quiet,
        const py::object& hooks)
{
  const app::RunHooks all = run_hooks(hooks);
  const py::gil_scoped_release others_run;
  return static_cast<int>(app::run(request(document, overrides, quiet), {}, all));
}

int restart(const std::string& place, const std::vector<std::string>& overrides, bool quiet,
            const py::object& hooks)
{
  const app::RunHooks all = run_hooks(hooks);
  const py::gil_scoped_release others_run;
  return static_cast<int>(app::run({.case_file = {}, .overrides = overrides, .quiet = quiet}, place, all));
}

/// What `tribound check --json` prints.
std::string check(const Document& document, const std::vector<std::string>& overrides)
{
  const py::gil_scoped_release others_run;
  std::string text;
  const auto print = std::exchange(app::host().print, [&text](std::string_view part) { text += part; });
  try
  {
    app::check(request(document, overrides, true), true);
  }
  catch (...)
  {
    app::host().print = print;
    throw;
  }
  app::host().print = print;
  return text;
}

int judge(const Document& document, const std::vector<std::string>& overrides, bool quiet,
          const py::dict& options)
{
  app::JudgeRequest what{request(document, overrides, quiet)};
  what.solutions = options["solutions"].cast<std::vector<std::string>>();
  what.field = options["field"].cast<std::string>();
  what.stress = options["stress"].cast<std::string>();
  what.interpolate = options["interpolate"].cast<bool>();
  what.steps = options["steps"].cast<bool>();
  what.step = options["step"].cast<std::optional<int>>();
  what.load_step = options["load_step"].cast<std::optional<int>>();
  what.numbers = options["numbers"].cast<std::vector<std::string>>();
  what.accept = options["accept"].cast<std::optional<double>>();
  const py::gil_scoped_release others_run;
  return static_cast<int>(app::judge(what));
}

/// Text is printed on the host's functions. They are never released: the process may end after the
/// interpreter.
void set_output(const py::object& print, const py::object& note)
{
  const auto caller = [](const py::object& function)
  {
    return [kept = new py::object(function)](std::string_view text)
    {
      const py::gil_scoped_acquire lock;
      (*kept)(std::string(text));
    };
  };
  app::host() = {
      .is_present = true, .program = app::host().program, .print = caller(print), .note = caller(note)};
}

/// Status, reason and figures of a run by the files in its directory, as in sweep.csv; `sha256`: of its case.
py::dict read_results(const std::string& directory, int exit_code, const std::string& sha256)
{
  app::SweepRun run{};
  run.exit_code = exit_code;
  run.sha256 = sha256;
  app::read_results(directory, run);
  py::dict results;
  results["status"] = run.status;
  results["reason"] = run.reason;
  for (const auto& [name, value] : run.figures) results[py::str(name)] = value;
  return results;
}

}  // namespace

void bind_commands(py::module_& module)
{
  module.def("start", &start);
  module.def("finish", [] { libraries().reset(); });
  module.def("n_processes", &app::n_processes);
  module.def("is_first_process", &app::is_first_process);
  module.def("from_first", &from_first);
  module.def("request_stop", &app::request_stop);
  module.def("forget_stop", &app::forget_stop);
  module.def("set_output", &set_output);
  module.def("run", &run);
  module.def("restart", &restart);
  module.def("check", &check);
  module.def(
      "verify",
      [](const Document& document, const std::vector<std::string>& overrides, bool quiet, int refinements)
      {
        const py::gil_scoped_release others_run;
        return static_cast<int>(app::verify(request(document, overrides, quiet), refinements));
      });
  module.def("study",
             [](const Document& document, const std::vector<std::string>& overrides, bool quiet)
             {
               const py::gil_scoped_release others_run;
               return static_cast<int>(app::study(request(document, overrides, quiet)));
             });
  module.def("judge", &judge);
  module.def("read_results", &read_results);
}

}  // namespace tribound::python
