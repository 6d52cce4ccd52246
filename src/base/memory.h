#pragma once

/// @file memory.h
/// Memory of this process and of the machine, in bytes.

namespace tribound
{

/// The most that this process has had resident so far; 0 where the system does not tell.
[[nodiscard]] double peak_memory();

/// What the machine has; 0 where the system does not tell.
[[nodiscard]] double physical_memory();

/// The same, or the control group of the process where that allows less; 0 where the system does
/// not tell.
[[nodiscard]] double machine_memory();

}  // namespace tribound
