// Fuzzing of parsers: targets, mutations of inputs, and the judge of each result.
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

// Heap that a parser may hold at once, in bytes: per byte of its input, plus a constant.
struct Bound {
  std::size_t per_byte = 0, besides = 0;
};

// A parser as a target of fuzzing: its seeds, the words of its format, and its call.
struct Target {
  std::string name;
  std::vector<std::string> seeds;   // whole inputs, most of which are accepted
  std::vector<std::string> tokens;  // words of the format, and words that break its readers
  // Feeds the parser. Returns whether it accepted the input; throws enc::Error for a refusal, and Broken if
  // an accepted input has a wrong result.
  std::function<bool(const std::string&)> run;
  // Corrects checksums and lengths, so that the parser reads the rest, too. May be empty.
  std::function<void(std::string&)> mend{};
  Bound bound{256, 4U << 20U};
  std::size_t inputs = 2000;  // in the short form
};

struct InvariantError : std::logic_error {
  using std::logic_error::logic_error;
};
inline void expect(bool good, const std::string& what) {
  if (!good) throw InvariantError(what);
}

// Makes a target at its first use: `static const Offer kOffer("scene", &scene);` offers one.
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
  // Keeps an accepted input for further mutations.
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

// Counted heap of this program through operator new. Builds with a sanitizer do not count, because the
// sanitizer checks the heap itself.
[[nodiscard]] std::size_t live_bytes();  // now
[[nodiscard]] std::size_t peak_bytes();  // maximum since forget_peak()
void forget_peak();

struct Verdict {
  bool accepted = false;
  std::string wrong;          // empty: no error
  std::size_t most_heap = 0;  // bytes
  double seconds = 0.0;       // CPU time
};
// Runs one input through a target and reports errors of the result.
[[nodiscard]] Verdict judge(const Target& target, const std::string& input);

// Writes the input to a file of the temporary folder and returns its name.
[[nodiscard]] std::string kept_input(const Target& target, const std::string& input);

// After this call three events end the program with `words` and a file of the current input: a signal, a
// sanitizer's report, or more than kMostCpu of CPU time for one input.
inline constexpr int kMostCpu = 20;  // s
void watch(const std::string& words);

}  // namespace enc::fuzz
