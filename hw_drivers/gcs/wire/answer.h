// Reads answers from a stream of bytes that may be cut anywhere. Each inner line ends with a blank and a line
// feed, the last one with only a line feed.
#pragma once

#include <span>
#include <string_view>

#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

class AnswerReader {
 public:
  // Takes bytes up to the end of the pending answer, and returns their number. While an answer is complete(),
  // it takes no bytes.
  std::size_t take(std::string_view bytes) noexcept;
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // True if the answer exceeded kMostText: the following bytes cannot be trusted, and everything is refused
  // from then on.
  [[nodiscard]] bool overflown() const noexcept { return answer_.cut(); }
  [[nodiscard]] std::string_view answer() const noexcept { return answer_.view(); }  // with its line feeds
  void next() noexcept;                                                              // forgets this answer

 private:
  Text answer_;
  bool complete_ = false;
};

// "X=1.5 \nY=0\n": one number for each axis. False if one is missing, doubled, unknown or not a number.
[[nodiscard]] bool read_axes(std::string_view answer, std::string_view axes,
                             std::span<double> values) noexcept;
// One number, "20.5\n".
[[nodiscard]] bool read_single(std::string_view answer, double& number) noexcept;
// The answer to ERR?: "0\n".
[[nodiscard]] bool read_error(std::string_view answer, int& number) noexcept;

}  // namespace enc::gcs
