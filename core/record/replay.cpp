#include "core/record/replay.h"

#include <charconv>

namespace enc {
namespace {

struct Leaf {
  std::string_view name;
  std::uint64_t bits = 0;
  bool real = false;
};
// Keeps its memory from tick to tick.
struct Leaves {
  std::vector<Leaf> list;
  template <class T>
  void operator()(std::string_view name, T& x) {
    list.push_back({name, leaf_bits(x), std::is_floating_point_v<T>});
  }
};
void list_leaves(Leaves& leaves, Outputs& out) {
  leaves.list.clear();
  fields(leaves, out);
}

// The shortest text that reads back to the same bits; without a locale.
std::string text_of(const Leaf& leaf) {
  std::array<char, 40> text{};
  const auto end = leaf.real ? std::to_chars(text.begin(), text.end(), std::bit_cast<double>(leaf.bits))
                             : std::to_chars(text.begin(), text.end(), static_cast<std::int64_t>(leaf.bits));
  return {text.data(), end.ptr};
}

// "force_N[2]": a leaf's name and its index among the leaves of that name.
std::string name_of(const std::vector<Leaf>& list, std::size_t i) {
  std::size_t first = i;
  while (first > 0 && list[first - 1].name == list[i].name) --first;
  const bool several = first < i || (i + 1 < list.size() && list[i + 1].name == list[i].name);
  return std::string(list[i].name) + (several ? "[" + std::to_string(i - first) + "]" : "");
}

std::string difference(const std::vector<Leaf>& recorded, const std::vector<Leaf>& computed) {
  for (std::size_t i = 0; i < recorded.size(); ++i)
    if (recorded[i].bits != computed[i].bits)
      return name_of(recorded, i) + ": recorded " + text_of(recorded[i]) + ", computed " +
             text_of(computed[i]);
  return {};
}

}  // namespace

ReplayResult replay(const Scene& scene, RecordReader& record) {
  ReplayResult result;
  State state;
  Outputs out;
  StateHash hash;
  RecordedTick frame;
  Leaves recorded, computed;
  for (record.rewind(); record.next(frame); ++result.ticks) {
    step(scene, frame.tick, frame.in, state, out);
    add_tick(hash, state, out);
    if (result.first_difference >= 0) continue;
    list_leaves(recorded, frame.out);
    list_leaves(computed, out);
    result.what = difference(recorded.list, computed.list);
    if (result.what.empty() && frame.hash != hash.value)
      result.what = "state_hash: recorded " + std::to_string(frame.hash) + ", computed " +
                    std::to_string(hash.value) + " (the outputs are the same)";
    if (!result.what.empty()) result.first_difference = frame.tick.index;
  }
  result.hash = hash.value;
  return result;
}

}  // namespace enc
