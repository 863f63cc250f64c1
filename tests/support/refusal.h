// The refusal of a call.
#pragma once

#include <concepts>
#include <optional>
#include <string>

#include <gmock/gmock.h>

#include "core/base/error.h"

namespace enc::test {

// The message of the Error that `act` throws, one line and of this kind; empty if it throws no Error.
template <std::invocable Act>
std::string refusal(std::optional<ErrorKind> kind, const Act& act) {
  try {
    act();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind.value_or(e.kind())) << e.what();
    EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("\n")));
    return e.what();
  }
  return {};
}
template <std::invocable Act>
std::string refusal(const Act& act) {
  return refusal({}, act);
}

}  // namespace enc::test
