// A frame of a record, field by field. Only the record's own files include this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/record/fields.h"
#include "core/record/record.h"

namespace enc {

template <class F>
void all_fields(F& f, RecordedTick& frame) {
  fields(f, frame.tick);
  fields(f, frame.in);
  fields(f, frame.out);
  f("state_hash", frame.hash);
}

[[nodiscard]] std::size_t frame_words();  // leaves of a frame, one word each
// Layout hash of each task.
[[nodiscard]] const std::vector<std::uint64_t>& layouts();

}  // namespace enc
