// A record is a file that anybody may have written: each number of it is within the range that its reader
// states, or the file is refused with the byte.
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/ranges.h"
#include "core/record/record.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/core/record/refusal.h"

namespace enc {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using Spoil = std::function<void(RecordedTick&)>;

class RecordRanges : public ::testing::Test {
 protected:
  // 300 ticks, several chunks; `spoil` has the one of index 200.
  [[nodiscard]] std::string written(const Spoil& spoil) const {
    const std::string path = folder_.file("a.encrec");
    RecordWriter record(path, {}, layout_hash(Scene()));
    for (std::int64_t i = 0; i < 300; ++i) {
      RecordedTick frame;
      frame.tick = {i, Time(Duration(1'000'000 * i)), Duration(1'000'000)};
      if (i == 200) spoil(frame);
      record.write(frame.tick, frame.in, frame.out, 0);
    }
    record.close();
    return path;
  }
  // What its reader says of it, or nothing.
  [[nodiscard]] std::string refusal(const Spoil& spoil) const { return test::refusal(written(spoil)); }
  test::TemporaryFolder folder_;
};

TEST_F(RecordRanges, WhatIsBeyondThemIsRefusedAndNamed) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const auto wrong = [&](const std::string& words, const Spoil& spoil) {
    EXPECT_THAT(refusal(spoil),
                MatchesRegex(".*a\\.encrec: byte [0-9]+: '" + words + "; record the run again"));
  };
  wrong("mode' of a tick is 200; expected 0 to 6",
        [](RecordedTick& f) { f.out.mode = static_cast<Mode>(200); });
  wrong("view_mode' .* is 7; .*", [](RecordedTick& f) { f.out.view.mode = static_cast<Mode>(7); });
  for (const auto& spoil :
       std::vector<Spoil>{[](RecordedTick& f) { f.in.tool.health = static_cast<Health>(6); },
                          [](RecordedTick& f) { f.in.wrench.health = static_cast<Health>(77); },
                          [](RecordedTick& f) { f.in.dent.health = static_cast<Health>(255); }})
    wrong("health' .*; expected 0 to 5", spoil);
  wrong("dent_tip_shape' .* is 3; .*",
        [](RecordedTick& f) { f.in.dent.value.tip.shape = static_cast<TipShape>(3); });
  wrong("grip_phase' .* is 4; .*",
        [](RecordedTick& f) { f.in.grip.value.phase = static_cast<GripPhase>(4); });
  wrong("index' of a tick is 199; expected 200 to 1000000000000",
        [](RecordedTick& f) { f.tick.index = 199; });
  wrong("index' .*", [&](RecordedTick& f) { f.tick.index = kMost; });
  wrong("t' of a tick is 9223372036854775807; expected 0 to 1000000000000000000",
        [&](RecordedTick& f) { f.tick.t = Time(Duration(kMost)); });
  wrong("t' .* is -1; .*", [](RecordedTick& f) { f.tick.t = Time(Duration(-1)); });
  wrong("dt' .*", [](RecordedTick& f) { f.tick.dt = Duration(-1); });
  wrong("view_t' .*", [](RecordedTick& f) { f.out.view.t = Time(Duration(-1)); });
  wrong("stamp' .*", [&](RecordedTick& f) { f.in.tip.t = Time(Duration(-kMost)); });
  wrong("missed' .*", [](RecordedTick& f) { f.in.missed = -1; });
  wrong("contacts' of a tick is 202; expected 0 to 201", [](RecordedTick& f) { f.out.contacts = 202; });
}

TEST_F(RecordRanges, WhatIsWithinThemIsRead) {
  EXPECT_EQ(refusal([](RecordedTick& f) {
              f.out.mode = f.out.view.mode = Mode::travel;
              f.in.tool.health = Health::fault;
              f.in.dent.value.tip.shape = TipShape::edge;
              f.in.grip.value.phase = GripPhase::opening;
              f.in.tip.t = Time(Duration(-kMostStamp));
              f.in.arm.t = Time(Duration(kMostStamp));
              f.in.missed = kMostTicks;
              f.out.contacts = 201;
              f.out.object = -1;
              f.out.why = 0xffffffffU;
            }),
            "");
}

// What stands before it is whole.
TEST_F(RecordRanges, APartialRecordEndsBeforeTheChunkAndSaysWhy) {
  RecordReader reader(written([](RecordedTick& f) { f.out.mode = static_cast<Mode>(200); }), Partial::yes);
  EXPECT_THAT(reader.damage(), HasSubstr("'mode' of a tick is 200"));
  EXPECT_GE(reader.ticks(), 100);
  EXPECT_LE(reader.ticks(), 200);
  RecordedTick frame;
  std::int64_t ticks = 0;
  while (reader.next(frame)) ++ticks;
  EXPECT_EQ(ticks, reader.ticks());
}

}  // namespace
}  // namespace enc
