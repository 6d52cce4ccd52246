#pragma once

/// @file interrupt.h
/// Signals: Ctrl-C ends a run in order, a closed pipe does not, a crash ends it with a message.

#include <atomic>

namespace tribound::app
{

/// To be called first of all: writing to a pipe that nobody reads is no reason to end, children can be waited
/// for whatever the parent ignores, and a crash, be it of a library, ends the program with a message and exit
/// code 2.
void prepare_signals();

/// From now on SIGINT and SIGTERM set the flag that is returned: the run then ends with the certificate of
/// its last complete level. A second signal ends the program at once.
[[nodiscard]] const std::atomic<bool>& stop_on_signals();

}  // namespace tribound::app
