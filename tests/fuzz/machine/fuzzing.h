// Fuzzing of parsers: what a target is, what spoils its inputs, and what judges how it took one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
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

// A parser as a target of fuzzing: where it starts from, what its format is made of, how it is called.
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

// Spoils inputs at random: bits, bytes, words, lines, lengths, nesting, and pieces of other inputs.
class Mutator {
 public:
  Mutator(std::uint64_t seed, std::vector<std::string> seeds, std::vector<std::string> tokens);

  [[nodiscard]] std::string next();
  // An input that was accepted is worth spoiling further.
  void keep(const std::string& input);
  [[nodiscard]] std::size_t of(std::size_t n) { return n == 0 ? 0 : engine_() % n; }  // 0 to n - 1

 private:
  void spoil(std::string& bytes);
  void spoil_bytes(std::string& bytes);
  void spoil_words(std::string& bytes);
  void spoil_lines(std::string& bytes);
  void spoil_whole(std::string& bytes);
  [[nodiscard]] const std::string& token() { return tokens_[of(tokens_.size())]; }

  std::mt19937_64 engine_;
  std::vector<std::string> seeds_, kept_, tokens_;
};

// Heap of this program through operator new, counted; of a build with a sanitizer nothing is counted, because
// that one watches itself.
[[nodiscard]] std::size_t live_bytes();  // now
[[nodiscard]] std::size_t peak_bytes();  // most since forget_peak()
void forget_peak();

struct Verdict {
  bool accepted = false;
  std::string wrong;          // empty: nothing
  std::size_t most_heap = 0;  // bytes
  double seconds = 0.0;       // of CPU time
};
// Runs one input through a target and says what is wrong with how it took it.
[[nodiscard]] Verdict judge(const Target& target, const std::string& input);

// Writes the input to a file of the temporary folder and gives its name.
[[nodiscard]] std::string kept_input(const Target& target, const std::string& input);

// From now on a signal, a sanitizer's report and an input that takes more than kMostCpu of CPU time end the
// program with `words` and the file of the input that was being read.
inline constexpr int kMostCpu = 20;  // s
void watch(const std::string& words);

}  // namespace enc::fuzz
