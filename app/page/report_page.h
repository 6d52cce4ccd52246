#pragma once

/// @file report_page.h
/// report.html of a run, a study or a sweep: their data, put into the template of app/page/page_template.h.

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "app/page/page_template.h"
#include "tribound/adapt/level.h"
#include "tribound/io/record/report.h"

namespace tribound::app
{

struct Study;        // of app/result/study.h
struct SweepRecord;  // of app/result/sweep.h
struct PageLevel;    // of app/page/page_level.h

/// The comment in the template, and in a page without true errors, that add_true_errors() replaces.
inline constexpr std::string_view true_errors_marker = "<!-- true errors -->";

/// The errors on a level known from a study.
struct TrueErrors
{
  int level = 0;
  std::optional<double> stress_error;  ///< ||sigma(u_ref - u_h)||
  std::optional<double> dual_norm;     ///< of the residual, from below
};

/// Adds the true errors to an existing page; does nothing where there is none. Throws WriteError when it
/// cannot be written.
void add_true_errors(const std::filesystem::path& page, std::span<const TrueErrors> errors);

/// The page of a run: level by level.
class ReportPage
{
 public:
  /// `page_template`: built from report/; if it is missing, nothing is collected or written.
  explicit ReportPage(const std::filesystem::path& page_template);
  ~ReportPage();
  ReportPage(ReportPage&&) noexcept;
  ReportPage& operator=(ReportPage&&) noexcept;

  /// A level that is not the last, in less detail; omitted where it and the previous ones exceed
  /// PageLimits::earlier.
  template <int dim>
  void add(int number, const contact::NitscheForm<dim>& form, const adapt::CertifiedLevel<dim>& level);
  /// The last level, with the interior of the body; to be called before write(). Replaces a level with the
  /// same number.
  template <int dim>
  void add_last(int number, const contact::NitscheForm<dim>& form, const adapt::CertifiedLevel<dim>& level);

  /// Writes report.html into the directory, with links to the existing results. Throws WriteError when the
  /// file cannot be written.
  void write(const std::filesystem::path& directory, const io::RunRecord& run) const;

 private:
  PageTemplate template_;
  std::vector<PageLevel> levels_;
};

/// Writes report.html of a study into the directory, with links to the existing tables, figures and pages of
/// the variants. Does nothing without a template. Throws WriteError when the file cannot be written.
void write_study_page(const std::filesystem::path& page_template, const std::filesystem::path& directory,
                      const Study& study);

/// sweep.csv and sweep.json, and with a template report.html of a sweep, with links to its tables and the
/// pages of its runs. Throws WriteError when a file cannot be written.
void write_sweep_results(const PageTemplate& page, const std::filesystem::path& directory,
                         const SweepRecord& sweep);

}  // namespace tribound::app
