#pragma once

/// @file dimensions.h
/// What typed tests run over, as TypeParam::value.

#include <gtest/gtest.h>

#include <type_traits>

namespace tribound::test
{

/// Of bodies.
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

/// Those of facets, too.
using AllDimensions = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
                                       std::integral_constant<int, 3>>;

}  // namespace tribound::test
