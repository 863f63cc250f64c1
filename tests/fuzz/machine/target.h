// A parser as a target of fuzzing: where it starts from, what its format is made of, how it is called.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace enc::fuzz {

inline std::string text_of(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) text.push_back(static_cast<char>(byte));
  return text;
}

// Heap that a parser may hold at once, in bytes: so many for each byte of its input, and so many besides.
struct Bound {
  std::size_t per_byte = 0, besides = 0;
};

struct Target {
  std::string name;
  std::vector<std::string> seeds;   // whole inputs, most of which are accepted
  std::vector<std::string> tokens;  // words of the format, and what breaks readers of it
  // Feeds the parser. Whether it was accepted; enc::Error where it was refused; Broken where what was
  // accepted is not as it must be.
  std::function<bool(const std::string&)> run;
  // Puts right what guards the rest (checksums, lengths), so that the rest is read, too. May be empty.
  std::function<void(std::string&)> mend{};
  Bound bound{256, 4U << 20U};
  std::size_t inputs = 2000;  // of the short form
};

struct Broken : std::logic_error {
  using std::logic_error::logic_error;
};
inline void expect(bool good, const std::string& what) {
  if (!good) throw Broken(what);
}

// A target is made when it is first asked for: `static const Offer kOffer("scene", &scene);` offers one.
struct Offer {
  Offer(const std::string& name, Target (*make)());
};
[[nodiscard]] std::vector<std::string> names();
[[nodiscard]] const Target& target(const std::string& name);

}  // namespace enc::fuzz
