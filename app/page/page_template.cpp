#include "app/page/page_template.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "app/machine.h"
#include "tribound/certify/bound/components.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

std::string script_safe(std::string_view json)
{
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

PageTemplate::PageTemplate(const std::filesystem::path& path)
{
  const std::string text = read_text(path);
  const std::size_t marker = text.find(page_data_marker);
  if (marker == std::string::npos) return;
  head_ = text.substr(0, marker);
  tail_ = text.substr(marker + page_data_marker.size());
}

void PageTemplate::write(const std::filesystem::path& page, std::string_view id, const io::Json& data) const
{
  if (empty()) return;
  io::AtomicFile file(page);
  file.write(head_);
  file.write(R"(<script type="application/json" id=")");
  file.write(id);
  file.write(R"(">)");
  file.write(script_safe(io::json_text(data, -1)));
  file.write("</script>");
  file.write(tail_);
  file.commit();
}

std::string read_text(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

io::Json machine_json()
{
  const MachineFacts machine = machine_facts();
  return {{"processor", machine.processor},
          {"processors", machine.n_processors},
          {"memory", machine.memory},
          {"system", machine.system},
          {"written", date_and_time()}};
}

io::Json components_json(bool regularised)
{
  io::Json components = io::Json::array();
  for (const certify::Component& c : certify::components_of_run(regularised))
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
