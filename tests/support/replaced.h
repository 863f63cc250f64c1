// A text with something else in it: how a test breaks a file.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace enc::test {

// The first `from` becomes `to`; it must be there.
[[nodiscard]] inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "not in the text: " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace enc::test
