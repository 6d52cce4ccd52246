#pragma once

/// @file arrays.h
/// Arrays of C++ as arrays of NumPy that cannot be written to.

#include <pybind11/numpy.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace tribound::python
{

using Shape = std::vector<pybind11::ssize_t>;

/// A view; `owner` keeps what it shows.
template <class T>
[[nodiscard]] pybind11::array_t<T> view(const T* data, Shape shape, const pybind11::object& owner)
{
  pybind11::array_t<T> array(std::move(shape), data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// An array that takes the entries over.
template <class T>
[[nodiscard]] pybind11::array_t<T> owned(std::vector<T> entries, Shape shape)
{
  auto* kept = new std::vector<T>(std::move(entries));
  const pybind11::capsule owner(kept, [](void* data) { delete static_cast<std::vector<T>*>(data); });
  return view(kept->data(), std::move(shape), owner);
}

/// Points in a row as numbers.
template <class Points>
[[nodiscard]] std::vector<double> flat(const Points& points)
{
  std::vector<double> numbers;
  for (const auto& point : points) numbers.insert(numbers.end(), point.begin(), point.end());
  return numbers;
}

}  // namespace tribound::python
