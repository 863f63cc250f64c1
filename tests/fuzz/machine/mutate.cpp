#include "tests/fuzz/machine/mutate.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace enc::fuzz {
namespace {

constexpr std::size_t kLongest = 1U << 16U;  // bytes; only long runs go beyond
constexpr std::size_t kMostKept = 64;

bool in_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-' ||
         c == '+' || c == '_';
}

struct Piece {
  std::size_t at = 0, size = 0;
};
// The word, or the line with its end, around a byte.
Piece word_at(const std::string& bytes, std::size_t at) {
  std::size_t end = at;
  while (at > 0 && in_word(bytes[at - 1])) --at;
  while (end < bytes.size() && in_word(bytes[end])) ++end;
  return {at, end - at};
}
Piece line_at(const std::string& bytes, std::size_t at) {
  const std::size_t begin = at == 0 ? 0 : bytes.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  return {begin, std::min(bytes.find('\n', at), bytes.size() - 1) + 1 - begin};
}

}  // namespace

Mutator::Mutator(std::uint64_t seed, std::vector<std::string> seeds, std::vector<std::string> tokens)
    : engine_(seed), seeds_(std::move(seeds)), tokens_(std::move(tokens)) {
  const std::array<std::string, 26> common{"nan",
                                           "-nan",
                                           "inf",
                                           "-inf",
                                           "1e999",
                                           "-1e999",
                                           "1e-999",
                                           "-0",
                                           "0",
                                           "-1",
                                           "5e-324",
                                           "1e308",
                                           "18446744073709551616",
                                           "9223372036854775807",
                                           "-9223372036854775808",
                                           "4294967295",
                                           "2147483648",
                                           "1e15",
                                           "0x7f",
                                           "1_0",
                                           "\n",
                                           "\r\n",
                                           "\t",
                                           std::string(1, '\0'),
                                           "\x7f",
                                           "\xc3\xa9"};
  tokens_.insert(tokens_.end(), common.begin(), common.end());
}

void Mutator::keep(const std::string& input) {
  if (input.size() > kLongest) return;
  if (kept_.size() < kMostKept)
    kept_.push_back(input);
  else if (of(64) == 0)
    kept_[of(kMostKept)] = input;
}

std::string Mutator::next() {
  std::string bytes = kept_.empty() || of(2) == 0 ? seeds_[of(seeds_.size())] : kept_[of(kept_.size())];
  do spoil(bytes);
  while (of(3) != 0);
  return bytes;
}

void Mutator::spoil(std::string& bytes) {
  if (bytes.empty()) bytes = token();
  switch (of(8)) {
    case 0:
    case 1:
      return spoil_bytes(bytes);
    case 2:
    case 3:
    case 4:
      return spoil_words(bytes);
    case 5:
    case 6:
      return spoil_lines(bytes);
    default:
      return spoil_whole(bytes);
  }
}

void Mutator::spoil_bytes(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  const auto number = [&] {
    const std::array<std::uint64_t, 12> some{0,     1,           bytes.size(), bytes.size() - 1,
                                             0x7f,  0x7fffffff,  0x80000000,   0xffffffffU,
                                             ~0ULL, 1ULL << 63U, 0xffff,       engine_()};
    return some[of(some.size())];
  };
  switch (of(4)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << of(8)));
      return;
    case 1:
      bytes[at] = static_cast<char>(engine_());
      return;
    case 2: {  // a number of 1, 2, 4 or 8 bytes, mostly where such numbers stand
      const std::size_t size = std::size_t{1} << of(4), place = of(4) == 0 ? at : at / size * size;
      const std::uint64_t value = number();
      std::memcpy(bytes.data() + place, &value, std::min(size, bytes.size() - place));
      return;
    }
    default: {  // one that stands there, a little more or less
      const std::size_t size = std::size_t{1} << of(4);
      if (bytes.size() < size) return;
      const std::size_t place = std::min(at / size * size, bytes.size() - size);
      std::uint64_t value = 0;
      std::memcpy(&value, bytes.data() + place, size);
      value += of(17) - 8;
      std::memcpy(bytes.data() + place, &value, size);
    }
  }
}

void Mutator::spoil_words(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  const Piece word = word_at(bytes, at);
  switch (of(5)) {
    case 0:
      bytes.insert(at, token());
      return;
    case 1:
    case 2:
      bytes.replace(word.at, word.size, token());
      return;
    case 3: {  // another word of the same input
      const Piece other = word_at(bytes, of(bytes.size()));
      bytes.replace(word.at, word.size, bytes.substr(other.at, other.size));
      return;
    }
    default:  // a digit
      for (std::size_t i = word.at; i < word.at + word.size; ++i)
        if (bytes[i] >= '0' && bytes[i] <= '9' && of(2) == 0) bytes[i] = static_cast<char>('0' + of(10));
  }
}

void Mutator::spoil_lines(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  const Piece line = line_at(bytes, at);
  const std::string text = bytes.substr(line.at, line.size);
  switch (of(6)) {
    case 0:
      bytes.erase(line.at, line.size);
      return;
    case 1:
      bytes.insert(line.at, text);
      return;
    case 2: {
      const Piece other = line_at(bytes, of(bytes.size()));
      bytes.insert(other.at, text);
      return;
    }
    case 3:
      bytes.erase(at, of(bytes.size() - at) + 1);
      return;
    case 4: {  // a piece, many times
      const std::string piece = bytes.substr(at, 1 + of(40));
      for (std::size_t i = of(50); i > 0 && bytes.size() < kLongest; --i) bytes.insert(at, piece);
      return;
    }
    default: {  // a piece of another input
      const std::string& other = seeds_[of(seeds_.size())];
      if (other.empty()) return;
      const std::size_t from = of(other.size());
      bytes.replace(at, of(2) == 0 ? std::string::npos : of(64),
                    other.substr(from, of(2) == 0 ? std::string::npos : of(256)));
      bytes.resize(std::min(bytes.size(), kLongest));
    }
  }
}

void Mutator::spoil_whole(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  switch (of(6)) {
    case 0:
    case 1:
      bytes.resize(at);
      return;
    case 2:
      bytes.insert(0, of(2) == 0 ? "\xEF\xBB\xBF" : std::string(1, '\0'));
      return;
    case 3:  // ends of lines as elsewhere
      if (bytes.size() > kLongest) return;
      for (std::size_t i = bytes.find('\n'); i != std::string::npos; i = bytes.find('\n', i + 2))
        bytes.insert(i, "\r");
      return;
    case 4: {  // deep nesting
      static constexpr std::array<std::string_view, 5> kOpen{"[", "{", "[[", "{a=", "{\"a\":["};
      const std::string_view open = kOpen[of(kOpen.size())];
      std::string nest;
      for (std::size_t i = of(of(50) == 0 ? 20'000 : 300); i > 0; --i) nest += open;
      bytes.insert(at, nest);
      return;
    }
    default:  // a long run
      bytes.insert(at, std::string(of(of(50) == 0 ? 200'000 : 300), token().empty() ? 'a' : token()[0]));
  }
}

}  // namespace enc::fuzz
