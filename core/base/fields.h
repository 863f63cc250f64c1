// Names every number of a struct once: a visitor is called with (name, leaf) for each number, field by field
// and never over padding (sources/choices 8). Each composite struct has its own fields() beside it.
#pragma once

#include <array>
#include <string_view>

#include "core/base/frames.h"

namespace enc {

template <class F, class T, std::size_t N>
void fields(F& f, std::string_view name, std::array<T, N>& a) {
  for (T& x : a) f(name, x);
}
template <class F>
void fields(F& f, std::string_view name, detail::Triple& v) {
  fields(f, name, v.xyz);
}
template <class F, char A, char B>
void fields(F& f, std::string_view name, Pose<A, B>& X) {
  fields(f, name, X.xyzw);
  fields(f, name, X.xyz);
}

}  // namespace enc
