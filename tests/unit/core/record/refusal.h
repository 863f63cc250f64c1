// What the reader of a record says of a file.
#pragma once

#include <string>

#include "core/base/error.h"
#include "core/record/record.h"

namespace enc::test {

// The one line with which it refuses the file, or "" where it has nothing to say.
inline std::string refusal(const std::string& path) {
  try {
    RecordReader reader(path);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

}  // namespace enc::test
