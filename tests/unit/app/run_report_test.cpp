#include "app/command/run_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tribound/case/resolve.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/mesh/import/read.h"

namespace tribound
{
namespace
{

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* block_2d = R"(
degree = 2
mesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
material = { E = 1.0, nu = 0.3 }
boundary.left.displacement = [0, 0]
boundary.top.traction = [0, -0.1]
boundary.bottom.contact = { friction = "tresca", threshold = 0.01 }
adapt = { tolerance = 1e-6, max_levels = 4 }
)";
constexpr const char* block_3d = R"(
degree = 1
mesh.box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 1, 1] }
material = { E = 1.0, nu = 0.3 }
boundary.left.displacement = [0, 0, 0]
boundary.top.traction = [0, -0.1, 0]
boundary.bottom.contact = { friction = "tresca", threshold = 0.01 }
adapt = { tolerance = 1e-6, max_levels = 4 }
)";

/// Removes what depends on a clock.
nlohmann::json without_times(nlohmann::json value)
{
  if (value.is_object())
    for (const char* key : {"times", "written"}) value.erase(key);
  if (value.is_structured())
    for (nlohmann::json& part : value) part = without_times(part);
  return value;
}

/// convergence.csv without its last three columns, which are times.
std::string without_times(const std::string& table)
{
  std::istringstream lines(table);
  std::string result;
  for (std::string line; std::getline(lines, line); result += line + '\n')
    for (int column = 0; column < 3; ++column) line.erase(line.rfind(','));
  return result;
}

nlohmann::json page_data(const std::string& page)
{
  const std::string tag = R"(<script type="application/json" id="run-data">)";
  const std::size_t begin = page.find(tag) + tag.size();
  nlohmann::json data = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  data["tables"].erase("convergence.csv");  // compared as a file
  return without_times(data);
}

/// The files of a directory without what depends on a clock.
std::map<std::string, std::string> contents(const fs::path& directory)
{
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
  {
    std::string text = io::read_text(entry.path());
    const std::string name = entry.path().filename().string();
    if (name == "certificate.json") text = without_times(nlohmann::json::parse(text)).dump();
    if (name == "report.html") text = page_data(text).dump();
    if (name == "convergence.csv") text = without_times(text);
    files[name] = std::move(text);
  }
  return files;
}

class RunReportTest : public ::testing::Test
{
 protected:
  RunReportTest()
      : directory(
            fs::path(::testing::TempDir()) /
            (std::string("run_report_") + ::testing::UnitTest::GetInstance()->current_test_info()->name()))
  {
    fs::remove_all(directory);
    fs::create_directories(directory);
  }
  ~RunReportTest() override
  {
    omp_set_num_threads(n_threads_);
    fs::remove_all(directory);
  }

  [[nodiscard]] fs::path out(int threads) const { return directory / std::to_string(threads); }

  /// One run reported twice: in place and in parallel with the computation, which has one thread. `between`
  /// is called after every level.
  template <int dim>
  void report_twice(const std::string& text, const std::function<void(int level)>& between = {}) const
  {
    omp_set_num_threads(1);
    std::array<case_file::Config, 2> configs = {case_file::parse_config(text), case_file::parse_config(text)};
    auto mesh = std::get<mesh::Mesh<dim>>(mesh::read_mesh(configs[0].mesh));
    const problem::Problem<dim> problem(case_file::resolve(configs[0], mesh));
    adapt::Levels<dim> levels(
        problem, configs[0].method, configs[0].adapt.tolerance,
        std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, configs[0].method));
    std::array<std::optional<app::RunReport<dim>>, 2> reports;
    for (int i = 0; i < 2; ++i)
    {
      configs[i].output.directory = out(i + 1);
      const std::vector<bool> slides(problem.boundaries().size(), false);
      reports[i].emplace(configs[i], problem, levels.discrete(), slides, Clock::now(), app::Printed::verdict);
    }
    const auto each = [&](const auto& tell)
    {
      for (const int i : {1, 0})  // in parallel first: it needs some time
      {
        omp_set_num_threads(i + 1);
        tell(*reports[i]);
      }
      omp_set_num_threads(1);
    };
    adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(configs[0].adapt);
    strategy.observer.level = [&](const adapt::LevelView<dim>& view)
    {
      each([&](app::RunReport<dim>& report) { report.add(view); });
      if (between) between(view.number);
    };
    const certify::Verdict verdict = adapt::adapt(levels, strategy);
    each([&](app::RunReport<dim>& report)
         { EXPECT_EQ(report.close(verdict), app::ExitCode::budget_used_up); });
  }

  const fs::path directory;

 private:
  const int n_threads_ = omp_get_max_threads();
};

TEST_F(RunReportTest, TheFilesDoNotDependOnTheNumberOfThreads)
{
  for (const std::string levels : {"last", "all"})
    for (const int dim : {2, 3})
    {
      SCOPED_TRACE(levels + " in " + std::to_string(dim) + "D");
      const std::string output = "output.levels = \"" + levels + "\"\n";
      dim == 2 ? report_twice<2>(block_2d + output) : report_twice<3>(block_3d + output);
      const auto one = contents(out(1));
      EXPECT_EQ(one, contents(out(2)));
      EXPECT_EQ(one.contains("level_000.vtu"), levels == "all");
      EXPECT_TRUE(one.contains("level_004.vtu") && one.contains("contact_004.vtu") &&
                  one.contains("adapted.msh"));
      EXPECT_EQ(nlohmann::json::parse(one.at("certificate.json"))["levels"].size(), 5u);
    }
}

/// When writing in parallel with the computation of a level fails, this is known once the level is complete.
TEST_F(RunReportTest, WhatCannotBeWrittenEndsTheRun)
{
  for (const int threads : {1, 2})
  {
    int last = -1;
    const auto replace_directory = [&](int level)
    {
      last = level;
      if (level != 1) return;
      fs::rename(out(threads), directory / ("moved_" + std::to_string(threads)));
      std::ofstream(out(threads)) << "no directory";
    };
    EXPECT_THAT([&]
                { report_twice<2>(std::string(block_2d) + "output.levels = \"all\"\n", replace_directory); },
                ThrowsMessage<io::WriteError>(HasSubstr("cannot write this file")));
    EXPECT_LE(last, threads);
    fs::remove(out(threads));
  }
}

}  // namespace
}  // namespace tribound
