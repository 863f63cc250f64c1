// Replays a record: feeds its inputs to the core again and compares every output bit with the record.
// Usage: replay RECORD.encrec
#include "core/record/replay.h"

#include <algorithm>
#include <cstdio>

#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"

int main(int count, char** words) {
  if (count != 2) return std::fputs("replay RECORD.encrec\n", stderr), 2;
  enc::RecordReader record(words[1]);
  const enc::models::Setup setup = enc::models::setup_of(record.texts(), words[1]);
  const enc::Scene scene = enc::trial::prepare_setup(setup);
  double peak = 0.0;
  for (enc::RecordedTick frame; record.next(frame);) peak = std::max(peak, frame.out.force_unfiltered.norm());
  record.rewind();
  const enc::ReplayResult again = enc::replay(scene, record);
  std::printf("%lld ticks, peak force %.1f N, state hash %016llx\n", static_cast<long long>(again.ticks),
              peak, static_cast<unsigned long long>(again.hash));
  if (again.first_difference >= 0)
    std::printf("differs from tick %lld on: %s\n", static_cast<long long>(again.first_difference),
                again.what.c_str());
  return again.first_difference >= 0 ? 1 : 0;
}
