// The record: a reader reads what a writer wrote and names any damage, and a replay gives the same bits.
#include "core/record/record.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/record/ranges.h"
#include "core/record/replay.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using testing::HasSubstr, testing::MatchesRegex;

std::string refusal(const std::string& path) {
  return test::refusal([&] { RecordReader reader(path); });
}

class RecordTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_ / name).string(); }

  // A press on the ball: follow, contact, restore. 600 ticks are several chunks and a rest.
  void record_press(const std::string& path, int ticks = 600,
                    const RecordTexts& ends = {{"ledger", "contact,hand_mJ\n1,2.5\n"}}) {
    test::Loop loop(prepare(test::ball_scene(test::lossy_ball()), RigSpec{}));
    RecordWriter record(path, {{"resolved", "format = 1\n"}, {"seed", "7"}, {"version", "9.8.7"}},
                        layout_hash(loop.scene));
    StateHash hash;
    for (int i = 0; i < ticks; ++i) {
      loop.tool_tip = Point<'W'>(0, 0, i < 300 ? 0.05 - 1.5e-4 * i : 0.005 + 5e-5 * (i - 300));
      loop.force = Vec<'W'>(0.2, 0, i > 250 && i < 400 ? -3.0 : 0.0);
      loop.tick();
      add_tick(hash, loop.state, loop.out);
      record.write(loop.k, loop.in, loop.out, hash.value);
    }
    if (!ends.empty()) record.end_with(ends);
    record.close();
    ASSERT_FALSE(record.full()) << record.error();
  }
  static void write_bytes(const std::string& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  // Offsets of the header, each chunk, the end texts and the seal.
  static std::vector<std::size_t> parts_of(const std::string& record) {
    const auto word = [&](std::size_t byte) {
      std::uint64_t value = 0;
      std::memcpy(&value, record.data() + byte, sizeof(value));
      return value;
    };
    std::vector<std::size_t> parts{0};
    for (std::size_t at = 40 + (word(8) >> 32U); at < record.size(); at += 16 + (word(at) >> 32U))
      parts.push_back(at);
    return parts;
  }
  test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

template <class T>
std::vector<std::uint64_t> leaves_of(T value) {
  std::vector<std::uint64_t> bits;
  auto list = [&](std::string_view, auto& x) { bits.push_back(leaf_bits(x)); };
  fields(list, value);
  return bits;
}

TEST_F(RecordTest, GivesBackEveryLeaf) {
  const std::string path = file("all");
  // Each leaf has another value; the first tick has them all unset (NaN), the third has extreme doubles.
  RecordedTick set;
  std::uint64_t n = 0;
  auto number = [&](std::string_view, auto& x) {
    using T = std::decay_t<decltype(x)>;
    ++n;
    if constexpr (std::is_floating_point_v<T>)
      x = 0.1 * static_cast<double>(n);
    else
      set_leaf(x, n % 3);
  };
  fields(number, set.tick);
  fields(number, set.in);
  fields(number, set.out);
  set.tick.index = 5;
  RecordedTick odd;
  odd.tick.index = 6;
  odd.in.tool.value.X_CT.xyz = {-0.0, INFINITY, 5e-324};
  odd.in.tool.t = Time(Duration(-5));
  odd.in.wrench.value.force.xyz[0] = -std::nan("0x123");  // another NaN than the canonical one
  {
    RecordWriter record(path, {{"a", ""}, {"b", std::string("x\0y", 3)}}, layout_hash(Scene()));
    record.write({}, {}, {}, 1);
    record.write(set.tick, set.in, set.out, 2);
    record.write(odd.tick, odd.in, odd.out, 0xffffffffffffffffULL);
    record.close();
    EXPECT_EQ(record.ticks(), 3);
  }
  RecordReader reader(path);
  EXPECT_TRUE(reader.sealed());
  EXPECT_EQ(reader.ticks(), 3);
  EXPECT_EQ(reader.texts(), (RecordTexts{{"a", ""}, {"b", std::string("x\0y", 3)}}));
  for (int pass = 0; pass < 2; ++pass, reader.rewind()) {
    RecordedTick got;
    ASSERT_TRUE(reader.next(got));
    EXPECT_EQ(leaves_of(got.in), leaves_of(Inputs{}));
    EXPECT_EQ(got.hash, 1U);
    ASSERT_TRUE(reader.next(got));
    EXPECT_EQ(leaves_of(got.tick), leaves_of(set.tick));
    EXPECT_EQ(leaves_of(got.in), leaves_of(set.in));
    EXPECT_EQ(leaves_of(got.out), leaves_of(set.out));
    ASSERT_TRUE(reader.next(got));
    EXPECT_EQ(leaves_of(got.in), leaves_of(odd.in));
    EXPECT_TRUE(std::signbit(got.in.tool.value.X_CT.xyz[0]));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(got.in.wrench.value.force.xyz[0]), 0x7ff8000000000000ULL);
    EXPECT_EQ(got.hash, 0xffffffffffffffffULL);
    EXPECT_FALSE(reader.next(got));
    EXPECT_FALSE(reader.next(got));
  }
}

TEST_F(RecordTest, AnEmptyRunIsARecord) {
  RecordWriter(file("empty"), {}, layout_hash(Scene())).close();
  RecordReader reader(file("empty"));
  RecordedTick got;
  EXPECT_EQ(reader.ticks(), 0);
  EXPECT_TRUE(reader.sealed());
  EXPECT_FALSE(reader.next(got));
}

TEST_F(RecordTest, EveryTruncationIsRefusedAndItsWholeChunksAreReadable) {
  record_press(file("whole"));
  const std::string all = bytes_of(file("whole"));
  std::int64_t most = 0;
  std::vector<std::size_t> lengths;
  for (std::size_t n = 0; n < 200 && n < all.size(); ++n) lengths.push_back(n);
  for (std::size_t n = 200; n < all.size(); n += 4999) lengths.push_back(n);
  for (std::size_t back = 1; back <= 48; ++back) lengths.push_back(all.size() - back);
  std::sort(lengths.begin(), lengths.end());
  for (const std::size_t n : lengths) {
    write_bytes(file("cut"), std::string_view(all).substr(0, n));
    const std::string said = refusal(file("cut"));
    EXPECT_NE(said.find("byte "), std::string::npos) << n << " bytes: " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    if (n < 200) continue;  // the header may be missing
    RecordReader part(file("cut"), PartialRead::yes);
    EXPECT_FALSE(part.sealed());
    EXPECT_GE(part.ticks(), most);
    most = std::max(most, part.ticks());
    RecordedTick got;
    std::int64_t read = 0;
    for (; part.next(got); ++read) ASSERT_EQ(got.tick.index, read);
    EXPECT_EQ(read, part.ticks());
  }
  EXPECT_EQ(most, 600);  // only the seal was missing
}

TEST_F(RecordTest, EveryFlippedByteIsFound) {
  record_press(file("whole"), 150);
  const std::string all = bytes_of(file("whole"));
  const std::vector<std::size_t> parts = parts_of(all);  // header, chunks, texts, seal
  ASSERT_GE(parts.size(), 4U);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < all.size(); i += 997) places.push_back(i);
  for (const std::size_t border : parts)  // each part: its head and the checksum before it, byte by byte
    for (std::size_t i = border - std::min<std::size_t>(border, 24); i < border + 24; ++i)
      if (i < all.size()) places.push_back(i);
  for (const std::size_t i : places) {
    std::string bad = all;
    bad[i] = static_cast<char>(bad[i] ^ 1 << i % 8);
    write_bytes(file("bad"), bad);
    const std::string said = refusal(file("bad"));
    const std::size_t at = said.find(": byte ");
    ASSERT_NE(at, std::string::npos) << "byte " << i << " was changed unnoticed";
    // The error names the changed part, not a later one whose checksum is also wrong.
    const std::size_t part = *(std::upper_bound(parts.begin(), parts.end(), i) - 1);
    if (part != 0) {
      EXPECT_EQ(std::stoul(said.substr(at + 7)), part) << "byte " << i << ": " << said;
    }
  }
  // The error line states the damage: magic, format, a tick, bytes behind the end.
  const auto with = [&](std::size_t i, char c) {
    std::string bad = all;
    bad[i] = c;
    write_bytes(file("bad"), bad);
    return refusal(file("bad"));
  };
  EXPECT_NE(with(0, 'E').find("not a record"), std::string::npos);
  EXPECT_NE(with(8, 3).find("record format 3, but this program reads formats 1 to 2"), std::string::npos);
  EXPECT_NE(with(all.size() / 2, '!').find("checksum failure"), std::string::npos);
  write_bytes(file("more"), all + "x");
  EXPECT_NE(refusal(file("more")).find("after the record's seal"), std::string::npos);
}

TEST_F(RecordTest, SaysAtItsEndWhatWasKnownThen) {
  record_press(file("whole"));
  RecordReader reader(file("whole"));
  const RecordTexts said{{"ledger", "contact,hand_mJ\n1,2.5\n"}};
  EXPECT_EQ(reader.end_texts(), said);
  EXPECT_EQ(reader.ticks(), 600);
  for (int pass = 0; pass < 2; ++pass, reader.rewind()) {
    RecordedTick got;
    int read = 0;
    while (reader.next(got)) ++read;
    EXPECT_EQ(read, 600);
    EXPECT_EQ(reader.end_texts(), said);
  }
  // A run that did not end has no end texts.
  const std::string all = bytes_of(file("whole"));
  const std::vector<std::size_t> parts = parts_of(all);
  const std::size_t texts = parts[parts.size() - 2], seal = parts.back();
  write_bytes(file("cut"), std::string_view(all).substr(0, seal - 1));
  RecordReader part(file("cut"), PartialRead::yes);
  EXPECT_EQ(part.ticks(), 600);
  EXPECT_TRUE(part.end_texts().empty());
  // The end texts appear once, and last.
  const std::string_view whole(all);
  write_bytes(file("twice"), std::string(whole.substr(0, seal)) + std::string(whole.substr(texts)));
  EXPECT_NE(refusal(file("twice")).find("neither a chunk nor the seal"), std::string::npos);
}

// Format 1, before there were end texts: with its own checksums.
std::string of_format_1(const std::string& record, const std::vector<std::size_t>& parts) {
  std::vector<std::uint64_t> words(record.size() / 8);
  std::memcpy(words.data(), record.data(), record.size());
  words[1] = words[1] >> 32U << 32U | 1U;
  StateHash chain;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t from = parts[i] / 8, sum = (i + 1 < parts.size() ? parts[i + 1] / 8 : words.size()) - 1;
    if (i == 0) chain.add(words[from]);
    for (std::size_t at = from + 1; at < sum; ++at) chain.add(words[at]);
    if (i > 0) chain.add(words[from]);
    words[sum] = chain.value;
  }
  return {reinterpret_cast<const char*>(words.data()), record.size()};
}

TEST_F(RecordTest, ReadsWhatSaysNothingAtItsEnd) {
  record_press(file("new"), 150, {});
  const std::string all = bytes_of(file("new"));
  write_bytes(file("old"), of_format_1(all, parts_of(all)));
  for (const char* name : {"new", "old"}) {
    RecordReader reader(file(name));
    EXPECT_TRUE(reader.sealed()) << name;
    EXPECT_EQ(reader.ticks(), 150) << name;
    EXPECT_TRUE(reader.end_texts().empty()) << name;
  }
  record_press(file("told"), 150);
  const std::string told = bytes_of(file("told"));
  write_bytes(file("impossible"), of_format_1(told, parts_of(told)));
  EXPECT_NE(refusal(file("impossible")).find("neither a chunk nor the seal"), std::string::npos);
}

TEST_F(RecordTest, ARecordOfAnotherLayoutSaysWhoWroteItAndWhatToDo) {
  RecordWriter(file("other"), {{"version", "9.8.7"}}, 0x0123456789abcdefULL).close();
  const std::string said = refusal(file("other"));
  EXPECT_NE(said.find("another layout: 0x0123456789abcdef of Encounter 9.8.7"), std::string::npos) << said;
  EXPECT_NE(said.find("use the version of Encounter that wrote it, or record again"), std::string::npos)
      << said;
  RecordWriter(file("later"), {{"version", "9.8.7"}, {"commit", "0123456789ab-dirty"}}, 0x0123456789abcdefULL)
      .close();
  const std::string later = refusal(file("later"));
  EXPECT_NE(later.find("of Encounter 9.8.7, commit 0123456789ab-dirty"), std::string::npos) << later;
  EXPECT_NE(later.find("(git checkout 0123456789ab)"), std::string::npos) << later;
}

TEST_F(RecordTest, OtherFilesAreNoRecords) {
  write_bytes(file("text"), "format = 1\ntitle = \"a scene\"\n");
  EXPECT_NE(refusal(file("text")).find("not a record"), std::string::npos);
  EXPECT_NE(refusal(file("nowhere")).find("cannot read"), std::string::npos);
  EXPECT_FALSE(refusal(folder_.string()).empty());
}

TEST_F(RecordTest, AnUnwritableFolderIsOneClearLine) {
  write_bytes(file("a_file"), "");
  EXPECT_THAT(
      test::refusal(ErrorKind::input,
                    [&] { RecordWriter record(file("a_file") + "/run.encrec", {}, layout_hash(Scene())); }),
      HasSubstr("a_file/run.encrec': Not a directory"));
}

TEST_F(RecordTest, AFullDiskIsSaidBeforeTheRunStarts) {
  EXPECT_THAT(test::refusal([] { RecordWriter record("/dev/full", {}, layout_hash(Scene())); }),
              HasSubstr("No space left on device"));
}

TEST_F(RecordTest, ADiskThatFillsUpLeavesReadableChunks) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 200'000;  // three chunks and a bit
  setrlimit(RLIMIT_FSIZE, &small);
  {
    RecordWriter record(file("full"), {}, layout_hash(Scene()));
    for (int i = 0; i < 2000; ++i) record.write({i, Time(Duration(i)), Duration(1)}, {}, {}, 0);
    EXPECT_TRUE(record.full());
    EXPECT_NE(record.error().find("File too large"), std::string::npos) << record.error();
    record.close();
    EXPECT_TRUE(record.full());
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(refusal(file("full")).find("no seal"), std::string::npos);
  RecordReader part(file("full"), PartialRead::yes);
  RecordedTick got;
  std::int64_t read = 0;
  for (; part.next(got); ++read) ASSERT_EQ(got.tick.index, read);
  EXPECT_EQ(read, part.ticks());
  EXPECT_GE(read, 190);  // two chunks of about 99 ticks; the third does not fit
}

TEST_F(RecordTest, AReplayGivesTheSameBits) {
  record_press(file("run"));
  RecordReader reader(file("run"));
  const ReplayResult result = replay(prepare(test::ball_scene(test::lossy_ball()), RigSpec{}), reader);
  EXPECT_EQ(result.ticks, 600);
  EXPECT_EQ(result.first_difference, -1) << result.what;
  RecordedTick last;
  for (reader.rewind(); reader.next(last);) {
  }
  EXPECT_EQ(result.hash, last.hash);
  EXPECT_GT(last.out.contacts, 0);  // the run was not empty
}

TEST_F(RecordTest, AChangedInputIsFoundAndNamed) {
  record_press(file("run"));
  RecordReader reader(file("run"));
  // Sealed anew after a change of the force by one part in 10^15 at tick 300: a good checksum, another run.
  RecordWriter changed(file("changed"), reader.texts(), reader.layout());
  RecordedTick frame;
  while (reader.next(frame)) {
    double& fz = frame.in.wrench.value.force.xyz[2];
    if (frame.tick.index == 300) fz *= 1.0 + 1e-15;
    changed.write(frame.tick, frame.in, frame.out, frame.hash);
  }
  changed.close();
  RecordReader again(file("changed"));
  const ReplayResult result = replay(prepare(test::ball_scene(test::lossy_ball()), RigSpec{}), again);
  EXPECT_EQ(result.first_difference, 300);
  EXPECT_EQ(result.ticks, 600);
  EXPECT_NE(result.what.find(": recorded "), std::string::npos) << result.what;
  EXPECT_NE(result.what.find("force_N["), std::string::npos) << result.what;
}

TEST_F(RecordTest, AnotherSceneIsAnotherRun) {
  record_press(file("run"));
  RecordReader reader(file("run"));
  const ReplayResult result = replay(prepare(test::ball_scene(), RigSpec{}), reader);
  EXPECT_GE(result.first_difference, 0);
  EXPECT_FALSE(result.what.empty());
}

TEST_F(RecordTest, AChangeOfTheHashAloneIsFound) {
  RecordWriter record(file("hash"), {}, layout_hash(Scene()));
  test::Loop loop(prepare(test::ball_scene(), RigSpec{}));
  loop.tick();
  record.write(loop.k, loop.in, loop.out, 12345);
  record.close();
  RecordReader reader(file("hash"));
  const ReplayResult result = replay(loop.scene, reader);
  EXPECT_EQ(result.first_difference, 0);
  EXPECT_EQ(result.what.find("state_hash: recorded 12345"), 0U) << result.what;
}

TEST(LayoutHash, IsTheSameEveryTimeAndAnotherForEachTask) {
  Scene render, meet, push, probe, travel;
  meet.task = ImpedanceTask();
  push.task = DynamicObjectTask();
  probe.task = IndentationTask();
  travel.task = TrackingTask();
  EXPECT_EQ(layout_hash(render), layout_hash(Scene()));
  std::set<std::uint64_t> all;
  for (const Scene* scene : {&render, &meet, &push, &probe, &travel}) all.insert(layout_hash(*scene));
  EXPECT_EQ(all.size(), std::variant_size_v<Tasks::Any>);
}

// Anybody may have written a record: each number is within the range that its reader states, or the reader
// refuses the file and names the byte.

using Corruption = std::function<void(RecordedTick&)>;

class RecordRanges : public ::testing::Test {
 protected:
  // 300 ticks, several chunks; `spoil` has the one of index 200.
  [[nodiscard]] std::string written(const Corruption& spoil) const {
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
  // The reader's message, or an empty text.
  [[nodiscard]] std::string refusal(const Corruption& spoil) const { return enc::refusal(written(spoil)); }
  test::TemporaryFolder folder_;
};

TEST_F(RecordRanges, WhatIsBeyondThemIsRefusedAndNamed) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const auto wrong = [&](const std::string& words, const Corruption& spoil) {
    EXPECT_THAT(refusal(spoil),
                MatchesRegex(".*a\\.encrec: byte [0-9]+: '" + words + "; record the run again"));
  };
  wrong("mode' of a tick is 200; expected 0 to 6",
        [](RecordedTick& f) { f.out.mode = static_cast<Mode>(200); });
  wrong("view_mode' .* is 7; .*", [](RecordedTick& f) { f.out.view.mode = static_cast<Mode>(7); });
  for (const auto& spoil :
       std::vector<Corruption>{[](RecordedTick& f) { f.in.tool.health = static_cast<Health>(6); },
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

// The part before it is complete.
TEST_F(RecordRanges, APartialRecordEndsBeforeTheChunkAndSaysWhy) {
  RecordReader reader(written([](RecordedTick& f) { f.out.mode = static_cast<Mode>(200); }),
                      PartialRead::yes);
  EXPECT_THAT(reader.damage(), HasSubstr("'mode' of a tick is 200"));
  EXPECT_GE(reader.ticks(), 100);
  EXPECT_LE(reader.ticks(), 200);
  RecordedTick frame;
  std::int64_t ticks = 0;
  while (reader.next(frame)) ++ticks;
  EXPECT_EQ(ticks, reader.ticks());
}

// A record whose chunks another thread writes into the file: identical bytes, and never a gap.

void write_tick(RecordWriter& record, std::int64_t i) {
  record.write({i, Time(Duration(i)), Duration(1)}, {}, {}, static_cast<std::uint64_t>(i));
}

// Another thread drains the chunks, or they stay until the end: the bytes are the same.
TEST(RecordChunks, WhoeverDrainsTheBytesAreTheSame) {
  const test::TemporaryFolder folder;
  const std::uint64_t layout = layout_hash(Scene());
  const std::string one = folder.file("one"), many = folder.file("many");
  {
    RecordWriter record(one, {{"seed", "7"}}, layout);
    for (std::int64_t i = 0; i < 600; ++i) write_tick(record, i);
    record.close();
  }
  for (const int every : {1, 150, 1000}) {
    RecordWriter record(many, {{"seed", "7"}}, layout, RecordWriter::kManyChunks);
    for (std::int64_t i = 0; i < 600; ++i) {
      write_tick(record, i);
      if (i % every == every - 1) record.drain();
    }
    record.close();
    EXPECT_EQ(record.error(), "");
    EXPECT_EQ(bytes_of(many), bytes_of(one)) << every;
  }
}

// Without a draining thread the record ends when all chunks are full and reports it. The file has all ticks
// so far.
TEST(RecordChunks, ADiskThatDoesNotKeepUpEndsTheRecordAndLeavesNoGap) {
  const test::TemporaryFolder folder;
  constexpr std::int64_t kChunks = 3;
  RecordWriter record(folder.file("slow"), {}, layout_hash(Scene()), kChunks);
  std::int64_t tick = 0;
  for (; tick < 2000 && !record.full(); ++tick) write_tick(record, tick);
  EXPECT_EQ(tick, record.ticks());
  EXPECT_EQ(tick % kChunks, 0) << "whole chunks";
  EXPECT_GE(tick, 150);
  EXPECT_LT(tick, 2000);
  EXPECT_THAT(record.error(), HasSubstr("the disk has not kept up with the run"));
  write_tick(record, tick);
  EXPECT_EQ(record.ticks(), tick) << "nothing more is taken";
  record.close();
  EXPECT_THROW(RecordReader(folder.file("slow")), Error) << "it is not the whole run";
  RecordReader reader(folder.file("slow"), PartialRead::yes);
  RecordedTick got;
  std::int64_t read = 0;
  for (; reader.next(got); ++read) ASSERT_EQ(got.tick.index, read);
  EXPECT_EQ(read, tick);
  EXPECT_FALSE(reader.sealed());
}

}  // namespace
}  // namespace enc
