#include "app/page/page_template.h"

#include <algorithm>

#include "tribound/certify/bound/components.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

std::string script_safe(std::string_view json)
{
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

PageTemplate::PageTemplate(const std::filesystem::path& path)
{
  text_ = io::read_text(path);
  marker_ = text_.find(page_data_marker);
}

void PageTemplate::write(const std::filesystem::path& page, std::string_view id, const io::Json& data) const
{
  if (empty()) return;
  io::AtomicFile file(page);
  const std::string_view text = text_;
  file.write(text.substr(0, marker_));
  file.write(R"(<script type="application/json" id=")");
  file.write(id);
  file.write(R"(">)");
  file.write(script_safe(io::json_text(data, -1)));
  file.write("</script>");
  file.write(text.substr(marker_ + page_data_marker.size()));
  file.commit();
}

io::Json components_json(const certify::RunKind& kind)
{
  io::Json components = io::Json::array();
  for (const certify::Component& c : certify::components_of_run(kind))
    components.push_back({{"name", c.name},
                          {"meaning", c.meaning},
                          {"part", certify::to_string(c.part)},
                          {"cause", certify::to_string(c.cause)}});
  return components;
}

io::Json files_json(const std::filesystem::path& directory, std::span<const std::string> names)
{
  io::Json existing = io::Json::array();
  for (const std::string& name : names)
    if (std::filesystem::exists(directory / name)) existing.push_back(name);
  return existing;
}

}  // namespace tribound::app
