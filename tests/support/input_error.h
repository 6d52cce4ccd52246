#pragma once

/// @file input_error.h
/// What a user is told about bad input.

#include <string>

#include "tribound/base/error.h"

namespace tribound::test
{

/// The text of the InputError that `action` throws, or empty.
template <class Action>
[[nodiscard]] std::string message_of(const Action& action)
{
  try
  {
    (void)action();
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return {};
}

}  // namespace tribound::test
