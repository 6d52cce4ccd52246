#include "tribound/mesh/import/read_apart.h"

#include <fmt/format.h>

#include <exception>
#include <string_view>
#include <utility>

#include "tribound/base/apart.h"
#include "tribound/mesh/gmsh_session.h"
#include "tribound/mesh/import/imported_bytes.h"

namespace tribound::mesh
{

std::string read_apart(const std::filesystem::path& file, const std::string& library,
                       const std::function<std::string()>& read)
{
  const Where where{.file = file.string()};
  const auto failure = [&](std::string_view what)
  {
    return InputError(where, fmt::format("{} cannot read the file: {}", library, what),
                      "the file is damaged or cut off: save the mesh again");
  };
  const auto work = [&]
  {
    try
    {
      const ReadingLimits most = reading_limits(file);
      limit_from_here(most.memory, most.seconds);
      return read();
    }
    catch (const InputError& error)
    {
      return bytes_of(error);
    }
    catch (const std::exception& error)
    {
      return bytes_of(failure(error.what()));
    }
  };
  ApartOutcome outcome = run_apart(work);
  if (outcome.end == ApartEnd::out_of_time || outcome.end == ApartEnd::silent)
    throw failure("it takes too long for a sound file of this size");
  if (outcome.end != ApartEnd::complete) throw failure("it " + describe_end(outcome.status));
  return std::move(outcome.result);
}

}  // namespace tribound::mesh
