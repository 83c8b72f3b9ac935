/// What rows of structured numpy arrays are filled and named with.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>

namespace plumb_python {

namespace py = pybind11;

/// A word as its place in the tuple of names.
template <class Enum>
std::uint8_t number(Enum e) {
  return static_cast<std::uint8_t>(e);
}

template <class T, std::size_t N, class From>
void copy_to(T (&to)[N], const From& from) {
  for (std::size_t k = 0; k < N; ++k) to[k] = static_cast<T>(from[k]);
}

/// The names of an enumeration, in its order.
template <class Enum>
py::tuple names(Enum last) {
  py::tuple out(static_cast<std::size_t>(last) + 1);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = py::str(to_string(static_cast<Enum>(k)));
  return out;
}

/// Of bits, from the lowest up.
template <std::size_t N>
py::tuple names(const std::array<const char*, N>& of) {
  py::tuple out(N);
  for (std::size_t k = 0; k < N; ++k) out[k] = py::str(of[k]);
  return out;
}

}  // namespace plumb_python
