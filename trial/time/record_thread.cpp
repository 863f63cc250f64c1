#include "trial/time/record_thread.h"

#include "trial/time/beside_loop.h"

namespace enc::trial {

RecordThread::RecordThread(RecordWriter& writer)
    : thread_(beside_loop([&writer](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          writer.drain();
          std::this_thread::sleep_for(kLook);
        }
      })) {}

}  // namespace enc::trial
