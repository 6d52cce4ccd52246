#include "tribound/case/method_reader.h"

#include <fmt/format.h>

#include "tribound/fem/degree.h"

namespace tribound::case_file
{

namespace
{

using adapt::AdaptOptions;
using adapt::ErrorBars;
using adapt::MarkingOptions;
using adapt::Method;
using adapt::RegularisationOptions;
using adapt::StoppingOptions;
using algebra::SolverOptions;
using solve::NewtonOptions;

constexpr Interval fraction{.lower = 0.0, .upper = 1.0};
constexpr Interval fraction_or_0{.lower = 0.0, .upper = 1.0, .includes_lower = true};
constexpr Interval fraction_or_1{.lower = 0.0, .upper = 1.0, .includes_upper = true};

const Options<Method>& nitsche_options()
{
  static const Options<Method> options(
      "nitsche",
      {option<&Method::gamma0>("gamma0", number_in(positive, "the dimensionless penalty, such as 10"))});
  return options;
}

const Options<Method>& newton_options()
{
  static const Options<Method> options(
      "newton",
      {option<&Method::stopping, &StoppingOptions::criterion>(
           "stopping", one_of({"adaptive", "adaptive_local", "tolerance"})),
       option<&Method::stopping, &StoppingOptions::gamma_lin>(
           "gamma_lin", number_in(positive, "the share of the linearisation in the error, such as 0.1")),
       option<&Method::newton, &NewtonOptions::tolerance>(
           "tolerance", number_in(fraction, "a relative residual, such as 1e-10")),
       option<&Method::newton, &NewtonOptions::max_steps>("max_steps",
                                                          integer_from(1, "a number of steps, such as 50")),
       option<&Method::newton, &NewtonOptions::damping>("damping", truth()),
       option<&Method::stopping, &StoppingOptions::finish>("finish", truth())});
  return options;
}

const Options<RegularisationOptions>& regularisation_options()
{
  using R = RegularisationOptions;
  static const Options<R> options(
      "regularisation",
      {option<&R::delta>("delta", number_in(positive, "a multiple of the mean contact traction, such as 1")),
       option<&R::factor>("factor", number_in(fraction, "what an update multiplies delta by, such as 0.25")),
       option<&R::gamma_reg>(
           "gamma_reg", number_in(positive, "the share of the regularisation in the error, such as 0.1")),
       option<&R::max_updates>("max_updates", integer_from(0, "a number of updates, such as 20"))});
  return options;
}

const Options<AdaptOptions>& adapt_options()
{
  using A = AdaptOptions;
  static const Options<A> options(
      "adapt",
      {option<&A::tolerance>("tolerance", number_in(positive, "a relative error, such as 0.01")),
       option<&A::marking, &MarkingOptions::strategy>("marking", one_of({"doerfler", "maximum", "uniform"})),
       option<&A::marking, &MarkingOptions::theta>(
           "theta", number_in(fraction_or_1, "such as 0.5; 1 marks every cell")),
       option<&A::marking, &MarkingOptions::separate_contact>("separate_contact", truth()),
       option<&A::max_levels>("max_levels", integer_from(0, "0 solves on the given mesh only")),
       option<&A::max_dofs>("max_dofs", integer_from(1, "a number of unknowns, such as 2_000_000")),
       option<&A::max_cells>("max_cells", integer_from(1, "a number of cells, such as 500_000")),
       option<&A::max_time>("max_time", number_in(positive, "seconds, such as 600")),
       option<&A::max_memory>("max_memory", number_in(positive, "GB, such as 16")),
       option<&A::measure>("measure", one_of({"residual", "energy"})),
       option<&A::bars, &ErrorBars::energy_tolerance>(
           "energy_tolerance", number_in(positive, "a relative error in the energy norm, such as 0.05")),
       option<&A::bars, &ErrorBars::goal>("goal", text()),
       option<&A::bars, &ErrorBars::goal_tolerance>(
           "goal_tolerance", number_in(positive, "the relative size of its bar, such as 0.01"))});
  return options;
}

const Options<Config>& certify_options()
{
  static const Options<Config> options(
      "certify",
      {option<&Config::method, &Method::contact_rule>("contact_rule", one_of({"resolved", "reference"})),
       option<&Config::method, &Method::stress>("stress", one_of({"rows", "afw"})),
       option<&Config::adapt, &AdaptOptions::bars, &ErrorBars::levels>("energy",
                                                                       one_of({"off", "last", "every"}))});
  return options;
}

const Options<SolverOptions>& solver_options()
{
  using S = SolverOptions;
  static const Options<S> options(
      "solver",
      {option<&S::method>("method", one_of({"auto", "direct", "condensed", "iterative"})),
       option<&S::package>("package", one_of({"auto", "mumps", "umfpack"})),
       option<&S::tolerance>("tolerance", number_in(fraction, "a relative residual, such as 1e-10")),
       option<&S::gamma_alg>(
           "gamma_alg",
           number_in(fraction_or_0,
                     "the fraction of the bound that the linear solver may leave, such as 0.05, or 0")),
       option<&S::max_iterations>("max_iterations", integer_from(1, "a number of iterations, such as 500"))});
  return options;
}

std::string reference_degree_hint()
{
  return fmt::format("not below the degree of the case, not above {}", fem::max_degree);
}

const Options<StudyConfig>& study_options()
{
  using S = StudyConfig;
  static const Options<S> options(
      "study",
      {option<&S::reference_degree>("reference_degree",
                                    integer_from(1, reference_degree_hint(), fem::max_degree)),
       option<&S::reference_factor>(
           "reference_factor",
           number_in(fraction_or_1, "how much smaller the bound of the reference shall be, such as 0.2")),
       option<&S::max_reference_dofs>("max_reference_dofs",
                                      integer_from(1, "a number of unknowns, such as 500_000")),
       option<&S::dual_norm_dofs>(
           "dual_norm_dofs",
           integer_from(0, "a number of unknowns, such as 100_000; 0 computes no dual norms")),
       option<&S::figures>("figures", truth())});
  return options;
}

const Options<JudgeConfig>& judge_options()
{
  static const Options<JudgeConfig> options(
      "judge",
      {option<&JudgeConfig::sharpness>(
          "sharpness", number_in(positive, "the bound of ours over the distance of theirs, such as 0.1"))});
  return options;
}

const Options<OutputConfig>& output_options()
{
  using O = OutputConfig;
  static const Options<O> options(
      "output", {option<&O::directory>("directory", text("a directory to write to, such as \"out\"", 1)),
                 option<&O::vtu>("vtu", truth()), option<&O::levels>("levels", one_of({"last", "all"})),
                 option<&O::report>("report", truth()), option<&O::mesh>("mesh", truth()),
                 option<&O::checkpoints>("checkpoint", truth() | one_of({"all"})),
                 option<&O::moment_about>("moment_about", numbers("one coordinate per dimension"))});
  return options;
}

/// The degree of the reference must not be below that of the case.
void check_reference_degree(const TableReader& study, int degree)
{
  if (const Node* reference = study.find("reference_degree"))
    (void)to_integer_in(*reference, degree, fem::max_degree, reference_degree_hint());
}

}  // namespace

void convert(const Node& node, const Value& value, Checkpoints& target)
{
  const auto* word = std::get_if<std::string>(&node.value);
  if (word != nullptr && *word == value.words.front())
  {
    target = Checkpoints::all;
    return;
  }
  if (!std::holds_alternative<bool>(node.value)) fail_type(node, "true, false or \"all\"", "true");
  target = std::get<bool>(node.value) ? Checkpoints::last : Checkpoints::none;
}

std::vector<Key> method_keys()
{
  return {{"nitsche", keys_of(nitsche_options().table())},
          {"newton", keys_of(newton_options().table())},
          {"regularisation", keys_of(regularisation_options().table())},
          {"adapt", keys_of(adapt_options().table())},
          {"certify", keys_of(certify_options().table())},
          {"solver", keys_of(solver_options().table())},
          {"study", keys_of(study_options().table())},
          {"judge", keys_of(judge_options().table())},
          {"output", keys_of(output_options().table())}};
}

void read_method(const TableReader& root, Config& config)
{
  const auto read = [&root](const auto& options, std::string_view key, auto& target)
  {
    if (const Node* node = root.find(key)) options.read(*node, target);
  };
  read(nitsche_options(), "nitsche", config.method);
  read(newton_options(), "newton", config.method);
  if (root.has("regularisation"))
    read(regularisation_options(), "regularisation", config.method.regularisation.emplace());
  read(adapt_options(), "adapt", config.adapt);
  read(certify_options(), "certify", config);
  read(solver_options(), "solver", config.method.solver);
  if (const Node* node = root.find("study"))
    check_reference_degree(TableReader(*node, study_options().table()), config.method.degree);
  read(study_options(), "study", config.study);
  read(judge_options(), "judge", config.judge);
  read(output_options(), "output", config.output);
  if (const Node* node = root.find("output"))
    if (const Entry* point = find(std::get<Node::Table>(node->value), "moment_about"))
      config.output.moment_about_where = point->node.where;
}

}  // namespace tribound::case_file
