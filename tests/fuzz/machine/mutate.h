// Spoils inputs at random: bits, bytes, words, lines, lengths, nesting, and pieces of other inputs.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace enc::fuzz {

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

}  // namespace enc::fuzz
