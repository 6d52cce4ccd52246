#include "tribound/io/fields/contact_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/csv.h"

namespace tribound::io
{

namespace
{

/// A facet of a chain; reversed: opposite to its reference coordinate.
struct FacetLink
{
  std::size_t facet;  ///< index in Mesh::boundary()
  bool reversed;
};
using Chain = std::vector<FacetLink>;

/// The facets of one boundary group in 2D and how they are connected.
class FacetGraph
{
 public:
  FacetGraph(const mesh::Mesh<2>& mesh, int tag) : mesh_(mesh), visited_(mesh.boundary().size(), 0)
  {
    for (std::size_t k = 0; k < visited_.size(); ++k)
      if (mesh.boundary()[k].tag == tag)
        for (const Index v : ends(k)) facets_at_[v].push_back(k);
  }

  /// All chains. Those with ends are found first, so the remaining ones are closed.
  [[nodiscard]] std::vector<Chain> chains()
  {
    std::vector<Index> vertices;
    for (const auto& [vertex, facets] : facets_at_) vertices.push_back(vertex);
    std::ranges::sort(vertices, {}, [this](Index v) { return position(v); });

    std::vector<Chain> chains;
    for (const bool closed : {false, true})
      for (const Index v : vertices)
      {
        const std::vector<std::size_t>& facets = facets_at_.at(v);
        if (!visited_[facets.front()] && (closed || facets.size() == 1)) chains.push_back(follow(v));
      }
    std::ranges::sort(chains, {}, [this](const Chain& chain) { return position(first_vertex(chain[0])); });
    return chains;
  }

 private:
  /// The vertices of a facet along its reference coordinate.
  [[nodiscard]] std::array<Index, 2> ends(std::size_t facet) const
  {
    const mesh::BoundaryFacet& f = mesh_.boundary()[facet];
    const mesh::Cell<2>& cell = mesh_.cell(f.cell);
    return {cell[f.local == 0 ? 1 : 0], cell[f.local == 2 ? 1 : 2]};
  }

  [[nodiscard]] std::pair<double, double> position(Index vertex) const
  {
    const Point<2>& x = mesh_.vertex(vertex);
    return {x[0], x[1]};
  }

  [[nodiscard]] Index first_vertex(const FacetLink& link) const
  {
    return ends(link.facet)[link.reversed ? 1 : 0];
  }

  /// The chain from a vertex through facets not yet visited.
  Chain follow(Index vertex)
  {
    Chain chain;
    for (;;)
    {
      const std::vector<std::size_t>& facets = facets_at_.at(vertex);
      const auto next = std::ranges::find_if(facets, [this](std::size_t k) { return !visited_[k]; });
      if (next == facets.end()) return chain;
      visited_[*next] = 1;
      const std::array<Index, 2> v = ends(*next);
      const bool reversed = v[0] != vertex;
      chain.push_back({*next, reversed});
      vertex = reversed ? v[0] : v[1];
    }
  }

  const mesh::Mesh<2>& mesh_;
  std::vector<char> visited_;
  std::map<Index, std::vector<std::size_t>> facets_at_;
};

/// The position of a segment on its slave facet, in reference coordinates.
std::array<double, 2> extent(const contact::ContactSegment<2>& segment)
{
  return {segment.slave.on_facet(Point<1>(0.0))[0], segment.slave.on_facet(Point<1>(1.0))[0]};
}

template <int dim>
std::string columns(bool has_memory)
{
  std::string names =
      dim == 2 ? "boundary,facet,x,y,nx,ny,arc,pressure,traction_x,traction_y,limit,status,gap,slip_x,slip_y,"
                 "weight,level,pair"
               : "boundary,facet,x,y,z,nx,ny,nz,pressure,traction_x,traction_y,traction_z,limit,status,gap,"
                 "slip_x,slip_y,slip_z,weight,level,pair";
  if (has_memory)
    names += dim == 2 ? ",damage,opening,plastic_slip_x,plastic_slip_y,water_pressure,effective_traction_x,"
                        "effective_traction_y"
                      : ",damage,opening,plastic_slip_x,plastic_slip_y,plastic_slip_z,water_pressure,"
                        "effective_traction_x,effective_traction_y,effective_traction_z";
  return names;
}

template <int dim>
void add_point(CsvTable& table, const Point<dim>& x, double round_off = 0)
{
  for (const double component : x) table.add(std::abs(component) > round_off ? component : 0.0);
}

/// The data common to all rows.
template <int dim>
struct Rows
{
  Rows(const contact::NitscheForm<dim>& f, std::span<const double> displacement, const SeriesPlace& at)
      : form(f), u(displacement), place(at)
  {
    double size = 0;
    for (const Point<dim>& x : f.space().mesh().vertices()) size = std::max(size, x.cwiseAbs().maxCoeff());
    round_off = relative_round_off * size;
  }

  /// `arc` is absent in 3D.
  void add(CsvTable& table, int segment, int q, const contact::ContactState<dim>& state,
           const double* arc) const
  {
    table.add(form.problem().boundary(form.segments()[segment].slave.facet.tag).name);
    table.add(segment);
    add_point<dim>(table, state.point, round_off);
    add_point<dim>(table, state.normal, relative_round_off);
    if (arc) table.add(*arc);
    table.add(state.pressure);
    add_point<dim>(table, state.traction);
    table.add(state.limit);
    table.add(static_cast<int>(state.status));
    table.add(state.gap);
    add_point<dim>(table, state.slip);
    table.add(form.contact_points(segment)[q].weight);
    table.add(place.number);
    const int pair = form.segments()[segment].pair;
    table.add(pair < 0 ? std::string() : std::to_string(pair));
    if (place.load_factor)
    {
      table.add(state.state.damage);
      table.add(state.opening);
      add_point<dim>(table, state.state.slip);
      table.add(state.water);
      add_point<dim>(table, state.traction + state.water * state.normal);
    }
    table.end_row();
  }

  static constexpr double relative_round_off = 1e-14;
  const contact::NitscheForm<dim>& form;
  std::span<const double> u;
  SeriesPlace place;
  double round_off = 0;  ///< of coordinates
};

void add_chains(CsvTable& table, const Rows<2>& rows, int tag)
{
  const fem::Quadrature<1>& rule = rows.form.facet_rule();
  std::vector<int> along(rule.size());
  for (int q = 0; q < rule.size(); ++q) along[q] = q;
  std::ranges::sort(along, {}, [&rule](int q) { return rule.points[q][0]; });

  for (const ChainLink& link : contact_chains(rows.form, tag))
  {
    const double length = rows.form.segments()[link.segment].measure;
    const auto states = rows.form.contact_states(rows.u, link.segment);
    for (std::size_t i = 0; i < along.size(); ++i)
    {
      const int q = along[link.reversed ? along.size() - 1 - i : i];
      const double s = rule.points[q][0];
      const double arc = link.arc + length * (link.reversed ? 1.0 - s : s);
      rows.add(table, link.segment, q, states[q], &arc);
    }
  }
}

void add_facets(CsvTable& table, const Rows<3>& rows, int tag)
{
  const auto segments = rows.form.segments();
  for (int k = 0; k < static_cast<int>(segments.size()); ++k)
  {
    if (segments[k].slave.facet.tag != tag) continue;
    const auto states = rows.form.contact_states(rows.u, k);
    for (int q = 0; q < static_cast<int>(states.size()); ++q) rows.add(table, k, q, states[q], nullptr);
  }
}

}  // namespace

std::vector<ChainLink> contact_chains(const contact::NitscheForm<2>& form, int tag)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  std::map<std::size_t, std::vector<int>> segments_of;
  for (int k = 0; k < static_cast<int>(form.segments().size()); ++k)
    if (form.segments()[k].slave.facet.tag == tag) segments_of[form.segments()[k].slave.number].push_back(k);
  std::vector<ChainLink> links;
  if (segments_of.empty()) return links;
  double arc = 0.0;
  for (const Chain& chain : FacetGraph(mesh, tag).chains())
    for (const FacetLink& facet : chain)
    {
      const double length = contact::simplex_map(mesh, mesh.boundary()[facet.facet]).measure;
      const auto first = links.size();
      for (const int k : segments_of[facet.facet])
      {
        const auto [from, to] = extent(form.segments()[k]);
        const double before = facet.reversed ? 1 - std::max(from, to) : std::min(from, to);
        links.push_back({k, facet.reversed != (to < from), arc + length * before});
      }
      std::ranges::sort(links.begin() + static_cast<std::ptrdiff_t>(first), links.end(), {}, &ChainLink::arc);
      arc += length;
    }
  return links;
}

template <int dim>
std::string contact_csv(const contact::NitscheForm<dim>& form, std::span<const double> u,
                        const SeriesPlace& place)
{
  CsvTable table(columns<dim>(place.load_factor.has_value()));
  const Rows<dim> rows(form, u, place);
  const int n_boundaries = static_cast<int>(form.problem().boundaries().size());
  for (int tag = 0; tag < n_boundaries; ++tag)
  {
    if constexpr (dim == 2)
      add_chains(table, rows, tag);
    else
      add_facets(table, rows, tag);
  }
  return table.text();
}

template <int dim>
void write_contact_csv(const std::filesystem::path& path, const contact::NitscheForm<dim>& form,
                       std::span<const double> u, const SeriesPlace& place)
{
  write_file(path, contact_csv(form, u, place));
}

template std::string contact_csv(const contact::NitscheForm<2>&, std::span<const double>, const SeriesPlace&);
template std::string contact_csv(const contact::NitscheForm<3>&, std::span<const double>, const SeriesPlace&);
template void write_contact_csv(const std::filesystem::path&, const contact::NitscheForm<2>&,
                                std::span<const double>, const SeriesPlace&);
template void write_contact_csv(const std::filesystem::path&, const contact::NitscheForm<3>&,
                                std::span<const double>, const SeriesPlace&);

}  // namespace tribound::io
