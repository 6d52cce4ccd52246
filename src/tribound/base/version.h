#pragma once

/// @file version.h
/// What this build is.

namespace tribound
{

/// The version of Tribound, "major.minor.patch".
[[nodiscard]] const char* version();

/// The compiler and the build type, such as "GNU 12.2.0, Release".
[[nodiscard]] const char* compiler();

}  // namespace tribound
