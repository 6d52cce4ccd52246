#include "app/output_directory.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <variant>

#include "tribound/base/error.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/state/checkpoint.h"

namespace tribound::app
{

namespace
{

constexpr const char* judged_steps = "judged_steps";

void remove_judged_steps(const std::filesystem::path& directory)
{
  std::error_code error;
  for (const auto& step : std::filesystem::directory_iterator(directory, error))
  {
    io::remove_results(step.path(), {"judged_cells.csv", "judged.vtu"});
    std::filesystem::remove(step.path(), error);  // fails if it has other contents
  }
  std::filesystem::remove(directory, error);
}

}  // namespace

void require_mesh_elsewhere(const case_file::Config& config)
{
  const auto* mesh = std::get_if<mesh::MeshFile>(&config.mesh);
  std::error_code none;
  if (mesh != nullptr &&
      std::filesystem::equivalent(mesh->path, config.output.directory / "adapted.msh", none))
    throw InputError(mesh->where, "is the adapted.msh that this run would remove from output.directory",
                     "choose another output.directory, or copy the mesh");
}

std::unique_ptr<io::OutputDirectory> take_directory(const case_file::Config& config, bool keeps_results)
{
  require_mesh_elsewhere(config);
  const std::filesystem::path& path = config.output.directory;
  auto directory = std::make_unique<io::OutputDirectory>(path);
  if (keeps_results) return directory;
  io::remove_results(path, {"certificate.json", "report.html", "report.pdf", "judgement.pdf",
                            "convergence.csv", "quantities.csv", "probes.csv", "sections.csv", "history.csv",
                            "newton.csv", "contact.csv", "adapted.msh", "judgement.json", "judgement.html",
                            "judged_cells.csv", "judged.vtu", io::checkpoint_name, io::step_log_name});
  for (const char* unfinished : {io::unfinished_pass, io::unfinished_steps})
    io::remove_series_directory(path / unfinished);
  io::remove_series(path);
  remove_judged_steps(path / judged_steps);
  return directory;
}

std::filesystem::path judged_step_directory(std::size_t step)
{
  return std::filesystem::path(judged_steps) / fmt::format("{:03}", step + 1);
}

std::string effective_file_name(const case_file::Config& config)
{
  const std::filesystem::path file = config.output.directory / "case.toml";
  std::error_code none;
  if (!std::filesystem::equivalent(file, config.file, none)) return "case.toml";
  return io::read_text(file) == config.effective.text ? "case.toml" : "case_effective.toml";
}

}  // namespace tribound::app
