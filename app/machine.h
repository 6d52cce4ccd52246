#pragma once

/// @file machine.h
/// The computer a result was made on.

#include <string>

namespace tribound::app
{

/// What could not be found out is empty or 0.
struct MachineFacts
{
  std::string processor;  ///< model name
  int n_processors = 0;   ///< logical ones, online
  double memory = 0.0;    ///< bytes
  std::string system;     ///< such as "Linux 6.1.0, x86_64"
};

/// Found out once per process.
[[nodiscard]] MachineFacts machine_facts();

/// Now, as in "2024-05-17 09:30 UTC".
[[nodiscard]] std::string date_and_time();

}  // namespace tribound::app
