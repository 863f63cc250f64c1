#include <string_view>
#include <type_traits>
#include <variant>

#include "core/record/frame.h"

namespace enc {
namespace {

struct LayoutHash {
  std::uint64_t value = 0xcbf29ce484222325ULL;  // FNV-1a
  std::size_t leaves = 0;
  void add(char c) { value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL; }
  template <class T>
  void operator()(std::string_view name, T&) {
    for (const char c : name) add(c);
    add('\0');
    // Kind and size: an int that becomes a double, or grows, is another layout.
    add(std::is_floating_point_v<T> ? 'f'
        : std::is_enum_v<T>         ? 'e'
        : std::is_integral_v<T>     ? 'i'
        : std::is_same_v<T, Time>   ? 't'
                                    : 'd');
    add(static_cast<char>('0' + sizeof(T)));
    ++leaves;
  }
};
LayoutHash frame_layout() {
  LayoutHash hash;
  RecordedTick frame;
  all_fields(hash, frame);
  return hash;
}
// A frame holds the hash of the state, so a state of another make is another layout, too.
template <class Memory>
std::uint64_t layout_with(Memory memory) {
  LayoutHash hash = frame_layout();
  State state;
  state.task = memory;
  fields(hash, state);
  return hash.value;
}
template <class... Task>
std::vector<std::uint64_t> layouts_of(const std::variant<Task...>*) {
  return {layout_with(typename Task::Memory{})...};
}

}  // namespace

std::size_t frame_words() {
  static const std::size_t kWords = frame_layout().leaves;
  return kWords;
}

const std::vector<std::uint64_t>& layouts() {
  static const std::vector<std::uint64_t> kLayouts = layouts_of(static_cast<const Tasks::Any*>(nullptr));
  return kLayouts;
}

std::uint64_t layout_hash(const Scene& scene) { return layouts()[scene.task.index()]; }

}  // namespace enc
