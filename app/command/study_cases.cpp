#include "app/command/study_cases.h"

#include <algorithm>
#include <limits>

#include "tribound/fem/degree.h"

namespace tribound::app
{

case_file::Config variant_config(const case_file::Config& config, const std::string& name)
{
  case_file::Config variant = config;
  const bool converged = name.ends_with("_converged");
  if (converged)
    variant.method.stopping.criterion = adapt::Stopping::tolerance;
  else if (config.method.stopping.criterion == adapt::Stopping::tolerance)
    variant.method.stopping.criterion = adapt::Stopping::adaptive;
  if (name.starts_with("uniform")) variant.adapt.marking.strategy = adapt::Marking::uniform;
  variant.method.stopping.finish = false;  // the study compares stopping criteria
  if (config.adapt.bars.levels != adapt::EnergyLevels::off)
    variant.adapt.bars.levels = adapt::EnergyLevels::every;  // for its effectivity
  variant.output.directory /= name;
  variant.effective = {};  // that of the study is next to its tables
  variant.output.vtu = config.output.vtu && !converged;
  variant.output.levels = case_file::FieldLevels::all;  // each gets its errors at the end
  variant.output.mesh = false;
  return variant;
}

case_file::Config reference_config(const case_file::Config& config, double required)
{
  case_file::Config reference = config;
  reference.method.degree =
      config.study.reference_degree.value_or(std::min(config.method.degree + 1, fem::max_degree));
  reference.method.stopping.criterion = adapt::Stopping::adaptive;
  reference.method.stopping.gamma_lin = 0.1 * config.method.stopping.gamma_lin;
  reference.method.newton.damping = true;
  reference.method.stopping.finish = false;
  reference.adapt.tolerance = required;
  reference.adapt.measure = adapt::ErrorMeasure::residual;
  reference.adapt.bars = {};  // no requirements
  if (config.adapt.bars.levels != adapt::EnergyLevels::off)
    reference.adapt.bars.levels = adapt::EnergyLevels::last;
  reference.adapt.max_levels = std::numeric_limits<int>::max();
  reference.adapt.max_cells.reset();
  reference.adapt.max_dofs = config.study.max_reference_dofs;
  reference.output.directory /= "reference";
  reference.effective = {};
  reference.output.vtu = false;
  reference.output.mesh = false;
  return reference;
}

}  // namespace tribound::app
