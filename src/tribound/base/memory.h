#pragma once

/// @file memory.h
/// Memory of this process and of the machine, in bytes.

#include <filesystem>

namespace tribound
{

/// Peak resident memory of this process so far; 0 where the system does not tell.
[[nodiscard]] double peak_memory();

/// Memory of the machine; 0 where the system does not tell.
[[nodiscard]] double physical_memory();

/// The memory that the control groups of a process allow: the smallest limit of its groups and of those that
/// contain them; infinity where there is none. `groups`: a file such as /proc/self/cgroup; `root`: the folder
/// of the groups, such as /sys/fs/cgroup. Versions 1 and 2 of control groups.
[[nodiscard]] double control_group_memory(const std::filesystem::path& groups,
                                          const std::filesystem::path& root);

/// What `ulimit -v` allows this process; infinity where it is not limited.
[[nodiscard]] double address_space_limit();

/// physical_memory(), or what the control groups or `ulimit -v` allow this process if that is less; 0 where
/// the system does not tell.
[[nodiscard]] double machine_memory();

}  // namespace tribound
