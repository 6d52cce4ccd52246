#pragma once

/// @file page_template.h
/// report.html as built from report/: a page that opens without a network, with a place for data.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "tribound/certify/bound/components.h"
#include "tribound/io/file/json_forward.h"

namespace tribound::app
{

/// The comment in the template that is replaced by the data.
inline constexpr std::string_view page_data_marker = "<!-- data of the page -->";

/// JSON that is safe in a script element whatever the user's strings contain: every `<` becomes `\u003c`, so
/// none of them ends the element or starts a comment.
[[nodiscard]] std::string script_safe(std::string_view json);

class PageTemplate
{
 public:
  PageTemplate() = default;  ///< empty
  /// Empty where there is no such file, or no place for data in it.
  explicit PageTemplate(const std::filesystem::path& path);

  [[nodiscard]] bool empty() const { return marker_ == std::string::npos; }

  /// Writes the page with the data in a script element with this id. Does nothing where the template is
  /// empty. Throws WriteError when the file cannot be written.
  void write(const std::filesystem::path& page, std::string_view id, const io::Json& data) const;

 private:
  std::string text_;
  std::size_t marker_ = std::string::npos;  ///< its position in the text; npos if there is none
};

/// This computer, and the time; unknown values are empty or 0.
[[nodiscard]] io::Json machine_json();

/// Descriptions of the components of the bound that a run has.
[[nodiscard]] io::Json components_json(const certify::RunKind& kind);

/// The files that exist in the directory, in this order.
[[nodiscard]] io::Json files_json(const std::filesystem::path& directory, std::span<const std::string> names);

}  // namespace tribound::app
