// A frame of a record, field by field: of the record's own files alone.
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

[[nodiscard]] std::size_t frame_words();  // leaves of a frame, a word each
// Layout hashes, of each task.
[[nodiscard]] const std::vector<std::uint64_t>& layouts();

}  // namespace enc
