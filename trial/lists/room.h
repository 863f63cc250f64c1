// Lists that grow while the loop runs have their room beforehand: a tick asks the heap for nothing.
#pragma once

#include <cstddef>
#include <vector>

namespace enc::trial {

// Of what a run lists for each contact or press: more than twenty minutes of them. A list of hours takes
// twice its room each time that it is full, as ever.
inline constexpr std::size_t kRoom = 256;

// Empty. All of its room has been written to: memory that nobody has touched is not there before a page
// fault.
template <class T>
[[nodiscard]] std::vector<T> with_room(std::size_t n = kRoom) {
  std::vector<T> list(n);
  list.clear();
  return list;
}

}  // namespace enc::trial
