// What of a record is not there, as a person is told it.
#pragma once

#include <string>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/record/record.h"

namespace enc::app {

// in: what was made of the rest, "table". Empty where nothing is missing.
[[nodiscard]] inline std::string lack_of(const RecordReader& record, const char* in) {
  const std::string ticks = counted(record.ticks(), "tick");
  const char* are = record.ticks() == 1 ? "is" : "are";
  if (!record.damage().empty())
    return fmt::format("{}; only the {} before it {} in the {}", record.damage(), ticks, are, in);
  if (!record.sealed())
    return fmt::format(
        "is not sealed: it was cut off, or its run was killed; the {} that it holds {} in the {}", ticks, are,
        in);
  return {};
}

}  // namespace enc::app
