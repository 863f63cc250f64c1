// Text of GCS: locale-independent numbers, in a buffer that never grows.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace enc::gcs {

// The longest text of either side; six axes with a number of 20 characters each are far shorter.
inline constexpr std::size_t kMostText = 4096;

class Text {
 public:
  Text& add(std::string_view part) noexcept;
  Text& add(char character) noexcept { return add(std::string_view(&character, 1)); }
  // Twelve significant digits, as "%.12g" in the C locale; zero has no sign.
  Text& add(double number) noexcept;
  Text& add(int whole) noexcept;

  void clear() noexcept { size_ = 0, cut_ = false; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] bool cut() const noexcept { return cut_; }  // something did not fit and was left out
  [[nodiscard]] std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, kMostText> bytes_{};
  std::size_t size_ = 0;
  bool cut_ = false;
};

// Reads a text that must be one finite number. Returns false and keeps `number` otherwise.
[[nodiscard]] bool read_number(std::string_view text, double& number) noexcept;
[[nodiscard]] bool read_number(std::string_view text, int& whole) noexcept;

// Removes and returns the next word of a text, by blanks. Empty if no word is left.
[[nodiscard]] std::string_view next_word(std::string_view& text) noexcept;

// The text without blanks and line ends at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

}  // namespace enc::gcs
