// Puts a record into its file beside a run that keeps to the wall clock, so that no tick waits for a disk.
#pragma once

#include <chrono>
#include <thread>

#include "core/record/record.h"

namespace enc::trial {

class RecordThread {
 public:
  static constexpr std::chrono::milliseconds kLook{10};  // up to 6 kHz less than a chunk comes meanwhile
  // `writer` stays until this is gone, and is closed after that.
  explicit RecordThread(RecordWriter& writer);
  RecordThread(const RecordThread&) = delete;
  RecordThread& operator=(const RecordThread&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace enc::trial
