// A run in which a passivity controller acts, and what its record says of it.
#pragma once

#include <gtest/gtest.h>

#include "core/record/replay.h"
#include "models/setup/scene_file.h"
#include "tests/support/temporary_folder.h"
#include "trial/trial.h"

namespace enc::trial {

// It acts, and the record of that replays to the same bits. `time_s` unset: as long as the user goes on.
inline void expect_acts_and_replays(const models::Setup& setup, double time_s = kUnset) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("controlled.encrec");
  TrialOptions options;
  options.seconds = time_s;
  std::uint32_t why = 0;
  options.watch = [&](const Glance& glance) { why |= glance.out.why; };
  Trial trial(setup, options);
  RecordWriter record(path, models::record_texts(setup), layout_hash(trial.scene()));
  trial.record_to(&record);
  const TrialResult result = trial.run();
  record.close();
  EXPECT_NE(why & kPassive, 0U) << "it acted";
  RecordReader reader(path);
  const ReplayResult again = replay(trial.scene(), reader);
  EXPECT_EQ(again.first_difference, -1) << again.what;
  EXPECT_EQ(again.hash, result.hash);
}

}  // namespace enc::trial
