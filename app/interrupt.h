#pragma once

/// @file interrupt.h
/// Ctrl-C ends a run in order.

#include <atomic>

namespace tribound
{

/// From now on SIGINT and SIGTERM set the flag that is returned: the run then ends with the certificate of
/// its last complete level. A second signal ends the program at once.
[[nodiscard]] const std::atomic<bool>& stop_on_signals();

}  // namespace tribound
