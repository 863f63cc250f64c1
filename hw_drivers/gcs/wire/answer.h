// Answers, out of a stream of bytes that may be cut anywhere. Each inner line ends with a blank and a line
// feed, the last one with a line feed alone.
#pragma once

#include <span>
#include <string_view>

#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

class AnswerReader {
 public:
  // Takes bytes up to the end of the answer that is under way, and says how many it took. While an answer
  // is complete(), none.
  std::size_t take(std::string_view bytes) noexcept;
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // Longer than kMostText: what follows cannot be trusted, and all is refused from then on.
  [[nodiscard]] bool overflown() const noexcept { return answer_.cut(); }
  [[nodiscard]] std::string_view answer() const noexcept { return answer_.view(); }  // with its line feeds
  void next() noexcept;                                                              // forgets this one

 private:
  Text answer_;
  bool complete_ = false;
};

// "X=1.5 \nY=0\n": for each axis its number. False where one is missing, doubled, unknown or no number.
[[nodiscard]] bool read_axes(std::string_view answer, std::string_view axes,
                             std::span<double> values) noexcept;
// One number, "20.5\n".
[[nodiscard]] bool read_single(std::string_view answer, double& number) noexcept;
// What ERR? is answered with: "0\n".
[[nodiscard]] bool read_error(std::string_view answer, int& number) noexcept;

}  // namespace enc::gcs
