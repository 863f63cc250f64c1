// What in a name says which camera took an image, in any case: left01 and right01, L1 and R1, cam0_1 and
// cam1_1. Names are those of files without their ending, or of folders.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace enc::images {

enum class Eye : std::uint8_t { left, right };

// The plainest first. A letter stands alone or after a small one: L1, 01_l, camL. A number follows the word
// cam or camera and another one counts the images; of a folder, it follows one of some more words or stands
// alone.
enum class Mark : std::uint8_t { word, letter, number };
inline constexpr std::array kMarks{Mark::word, Mark::letter, Mark::number};
enum class Named : std::uint8_t { file, folder };

// One place of a name that says that it is of this eye. The right camera has the left one's number and one
// more.
struct Marked {
  std::string rest;     // the name without it
  std::string partner;  // the name that the other eye has, in small letters
};
[[nodiscard]] std::vector<Marked> marks_in(std::string_view name, Mark mark, Eye eye, Named named);

[[nodiscard]] std::string small_letters(std::string_view text);  // A to Z alone

// Numbers by their value, the rest by its letters: frame 9 before frame 10.
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const;
};

}  // namespace enc::images
