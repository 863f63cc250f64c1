// Writes a record to its file beside a wall-clock run, so that no tick waits for a disk.
#pragma once

#include <chrono>
#include <thread>

#include "core/record/record.h"

namespace enc::trial {

class RecordThread {
 public:
  // Shorter than the time of a chunk up to 6 kHz.
  static constexpr std::chrono::milliseconds kLook{10};
  // `writer` must outlive this object, and is closed afterwards.
  explicit RecordThread(RecordWriter& writer);
  RecordThread(const RecordThread&) = delete;
  RecordThread& operator=(const RecordThread&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace enc::trial
