#pragma once

/// @file memory.h
/// Memory of this process and of the machine, in bytes.

#include <filesystem>

namespace tribound
{

/// The most that this process has had resident so far; 0 where the system does not tell.
[[nodiscard]] double peak_memory();

/// What the machine has; 0 where the system does not tell.
[[nodiscard]] double physical_memory();

/// What the control groups of a process allow, the smallest limit of each and of those it lies in; infinity
/// where there is none. `groups`: as /proc/self/cgroup; `root`: where the groups lie, as /sys/fs/cgroup.
/// Versions 1 and 2 of control groups.
[[nodiscard]] double control_group_memory(const std::filesystem::path& groups,
                                          const std::filesystem::path& root);

/// What `ulimit -v` allows this process; infinity where it is not limited.
[[nodiscard]] double address_space_limit();

/// physical_memory(), or the control groups or `ulimit -v` of this process where they allow less; 0 where the
/// system does not tell.
[[nodiscard]] double machine_memory();

}  // namespace tribound
