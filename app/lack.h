// What of a record is not there, as a person is told it.
#pragma once

#include <string>

#include <fmt/format.h>

#include "core/record/record.h"

namespace enc::app {

// in: what was made of the rest, "table". Empty where nothing is missing.
[[nodiscard]] inline std::string lack_of(const RecordReader& record, const char* in) {
  if (!record.damage().empty())
    return fmt::format("{}; only the {} ticks before it are in the {}", record.damage(), record.ticks(), in);
  if (!record.sealed())
    return fmt::format(
        "is not sealed: it was cut off, or its run was killed; the {} ticks that it holds are in the {}",
        record.ticks(), in);
  return {};
}

}  // namespace enc::app
