// The missing part of a record, as a text for the user.
#pragma once

#include <string>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/record/record.h"

namespace enc::app {

// `in` names the result made from the rest, "table". Empty if the record is complete.
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
