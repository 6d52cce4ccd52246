#include "tribound/case/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "tribound/case/geometry_reader.h"
#include "tribound/case/history_reader.h"
#include "tribound/case/node.h"
#include "tribound/case/physics.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/table_reader.h"
#include "tribound/fem/degree.h"
#include "tribound/mesh/box.h"

namespace tribound::case_file
{

namespace
{

constexpr auto mesh_hint =
    "file = \"block.msh\", or box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }";

template <class T, class Convert>
std::vector<T> components(const TableReader& table, std::string_view key, const Convert& convert)
{
  std::vector<T> values;
  for (const Node& item : to_components(table.require(key, mesh_hint), "one number per dimension"))
    values.push_back(convert(item));
  return values;
}

mesh::BoxMesh read_box(const Node& node)
{
  const TableReader table(node, {"lower", "upper", "cells"});
  mesh::BoxMesh box{
      .lower = components<double>(table, "lower", to_number),
      .upper = components<double>(table, "upper", to_number),
      .cells = components<int>(table, "cells", integer_from(1, "the number of cells in this direction")),
      .where = node.where};
  mesh::require_valid(box);
  return box;
}

/// One box for each name.
mesh::Boxes read_boxes(const Node& node)
{
  constexpr auto hint =
      "one box for each body: boxes.upper = { lower = [0, 1], upper = [2, 2], cells = [4, 2] }";
  const auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr) fail_type(node, "a table", hint);
  if (table->empty()) throw InputError(node.where, "is empty", hint);
  mesh::Boxes boxes;
  for (const Entry& entry : *table)
  {
    boxes.push_back({entry.name, read_box(entry.node)});
    if (boxes.back().box.lower.size() != boxes.front().box.lower.size())
      throw InputError(entry.where, "has another dimension than the first box",
                       "the boxes of a case are all 2D or all 3D");
  }
  return boxes;
}

mesh::MeshSource read_mesh_source(const Node& node, const std::filesystem::path& case_directory)
{
  const TableReader table(node, {"file", "box", "boxes"});
  const Node* file = table.find("file");
  const std::string hint = fmt::format("one of them: {}", mesh_hint);
  const Node* made = nullptr;  // by this program
  for (const std::string_view key : {"box", "boxes"})
    if (const Node* other = table.find(key))
    {
      if (file != nullptr || made != nullptr)
        throw InputError(other->where,
                         fmt::format("{} stands beside {}", key, file != nullptr ? "file" : "box"), hint);
      made = other;
    }
  if (file == nullptr && made == nullptr) throw InputError(node.where, "neither file nor box is given", hint);
  if (made != nullptr && made == table.find("boxes")) return read_boxes(*made);
  if (made != nullptr) return read_box(*made);
  const std::string path = to_text(*file);
  if (path.empty()) throw InputError(file->where, "is empty", mesh_hint);
  return mesh::MeshFile{case_directory / path, file->where};
}

void read_nitsche(const Node& node, adapt::Method& method)
{
  const TableReader table(node, {"gamma0"});
  table.read("gamma0", method.gamma0, number_in(positive, "the dimensionless penalty, such as 10"));
}

void read_newton(const Node& node, adapt::Method& method)
{
  const TableReader table(node, {"stopping", "gamma_lin", "tolerance", "max_steps", "damping", "finish"});
  adapt::StoppingOptions& stopping = method.stopping;
  table.read("stopping", stopping.criterion,
             one_of<adapt::Stopping>({"adaptive", "adaptive_local", "tolerance"}));
  table.read("gamma_lin", stopping.gamma_lin,
             number_in(positive, "the share of the linearisation in the error, such as 0.1"));
  solve::NewtonOptions& newton = method.newton;
  table.read("tolerance", newton.tolerance,
             number_in({.lower = 0.0, .upper = 1.0}, "a relative residual, such as 1e-10"));
  table.read("max_steps", newton.max_steps, integer_from(1, "a number of steps, such as 50"));
  table.read("damping", newton.damping, to_bool);
  table.read("finish", stopping.finish, to_bool);
}

adapt::RegularisationOptions read_regularisation(const Node& node)
{
  const TableReader table(node, {"delta", "factor", "gamma_reg", "max_updates"});
  adapt::RegularisationOptions regularisation;
  table.read("delta", regularisation.delta,
             number_in(positive, "a multiple of the mean contact traction, such as 1"));
  table.read("factor", regularisation.factor,
             number_in({.lower = 0.0, .upper = 1.0}, "what an update multiplies delta by, such as 0.25"));
  table.read("gamma_reg", regularisation.gamma_reg,
             number_in(positive, "the share of the regularisation in the error, such as 0.1"));
  table.read("max_updates", regularisation.max_updates, integer_from(0, "a number of updates, such as 20"));
  return regularisation;
}

adapt::AdaptOptions read_adapt(const Node& node)
{
  const TableReader table(
      node, {"tolerance", "marking", "theta", "separate_contact", "max_levels", "max_dofs", "max_cells",
             "max_time", "max_memory", "measure", "energy_tolerance", "goal", "goal_tolerance"});
  adapt::AdaptOptions adapt;
  table.read("tolerance", adapt.tolerance, number_in(positive, "a relative error, such as 0.01"));
  table.read("measure", adapt.measure, one_of<adapt::ErrorMeasure>({"residual", "energy"}));
  table.read("energy_tolerance", adapt.bars.energy_tolerance,
             number_in(positive, "a relative error in the energy norm, such as 0.05"));
  table.read("goal", adapt.bars.goal, to_text);
  table.read("goal_tolerance", adapt.bars.goal_tolerance,
             number_in(positive, "the relative size of its bar, such as 0.01"));
  table.read("marking", adapt.marking.strategy, one_of<adapt::Marking>({"doerfler", "maximum", "uniform"}));
  table.read(
      "theta", adapt.marking.theta,
      number_in({.lower = 0.0, .upper = 1.0, .includes_upper = true}, "such as 0.5; 1 marks every cell"));
  table.read("separate_contact", adapt.marking.separate_contact, to_bool);
  table.read("max_levels", adapt.max_levels, integer_from(0, "0 solves on the given mesh only"));
  table.read("max_dofs", adapt.max_dofs, integer_from(1L, "a number of unknowns, such as 2_000_000"));
  table.read("max_cells", adapt.max_cells, integer_from(1L, "a number of cells, such as 500_000"));
  table.read("max_time", adapt.max_time, number_in(positive, "seconds, such as 600"));
  table.read("max_memory", adapt.max_memory, number_in(positive, "GB, such as 16"));
  return adapt;
}

void read_certify(const Node& node, Config& config)
{
  const TableReader table(node, {"contact_rule", "energy"});
  table.read("contact_rule", config.method.contact_rule,
             one_of<certify::ContactRule>({"resolved", "reference"}));
  table.read("energy", config.adapt.bars.levels, one_of<adapt::EnergyLevels>({"off", "last", "every"}));
}

algebra::SolverOptions read_solver(const Node& node)
{
  const TableReader table(node, {"method", "package", "tolerance", "gamma_alg", "max_iterations"});
  algebra::SolverOptions solver;
  table.read("method", solver.method,
             one_of<algebra::LinearMethod>({"auto", "direct", "condensed", "iterative"}));
  table.read("package", solver.package, one_of<algebra::DirectPackage>({"auto", "mumps", "umfpack"}));
  table.read("tolerance", solver.tolerance,
             number_in({.lower = 0.0, .upper = 1.0}, "a relative residual, such as 1e-10"));
  table.read("gamma_alg", solver.gamma_alg,
             number_in({.lower = 0.0, .upper = 1.0, .includes_lower = true},
                       "the fraction of the bound that the linear solver may leave, such as 0.05, or 0"));
  table.read("max_iterations", solver.max_iterations, integer_from(1, "a number of iterations, such as 500"));
  return solver;
}

StudyConfig read_study(const Node& node, int degree)
{
  const TableReader table(
      node, {"reference_degree", "reference_factor", "max_reference_dofs", "dual_norm_dofs", "figures"});
  StudyConfig study;
  table.read(
      "reference_degree", study.reference_degree,
      integer_from(degree, fmt::format("not below the degree of the case, not above {}", fem::max_degree),
                   fem::max_degree));
  table.read("reference_factor", study.reference_factor,
             number_in({.lower = 0.0, .upper = 1.0, .includes_upper = true},
                       "how much smaller the bound of the reference shall be, such as 0.2"));
  table.read("max_reference_dofs", study.max_reference_dofs,
             integer_from(1L, "a number of unknowns, such as 500_000"));
  table.read("dual_norm_dofs", study.dual_norm_dofs,
             integer_from(0L, "a number of unknowns, such as 100_000; 0 computes no dual norms"));
  table.read("figures", study.figures, to_bool);
  return study;
}

Checkpoints to_checkpoints(const Node& node)
{
  if (const auto* text = std::get_if<std::string>(&node.value); text && *text == "all")
    return Checkpoints::all;
  if (!std::holds_alternative<bool>(node.value)) fail_type(node, "true, false or \"all\"", "true");
  return to_bool(node) ? Checkpoints::last : Checkpoints::none;
}

OutputConfig read_output(const Node& node, OutputConfig output)
{
  const TableReader table(node,
                          {"directory", "vtu", "levels", "report", "mesh", "checkpoint", "moment_about"});
  table.read("directory", output.directory, to_text);
  if (output.directory.empty())
    throw InputError(table.find("directory")->where, "is empty", "a directory to write to, such as \"out\"");
  table.read("vtu", output.vtu, to_bool);
  table.read("levels", output.levels, one_of<FieldLevels>({"last", "all"}));
  table.read("report", output.report, to_bool);
  table.read("mesh", output.mesh, to_bool);
  table.read("checkpoint", output.checkpoints, to_checkpoints);
  if (const Node* point = table.find("moment_about"))
  {
    output.moment_about_where = point->where;
    output.moment_about = to_numbers(*point, "one coordinate per dimension");
  }
  return output;
}

/// The document as a case file in the output directory: paths lead from there.
io::EffectiveCase effective_case(Node document, const Config& config, std::span<const std::string> overrides)
{
  auto& tables = std::get<Node::Table>(document.value);
  const auto from_there = [&config](const std::filesystem::path& file)
  {
    std::error_code unknown;
    const std::filesystem::path path = std::filesystem::absolute(file, unknown);
    const std::filesystem::path relative =
        std::filesystem::relative(path, std::filesystem::absolute(config.output.directory, unknown), unknown);
    return (unknown || relative.empty() ? path : relative).string();
  };
  const auto table = [](Node::Table& parent, std::string_view key) -> Node::Table&
  { return std::get<Node::Table>(find(parent, key)->node.value); };
  if (const auto* file = std::get_if<mesh::MeshFile>(&config.mesh))
    find(table(tables, "mesh"), "file")->node.value = from_there(file->path);
  for (const auto& [kind, surfaces] : {std::pair("obstacle", &config.obstacles), {"shape", &config.shapes}})
    for (const SurfaceConfig& surface : *surfaces)
      if (surface.kind == SurfaceConfig::Kind::surface)
        find(table(table(tables, kind), surface.name), "surface")->node.value = from_there(surface.file);
  if (find(tables, "output") == nullptr) tables.push_back({"output", {}, {Node::Table{}, {}}});
  auto& output = std::get<Node::Table>(find(tables, "output")->node.value);
  if (find(output, "directory") == nullptr)
    output.insert(output.begin(), {"directory", {}, {config.output.directory.string(), {}}});
  return {to_toml(document), {overrides.begin(), overrides.end()}};
}

Config read_document(const Node& document, std::string file)
{
  const TableReader root(document, {"title", "degree", "mesh", "material", "load", "boundary", "contact",
                                    "nitsche", "newton", "obstacle", "shape", "quantity", "history",
                                    "regularisation", "adapt", "certify", "solver", "study", "output"});
  Config config;
  const std::filesystem::path case_directory = std::filesystem::path(file).parent_path();
  config.file = std::move(file);
  root.read("title", config.title, to_text);
  root.read("degree", config.method.degree, integer_from(1, "the polynomial degree p", fem::max_degree));
  config.mesh =
      read_mesh_source(root.require("mesh", fmt::format("[mesh] with {}", mesh_hint)), case_directory);
  config.materials = read_materials(root.require("material", "[material] with E = 210e9 and nu = 0.3"));
  root.read("load", config.loads, read_loads);
  root.read("boundary", config.boundaries, read_boundaries);
  root.read("contact", config.contacts, read_contacts);
  root.read("obstacle", config.obstacles,
            [&](const Node& node) { return read_obstacles(node, case_directory); });
  root.read("shape", config.shapes, [&](const Node& node) { return read_shapes(node, case_directory); });
  check_surfaces(config);
  root.read("quantity", config.quantities, read_quantities);
  read_load_steps(root, config);
  const auto read_method = [&](std::string_view key, const auto& read)
  {
    if (const Node* node = root.find(key)) read(*node, config.method);
  };
  read_method("nitsche", read_nitsche);
  read_method("newton", read_newton);
  root.read("regularisation", config.method.regularisation, read_regularisation);
  root.read("adapt", config.adapt, read_adapt);
  if (const Node* node = root.find("certify")) read_certify(*node, config);
  root.read("solver", config.method.solver, read_solver);
  root.read("study", config.study, [&](const Node& node) { return read_study(node, config.method.degree); });
  config.output.directory = default_directory(config.file);
  root.read("output", config.output, [&](const Node& node) { return read_output(node, config.output); });
  check_load_steps(root, config);
  check_error_bars(root, config);
  return config;
}

}  // namespace

std::filesystem::path default_directory(const std::filesystem::path& case_file)
{
  return std::filesystem::path("out") / case_file.stem();
}

mesh::FindSeams find_seams(const Config& config)
{
  return [&config](std::span<const std::string> boundary_names)
  {
    mesh::Seams seams;
    for (const ContactConfig& contact : config.contacts)
    {
      const auto require = [&](const std::string& name)
      { (void)problem::group_number(name, boundary_names, contact.where, "boundary"); };
      std::ranges::for_each(contact.slave, require);
      if (!contact.joint.empty())
      {
        seams.joints.push_back(contact.joint);
        continue;
      }
      std::ranges::for_each(contact.master, require);
      seams.interfaces.push_back({{contact.slave, contact.master}});
    }
    return seams;
  };
}

std::string friction_name(const Config& config)
{
  std::string text;
  for (const std::string_view law : problem::law_names)
    if (std::ranges::any_of(config.boundaries, [&](const BoundaryConfig& boundary)
                            { return boundary.contact && name(boundary.contact->law) == law; }) ||
        std::ranges::any_of(config.contacts,
                            [&](const ContactConfig& contact) { return name(contact.contact.law) == law; }))
      text += (text.empty() ? "" : "+") + std::string(law);
  return text;
}

Config parse_config(std::string_view text, std::string name, std::span<const std::string> overrides)
{
  Node document = parse_toml(text, name);
  for (const std::string& assignment : overrides) apply_override(document, assignment);
  // The document itself stands nowhere in particular.
  document.where.line = document.where.column = 0;
  Config config = read_document(document, std::move(name));
  config.effective = effective_case(std::move(document), config, overrides);
  return config;
}

Config read_config(const std::filesystem::path& file, std::span<const std::string> overrides)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError({.file = file.string()},
                     stream ? "is a directory" : fmt::format("cannot be read: {}", std::strerror(errno)),
                     "the path of a case file, such as examples/01_tresca_block/case.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_config(text, file.string(), overrides);
}

}  // namespace tribound::case_file
