// Finds the part of a name that states the camera of an image, in any case: left01 and right01, L1 and R1,
// cam0_1 and cam1_1. Names are those of files without their ending, or of folders.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace enc::images {

enum class Eye : std::uint8_t { left, right };

// Kinds of marks, the plainest first. A letter stands alone or after a small one: L1, 01_l, camL. A number
// follows the word cam or camera, and another number counts the images; in a folder's name, it follows one of
// some more words or stands alone.
enum class Mark : std::uint8_t { word, letter, number };
inline constexpr std::array kMarks{Mark::word, Mark::letter, Mark::number};
enum class Named : std::uint8_t { file, folder };

// One part of a name that states this eye. The right camera's number is the left one's plus one.
struct Marked {
  std::string rest;     // the name without that part
  std::string partner;  // the other eye's name, in small letters
};
[[nodiscard]] std::vector<Marked> marks_in(std::string_view name, Mark mark, Eye eye, Named named);

[[nodiscard]] std::string small_letters(std::string_view text);  // converts only A to Z

// Compares numbers by value and the rest by letters: frame 9 before frame 10.
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const;
};

}  // namespace enc::images
