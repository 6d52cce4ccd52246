#pragma once

/// @file judgement_page.h
/// judgement.html: the solution of another program beside ours, and how wrong it is.

#include <filesystem>
#include <span>

#include "app/page/page_template.h"
#include "tribound/certify/truth/judgement.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

struct JudgementRecord;  // of app/result/judgement.h

/// Their solution and u on the surface of their mesh, with what was found of its cells. `form`: on their
/// space, from whose mesh that of `space` comes by bisect().
template <int dim>
[[nodiscard]] io::Json judged_surfaces(const contact::NitscheForm<dim>& form,
                                       const certify::ForeignSolution<dim>& theirs,
                                       const certify::Judgement& judgement,
                                       const fem::LagrangeSpace<dim>& space, std::span<const double> u);

/// Writes judgement.html into the directory, with links to the results there. `surfaces`: of
/// judged_surfaces(), null where there is no bound. Of several load steps the page has a table, and all of
/// the worst. Throws WriteError when the file cannot be written.
void write_judgement_page(const PageTemplate& page, const std::filesystem::path& directory,
                          std::span<const JudgementRecord> steps, const io::Json& surfaces);

}  // namespace tribound::app
