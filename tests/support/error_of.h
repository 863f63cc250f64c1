// The text of the Error that a call throws.
#pragma once

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::test {

// Empty if the call throws no Error. With `kind` it expects an Error of that kind.
template <class Call>
std::string error_of(const Call& call, std::optional<ErrorKind> kind = {}) {
  try {
    call();
  } catch (const Error& e) {
    if (kind) {
      EXPECT_EQ(e.kind(), *kind) << e.what();
    }
    return e.what();
  }
  return {};
}

}  // namespace enc::test
