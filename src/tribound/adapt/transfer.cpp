#include "tribound/adapt/transfer.h"

#include <fmt/format.h>

#include <new>
#include <utility>
#include <vector>

#include "tribound/adapt/contact_functions.h"
#include "tribound/adapt/finer.h"
#include "tribound/base/rank_failure.h"

namespace tribound::adapt
{

namespace
{

template <int dim>
using Position = typename LoadPath<dim>::Position;

/// Transfers positions of a path to a finer mesh.
template <int dim>
class Carrier
{
 public:
  Carrier(const Method& method, std::shared_ptr<const Grid<dim>> grid)
      : method_(method), grid_(std::move(grid))
  {
  }

  /// Appends the functions that carry() takes, in their order.
  static void append(const Position<dim>& position, std::vector<std::span<const double>>& functions)
  {
    if (!position.last) return;
    functions.emplace_back(position.last->level.u);
    if (!position.before_last.u.empty()) functions.emplace_back(position.before_last.u);
  }

  /// `functions`: those on the finer mesh; carry() consumes the first ones.
  [[nodiscard]] Position<dim> carry(const Position<dim>& position,
                                    std::span<std::vector<double>>& functions) const
  {
    Position<dim> carried = position;
    if (!position.last) return carried;
    const auto take = [&]
    {
      std::vector<double> u = std::move(functions.front());
      functions = functions.subspan(1);
      return u;
    };
    carried.last = carried_step(*position.last, take());
    if (!position.before_last.u.empty()) carried.before_last.u = take();
    carried.history = carried_history<dim>(*position.history, position.last->at->discrete.form,
                                           carried.last->at->discrete.form);
    return carried;
  }

 private:
  /// What the path and a further carry() need of an earlier step: t, displacement, history before it,
  /// tractions and forces.
  [[nodiscard]] std::shared_ptr<const LoadStep<dim>> carried_step(const LoadStep<dim>& step,
                                                                  std::vector<double>&& u) const
  {
    const contact::NitscheForm<dim>& from = step.at->discrete.form;
    auto at = std::make_shared<DiscreteAtTime<dim>>(step.at->problem, step.t, grid_, method_, nullptr);
    contact::NitscheForm<dim>& form = at->discrete.form;
    if (from.history()) form.set_history(carried_history<dim>(*from.history(), from, form));
    auto carried = std::make_shared<LoadStep<dim>>();
    carried->number = step.number;
    carried->t = step.t;
    carried->control = step.control;
    carried->crack_tips = step.crack_tips;
    carried->verdict = step.verdict;
    carried->largest_sigma = step.largest_sigma;
    carried->level.friedrichs = step.level.friedrichs;
    carried->level.norms = step.level.norms;
    carried->level.u = std::move(u);
    set_forces(step, form, *carried);
    carried->at = std::move(at);
    return carried;
  }

  /// Sets tractions, and LoadStep::forces for displacements of the finer space. a(u, phi_i) is exact, and so
  /// is (t + p_w n, phi_i)_C in 2D. On functions outside the coarser space, the forces are out of balance by
  /// the residual of the step.
  static void set_forces(const LoadStep<dim>& step, const contact::NitscheForm<dim>& form,
                         LoadStep<dim>& carried)
  {
    const contact::NitscheForm<dim>& from = step.at->discrete.form;
    std::vector<Point<dim>> traction = from.water_pressure();
    for (std::size_t i = 0; i < traction.size(); ++i) traction[i] += step.level.traction[i];
    traction = carried_vectors<dim>(traction, from, form);
    const std::vector<double>& u = carried.level.u;
    std::vector<double> contact_load(u.size(), 0.0);
    form.add_contact_load(traction, contact_load);
    carried.forces = forces_on<dim>(form, u, contact_load);
    const std::vector<Point<dim>> water = form.water_pressure();
    for (std::size_t i = 0; i < water.size(); ++i) traction[i] -= water[i];
    carried.level.traction = std::move(traction);
  }

  const Method& method_;
  std::shared_ptr<const Grid<dim>> grid_;
};

template <int dim>
class Transfer
{
 public:
  Transfer(LoadPath<dim>& path, const Strategy<dim>& strategy, const ReplayObserver<dim>& observer,
           const ReplayState<dim>* from)
      : path_(path), strategy_(strategy), observer_(observer), state_(from ? *from : ReplayState<dim>())
  {
    if (from) state_.recall(path);
    before_ = path.position();
  }

  certify::Verdict run(const PathProgram& program)
  {
    if (observer_.begins) observer_.begins(state_.pass, path_.grid());
    const PathEnd end = follow(program);
    if (observer_.path_end) observer_.path_end(end);
    if (!end.failure.empty()) return {certify::RunStatus::failed, end.failure};
    certify::Verdict& verdict = state_.verdict;
    if (verdict.status == certify::RunStatus::budget && !end_.empty()) verdict.reason += "; " + end_;
    if (observer_.complete) observer_.complete(view());
    return verdict;
  }

 private:
  [[nodiscard]] PathEnd follow(const PathProgram& program)
  {
    try
    {
      return adapt::follow<dim>(
          path_, program, [this](const LoadStep<dim>& step) { tell(step); }, observer_.newton,
          state_.progress, [this](std::span<Position<dim>> kept) { committed(kept); });
    }
    catch (const std::bad_alloc&)
    {
      require_all_failed(path_.grid().mesh.ranks(), out_of_memory);
      return {.failure = out_of_memory};
    }
  }

  void tell(const LoadStep<dim>& step)
  {
    if (observer_.step) observer_.step(step);
    if (!observer_.state) return;
    state_.note(path_);
    state_.cells.assign(path_.grid().mesh.n_owned_cells(), {});  // no other pass marks by them
    observer_.state(state_);
  }

  [[nodiscard]] PassView<dim> view() const
  {
    return {state_.pass, state_.worst_step, state_.worst, state_.verdict, worst_.get()};
  }

  /// Records the last step as one on the current mesh.
  void compare()
  {
    const std::shared_ptr<const LoadStep<dim>>& step = path_.last();
    if (state_.note_worst(*step)) worst_ = step;
  }

  void committed(std::span<Position<dim>> kept)
  {
    compare();
    while (end_.empty() && path_.last()->verdict.status == certify::RunStatus::budget)
      if (std::string why = solve_on_finer(kept); !why.empty())
      {
        if (end_.empty())
          state_.progress.end.notes.push_back(
              fmt::format("load step {} at t = {:.9g} stays on the coarser mesh: {}", path_.last()->number,
                          path_.last()->t, why));
        break;
      }
    before_ = path_.position();
    state_.note_verdict(*path_.last());
  }

  /// Returns why the last step stays as it is, like everything else; empty on success.
  [[nodiscard]] std::string solve_on_finer(std::span<Position<dim>> kept)
  {
    const std::shared_ptr<const LoadStep<dim>> step = path_.last();
    const LevelView<dim> level{state_.pass, step->at->discrete, step->level, step->verdict,
                               0,           step->discrete()};
    if (strategy_.stop) end_ = strategy_.stop(level);
    if (!end_.empty()) return end_;
    const Position<dim> here = path_.position();
    std::string why;
    try
    {
      why = try_on_finer(level, *step, kept);
    }
    catch (const std::bad_alloc&)
    {
      require_all_failed(path_.grid().mesh.ranks(), out_of_memory);
      why = end_ = out_of_memory;
    }
    if (!why.empty()) path_.go_back(here);
    return why;
  }

  [[nodiscard]] std::string try_on_finer(const LevelView<dim>& level, const LoadStep<dim>& step,
                                         std::span<Position<dim>> kept)
  {
    std::vector<std::span<const double>> functions = {step.level.u};
    Carrier<dim>::append(before_, functions);
    for (const Position<dim>& position : kept) Carrier<dim>::append(position, functions);
    const Finer<dim> finer = finer_mesh<dim>(level.discrete.space, functions, strategy_.mark(level),
                                             {.twins = level.discrete.twins()});
    std::shared_ptr<const Grid<dim>> grid;
    if (end_ = limit(finer, level.discrete.space, step.at->problem, grid); !end_.empty()) return end_;
    std::vector<std::vector<double>> carried = finer.carry(grid->space);

    const Carrier<dim> carrier(path_.method(), grid);
    std::span<std::vector<double>> rest = std::span(carried).subspan(1);
    Position<dim> before = carrier.carry(before_, rest);
    std::vector<Position<dim>> kept_there;
    for (const Position<dim>& position : kept) kept_there.push_back(carrier.carry(position, rest));

    path_.go_back(before, grid);
    if (std::string why = path_.repeat(step, carried.front(), observer_.newton); !why.empty()) return why;
    if (const certify::Verdict& there = path_.last()->verdict; !certify::is_bound(there.status))
      return there.reason;
    if (observer_.finer) observer_.finer(view(), *grid);
    ++state_.pass;
    state_.worst_step = 0;
    compare();
    before_ = std::move(before);
    std::ranges::move(kept_there, kept.begin());
    return {};
  }

  /// Makes the grid, unless it exceeds a limit; then says which.
  [[nodiscard]] std::string limit(const Finer<dim>& finer, const fem::LagrangeSpace<dim>& space,
                                  const problem::Problem<dim>& problem,
                                  std::shared_ptr<const Grid<dim>>& grid) const
  {
    NextMesh next{.cells = finer.n_cells, .ranks = space.mesh().ranks()};
    if (strategy_.limit)
      if (std::string why = strategy_.limit(next); !why.empty()) return why;
    grid = std::make_shared<const Grid<dim>>(contact::with_partners<dim>(finer.mesh(), problem.pairs()),
                                             space.degree());
    next.dofs = grid->space.n_global_dofs();
    next.growth = static_cast<double>(*next.dofs) / static_cast<double>(space.n_global_dofs());
    return strategy_.limit ? strategy_.limit(next) : std::string();
  }

  static constexpr const char* out_of_memory = "out of memory";

  LoadPath<dim>& path_;
  const Strategy<dim>& strategy_;
  const ReplayObserver<dim>& observer_;
  Position<dim> before_;                        ///< the last step
  std::string end_;                             ///< why no further mesh will be refined
  ReplayState<dim> state_;                      ///< `pass` is the number of the mesh, `worst` the step there
  std::shared_ptr<const LoadStep<dim>> worst_;  ///< that step, unless it was before a restart
};

}  // namespace

template <int dim>
void check_transfer(const problem::Problem<dim>& problem, const Where& where)
{
  if (dim == 3 && !problem.pairs().empty())
    throw InputError(
        where, "transfers the contact history to finer meshes; this is not available between bodies in 3D",
        "refine = \"replay\": the path is followed again on each mesh");
}

template <int dim>
certify::Verdict transfer(LoadPath<dim>& path, const PathProgram& program, const Strategy<dim>& strategy,
                          const ReplayObserver<dim>& observer, const ReplayState<dim>* from)
{
  check_transfer<dim>(path.problem());
  return Transfer<dim>(path, strategy, observer, from).run(program);
}

template void check_transfer(const problem::Problem<2>&, const Where&);
template void check_transfer(const problem::Problem<3>&, const Where&);
template certify::Verdict transfer(LoadPath<2>&, const PathProgram&, const Strategy<2>&,
                                   const ReplayObserver<2>&, const ReplayState<2>*);
template certify::Verdict transfer(LoadPath<3>&, const PathProgram&, const Strategy<3>&,
                                   const ReplayObserver<3>&, const ReplayState<3>*);

}  // namespace tribound::adapt
