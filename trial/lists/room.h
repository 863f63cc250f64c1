// Lists that grow while the loop runs reserve their memory beforehand, so that a tick never allocates.
#pragma once

#include <cstddef>
#include <vector>

namespace enc::trial {

// Capacity of a list of contacts or presses: more than twenty minutes of them. A longer list doubles each
// time that it is full, as usual.
inline constexpr std::size_t kRoom = 256;

// Returns an empty list whose memory has been written once: untouched memory would cause a page fault.
template <class T>
[[nodiscard]] std::vector<T> with_room(std::size_t n = kRoom) {
  std::vector<T> list(n);
  list.clear();
  return list;
}

}  // namespace enc::trial
