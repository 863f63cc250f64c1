// MCAP files: the writer byte by byte, and the contents for a record.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/support/scenes.h"
#include "tests/unit/trial/runs.h"
#include "trial/mcap/json.h"
#include "trial/mcap/mcap_writer.h"
#include "trial/mcap/record_mcap.h"

namespace enc::trial {
namespace {

using ::testing::ElementsAre;

// An MCAP file taken apart from front to back: its records in order, those of chunks in place.

constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

struct McapRecord {
  int op = 0;
  std::string content;
  std::size_t at = 0;  // offset in the file; for a record of a chunk: in its data
  bool in_chunk = false;
};

// Little-endian numbers and texts, one after the other.
class McapCursor {
 public:
  explicit McapCursor(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] bool more() const { return at_ < bytes_.size(); }
  [[nodiscard]] std::size_t at() const { return at_; }
  std::string_view take(std::size_t n) {
    if (n > bytes_.size() - at_) {
      ADD_FAILURE() << n << " bytes are wanted at " << at_ << " of " << bytes_.size();
      n = bytes_.size() - at_;
    }
    at_ += n;
    return bytes_.substr(at_ - n, n);
  }
  std::uint64_t number(std::size_t size) {
    std::uint64_t x = 0;
    const std::string_view bytes = take(size);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      x |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return x;
  }
  std::string text() { return std::string(take(number(4))); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

void walk_mcap(std::string_view bytes, bool in_chunk, std::vector<McapRecord>& records) {
  for (McapCursor cursor(bytes); cursor.more();) {
    const std::size_t at = cursor.at() + (in_chunk ? 0 : kMcapMagic.size());
    const int op = static_cast<int>(cursor.number(1));
    const std::string content(cursor.take(cursor.number(8)));
    records.push_back({op, content, at, in_chunk});
    if (op != 6) continue;
    McapCursor chunk(content);
    chunk.take(28);  // times, size and CRC
    EXPECT_EQ(chunk.text(), "") << "compressed";
    walk_mcap(chunk.take(chunk.number(8)), true, records);
  }
}
[[nodiscard]] inline std::vector<McapRecord> walked_mcap(std::string_view file) {
  std::vector<McapRecord> records;
  EXPECT_TRUE(file.starts_with(kMcapMagic) && file.ends_with(kMcapMagic));
  if (file.size() > 16) walk_mcap(file.substr(8, file.size() - 16), false, records);
  return records;
}

// The container of MCAP: its bytes, and that its indexes point to existing records.

std::string hex_of(std::string_view bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (const char c : bytes) {
    hex += kDigits[static_cast<unsigned char>(c) >> 4U];
    hex += kDigits[static_cast<unsigned char>(c) & 0xFU];
  }
  return hex;
}

// The check value of CRC-32 from the catalogues; the sum continues over pieces, wherever they are cut.
TEST(McapWriter, TheCrcIsThatOfZip) {
  EXPECT_EQ(crc32(""), 0U);
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  std::string bytes;
  for (int i = 0; i < 300; ++i) bytes += static_cast<char>(i * i);
  std::uint32_t one_by_one = 0;
  for (const char c : bytes) one_by_one = crc32({&c, 1}, one_by_one);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut)
    EXPECT_EQ(crc32(bytes.substr(cut), crc32(bytes.substr(0, cut))), one_by_one);
}

// Each field as in https://mcap.dev/spec, so that errors of writer and reader cannot cancel.
TEST(McapWriter, TheBytesOfATinyFile) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L");
  const std::uint16_t schema = writer.add_schema("S", "jsonschema", "{}");
  const std::uint16_t channel = writer.add_channel("/t", schema, "json");
  writer.message(channel, 5, 3, "{}");
  writer.attach("a", "t", "xyz");
  writer.metadata("m", {{"k", "v"}});
  writer.close();
  const std::string magic = "894d434150300d0a";
  const std::string schema_record =
      "031b00000000000000 0100 0100000053 0a0000006a736f6e736368656d61 020000007b7d";
  const std::string channel_record = "041600000000000000 0100 0100 020000002f74 040000006a736f6e 00000000";
  const std::vector<std::string> parts{
      magic,
      "010900000000000000 00000000 010000004c",  // header: no profile, library
      // attachment: times, name, kind, data, CRC
      "092900000000000000 0000000000000000 0000000000000000 0100000061 0100000074 030000000000000078797a "
      "d94e414b",
      "0c1300000000000000 010000006d 0a000000 010000006b 0100000076",  // metadata
      // chunk: first and last time, size, CRC, no compression, size
      "068c00000000000000 0500000000000000 0500000000000000 6400000000000000 ff4b03b8 00000000 "
      "6400000000000000",
      schema_record, channel_record,
      // message: channel, number, times, data
      "051800000000000000 0100 00000000 0500000000000000 0300000000000000 7b7d",
      "071600000000000000 0100 10000000 0500000000000000 4300000000000000",  // its place in the chunk
      "0f0400000000000000 7bf9c6ab",                                         // end of data, CRC
      schema_record, channel_record,
      // statistics: messages, schemas, channels, attachments, metadata, chunks, times, each channel's
      "0b3800000000000000 0100000000000000 0100 01000000 01000000 01000000 01000000 0500000000000000 "
      "0500000000000000 0a000000 0100 0100000000000000",
      // chunk index: times, place, size, indexes of messages and their size, no compression, sizes
      "084a00000000000000 0500000000000000 0500000000000000 6800000000000000 9500000000000000 0a000000 0100 "
      "fd00000000000000 1f00000000000000 00000000 6400000000000000 6400000000000000",
      // attachment index: place, size, times, size of the data, name, kind
      "0a3200000000000000 1a00000000000000 3200000000000000 0000000000000000 0000000000000000 "
      "0300000000000000 0100000061 0100000074",
      "0d1500000000000000 4c00000000000000 1c00000000000000 010000006d",  // metadata index
      // start of each kind of these, and its size
      "0e1100000000000000 03 2901000000000000 2400000000000000",
      "0e1100000000000000 04 4d01000000000000 1f00000000000000",
      "0e1100000000000000 0b 6c01000000000000 4100000000000000",
      "0e1100000000000000 08 ad01000000000000 5300000000000000",
      "0e1100000000000000 0a 0002000000000000 3b00000000000000",
      "0e1100000000000000 0d 3b02000000000000 1e00000000000000",
      "021400000000000000 2901000000000000 5902000000000000 3df64af0",  // footer: summary, offsets, CRC
      magic};
  std::string expected;
  for (const std::string& part : parts) expected += part;
  std::erase(expected, ' ');
  EXPECT_EQ(hex_of(file), expected);
}

// A chunk is full with the message that reaches its size; every index entry points to the right place.
TEST(McapWriter, ChunksAreOfTheirSizeAndIndexesNameWhatIsThere) {
  constexpr std::size_t kSize = 500;
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L", {.chunk = kSize});
  const std::uint16_t schema = writer.add_schema("S", "jsonschema", "{}");
  const std::uint16_t often = writer.add_channel("/often", schema, "json");
  const std::uint16_t seldom = writer.add_channel("/seldom", schema, "json");
  const std::uint16_t never = writer.add_channel("/never", schema, "json");
  for (std::uint64_t i = 0; i < 100; ++i) {
    writer.message(often, 10 * i, 10 * i, std::to_string(i));
    if (i % 40 == 39) writer.message(seldom, 10 * i, 10 * i - 7, "s");
  }
  writer.close();
  const std::vector<McapRecord> records = walked_mcap(file);
  std::size_t chunks = 0, messages = 0, entries = 0, indexes = 0;
  std::string chunk;
  for (const McapRecord& record : records) {
    McapCursor cursor(record.content);
    if (record.op == 6) {
      ++chunks;
      cursor.take(16);
      const std::size_t size = cursor.number(8);
      const auto crc = static_cast<std::uint32_t>(cursor.number(4));
      EXPECT_EQ(cursor.text(), "");
      chunk = std::string(cursor.take(cursor.number(8)));
      EXPECT_EQ(chunk.size(), size);
      EXPECT_EQ(crc32(chunk), crc);
      EXPECT_LT(chunk.size(), kSize + 40);  // at most one message more than its size
    } else if (record.op == 5) {
      ++messages;
      EXPECT_TRUE(record.in_chunk);
    } else if (record.op == 7) {  // behind its chunk
      const std::uint64_t channel = cursor.number(2);
      EXPECT_NE(channel, never);
      cursor.take(4);
      while (cursor.more()) {
        ++entries;
        const std::uint64_t time = cursor.number(8), at = cursor.number(8);
        McapCursor message(std::string_view(chunk).substr(at));
        EXPECT_EQ(message.number(1), 5U);
        message.take(8);
        EXPECT_EQ(message.number(2), channel);
        message.take(4);
        EXPECT_EQ(message.number(8), time);
      }
    } else if (record.op == 8) {
      ++indexes;
      cursor.take(16);
      const std::size_t at = cursor.number(8), size = cursor.number(8);
      EXPECT_EQ(file.at(at), 6);
      EXPECT_EQ(McapCursor(std::string_view(file).substr(at + 1)).number(8) + 9, size);
      for (McapCursor offsets(cursor.take(cursor.number(4))); offsets.more();) {
        const std::uint64_t channel = offsets.number(2), index = offsets.number(8);
        EXPECT_EQ(file.at(index), 7);
        EXPECT_EQ(McapCursor(std::string_view(file).substr(index + 9)).number(2), channel);
      }
    } else if (record.op == 14) {
      const std::uint64_t op = cursor.number(1), at = cursor.number(8), size = cursor.number(8);
      for (std::size_t i = at; i < at + size;) {
        EXPECT_EQ(static_cast<unsigned char>(file.at(i)), op);
        i += 9 + McapCursor(std::string_view(file).substr(i + 1)).number(8);
      }
    }
  }
  EXPECT_EQ(messages, 102U);
  EXPECT_EQ(entries, messages);
  EXPECT_GT(chunks, 5U);
  EXPECT_EQ(indexes, chunks);
}

// A record without a tick gives a file without a message; it is still a valid file, with its schemas.
TEST(McapWriter, AFileWithoutMessagesIsAFile) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L");
  EXPECT_EQ(writer.add_channel("/t", writer.add_schema("S", "jsonschema", "{}"), "json"), 1);
  writer.close();
  std::string ops;
  for (const McapRecord& record : walked_mcap(file)) ops += std::to_string(record.op) + " ";
  EXPECT_EQ(ops, "1 6 3 4 15 3 4 11 8 14 14 14 14 2 ");
}

// A long record is never in memory as a whole: full chunks are written before the end.
TEST(McapWriter, BytesLeaveAsChunksAreFull) {
  std::size_t bytes = 0, most = 0;
  McapWriter writer(
      [&](std::string_view piece) {
        bytes += piece.size();
        most = std::max(most, piece.size());
      },
      "L", {.chunk = 1000});
  const std::uint16_t channel = writer.add_channel("/t", writer.add_schema("S", "jsonschema", "{}"), "json");
  for (std::uint64_t i = 0; i < 1000; ++i) writer.message(channel, i, i, std::string(100, 'x'));
  EXPECT_GT(bytes, 120'000U);
  EXPECT_LT(most, 1200U);
  writer.close();
}

// The channel of an MCAP file for each part of a record, and the omitted parts.

using Json = nlohmann::json;

struct ReadMessage {
  std::uint64_t log = 0, publish = 0;
  Json json;
};
struct ReadMcap {
  std::map<std::string, std::vector<ReadMessage>> topics;  // those without messages, too
  std::map<std::string, Json> schemas;                     // by topic
  std::map<std::string, std::string> attachments, about;
};

ReadMcap read_back(const std::string& file) {
  ReadMcap read;
  std::map<std::uint64_t, std::string> topics;
  std::map<std::uint64_t, Json> schemas;
  for (const McapRecord& record : walked_mcap(file)) {
    McapCursor cursor(record.content);
    if (record.op == 3 && record.in_chunk) {
      const std::uint64_t number = cursor.number(2);
      const std::string name = cursor.text();
      EXPECT_EQ(cursor.text(), "jsonschema");
      schemas[number] = Json::parse(cursor.text());
      EXPECT_EQ(schemas[number].at("title"), name);
    } else if (record.op == 4 && record.in_chunk) {
      const std::uint64_t number = cursor.number(2), schema = cursor.number(2);
      topics[number] = cursor.text();
      read.topics[topics[number]];
      read.schemas[topics[number]] = schemas.at(schema);
      EXPECT_EQ(cursor.text(), "json");
    } else if (record.op == 5) {
      std::vector<ReadMessage>& all = read.topics.at(topics.at(cursor.number(2)));
      EXPECT_EQ(cursor.number(4), all.size());
      const std::uint64_t log = cursor.number(8), publish = cursor.number(8);
      all.push_back({log, publish, Json::parse(record.content.substr(cursor.at()))});
    } else if (record.op == 9) {
      cursor.take(16);
      const std::string name = cursor.text();
      (void)cursor.text();
      read.attachments[name] = std::string(cursor.take(cursor.number(8)));
    } else if (record.op == 12) {
      EXPECT_EQ(cursor.text(), "encounter");
      for (McapCursor pairs(cursor.take(cursor.number(4))); pairs.more();) {
        const std::string key = pairs.text();
        read.about[key] = pairs.text();
      }
    }
  }
  return read;
}

models::Setup ball_setup() {
  models::Setup setup;
  setup.scene = test::ball_scene();
  return setup;
}

// Export the ticks of a scene; a test changes them in `ticks`.
ReadMcap exported(const models::Setup& setup, const std::vector<RecordedTick>& ticks,
                  const RecordTexts& texts = {}, const RecordTexts& ends = {},
                  std::string_view state = "whole") {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L");
  const Scene scene = prepare(setup.scene, setup.rig);
  RecordMcap mcap(writer, setup, scene, texts);
  for (const RecordedTick& tick : ticks) mcap.add(tick);
  mcap.end(ends, state);
  return read_back(file);
}

std::vector<RecordedTick> ticks_of(const models::Setup& setup, int n) {
  test::Loop loop(prepare(setup.scene, setup.rig));
  std::vector<RecordedTick> ticks;
  for (int i = 0; i < n; ++i) {
    loop.tick();
    ticks.push_back({loop.k, loop.in, loop.out, 0});
  }
  return ticks;
}

std::vector<std::string> topics_of(const ReadMcap& read) {
  std::vector<std::string> topics;
  for (const auto& [topic, messages] : read.topics) topics.push_back(topic);
  return topics;
}

TEST(RecordMcap, OnlyWhatTheSceneHasIsAChannel) {
  models::Setup setup = ball_setup();
  const ReadMcap all = exported(setup, ticks_of(setup, 3));
  EXPECT_THAT(topics_of(all), ElementsAre("/command", "/core", "/frames", "/tip", "/tool", "/wrench"));
  EXPECT_EQ(all.schemas.at("/tool").at("title"), "foxglove.PoseInFrame");
  EXPECT_EQ(all.schemas.at("/frames").at("title"), "foxglove.FrameTransforms");
  setup.scene = test::rig_scene();
  EXPECT_FALSE(setup.scene.tracker.has_value());
  EXPECT_THAT(topics_of(exported(setup, ticks_of(setup, 3))),
              ElementsAre("/command", "/core", "/frames", "/tip", "/wrench"));
}

using Xyz = std::array<double, 3>;
using Xyzw = std::array<double, 4>;
Xyz xyz_of(const Json& json) { return {json.at("x"), json.at("y"), json.at("z")}; }
Xyzw xyzw_of(const Json& json) { return {json.at("x"), json.at("y"), json.at("z"), json.at("w")}; }

template <char A, char B>
void expect_pose(const Json& said, const char* frame, const Pose<A, B>& X) {
  EXPECT_EQ(said.at("frame_id"), frame);
  EXPECT_EQ(xyz_of(said.at("pose").at("position")), X.xyz);
  EXPECT_EQ(xyzw_of(said.at("pose").at("orientation")), X.xyzw);
}
// Its seven numbers are all different.
const Pose<'R', 'H'> kTurned(Quat(0.4, 0.2, -0.4, 0.8), Vec3(0.011, -0.023, 0.047));

TEST(RecordMcap, EachTickIsSaidWithItsTimeAndItsNumbers) {
  const models::Setup setup = ball_setup();
  std::vector<RecordedTick> ticks = ticks_of(setup, 40);
  ticks[7].in.wrench.value.force = Vec<'F'>(0.1, -2e-17, 1e300);
  ticks[12].in.tip.value.X_RH = ticks[13].out.manipulator.tip = kTurned;
  const ReadMcap read = exported(setup, ticks);
  for (const char* topic : {"/core", "/tip", "/command", "/wrench"}) {
    const std::vector<ReadMessage>& messages = read.topics.at(topic);
    ASSERT_EQ(messages.size(), ticks.size()) << topic;
    for (std::size_t i = 0; i < ticks.size(); ++i)
      EXPECT_EQ(messages[i].log, static_cast<std::uint64_t>(ticks[i].tick.t.time_since_epoch().count()));
  }
  EXPECT_EQ(read.topics.at("/frames").size(), 1U);
  const Json& force = read.topics.at("/wrench")[7].json.at("force_N");
  EXPECT_EQ(force.at("x").get<double>(), 0.1);
  EXPECT_EQ(force.at("y").get<double>(), -2e-17);
  EXPECT_EQ(force.at("z").get<double>(), 1e300);
  expect_pose(read.topics.at("/tip")[9].json, "R", ticks[9].in.tip.value.X_RH);
  expect_pose(read.topics.at("/tip")[12].json, "R", kTurned);
  expect_pose(read.topics.at("/command")[9].json, "R", ticks[9].out.manipulator.tip);
  expect_pose(read.topics.at("/command")[13].json, "R", kTurned);
  expect_pose(read.topics.at("/tool")[0].json, "C", ticks[0].in.tool.value.X_CT);
  const Json& core = read.topics.at("/core")[9].json;
  EXPECT_EQ(core.at("tick"), ticks[9].tick.index);
  EXPECT_EQ(core.at("mode"), mode_name(ticks[9].out.mode));
  EXPECT_EQ(core.at("why"), why_text(ticks[9].out.why));
  EXPECT_EQ(core.at("gap_m").get<double>(), ticks[9].out.gap);
}

// A camera at any place, turned: an exchange of parent and child, or of directions, shows.
TEST(RecordMcap, FramesAreWhereTheRigHasThem) {
  models::Setup setup = ball_setup();
  setup.rig.frames.W_C = {{0.3, -0.9, 0.6}, {-1.9, 0.2, 0.4}};
  const ReadMcap read = exported(setup, ticks_of(setup, 1));
  const Json& frames = read.topics.at("/frames").at(0).json.at("transforms");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].at("parent_frame_id"), "W");
  EXPECT_EQ(frames[0].at("child_frame_id"), "R");
  const Scene scene = prepare(setup.scene, setup.rig);
  EXPECT_NE(scene.X_WR.xyz[2], 0.0);
  EXPECT_EQ(xyz_of(frames[0].at("translation")), scene.X_WR.xyz);
  EXPECT_EQ(xyzw_of(frames[0].at("rotation")), scene.X_WR.xyzw);
  EXPECT_EQ(frames[1].at("parent_frame_id"), "W");
  EXPECT_EQ(frames[1].at("child_frame_id"), "C");
  // Rotations about the fixed x, then y, then z, written out.
  const Quat q_WC = Quat(std::cos(0.2), 0, 0, std::sin(0.2)) * Quat(std::cos(0.1), 0, std::sin(0.1), 0) *
                    Quat(std::cos(-0.95), std::sin(-0.95), 0, 0);
  const Xyzw said = xyzw_of(frames[1].at("rotation"));
  const double sign = said[3] * q_WC.w() < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(sign * said[i], q_WC.coeffs()[static_cast<Eigen::Index>(i)], 1e-15) << i;
  EXPECT_EQ(xyz_of(frames[1].at("translation")), (Xyz{0.3, -0.9, 0.6}));
}

// Before its first reading a device has no time of its own, and 0 would be one.
TEST(RecordMcap, WhatADeviceHasNotSaidYetHasNoStamp) {
  models::Setup gripper = ball_setup();
  gripper.scene.tools.push_back(gripper.scene.tools.front());
  gripper.scene.tools.back().name = "clamped";
  gripper.scene.gripper.emplace().tool = "clamped";
  const models::Setup arm = test::shipped("wall", {}, "vishap");
  const auto check = [](const models::Setup& setup, const char* topic, auto device) {
    std::vector<RecordedTick> ticks(2);
    for (std::int64_t i = 0; i < 2; ++i) ticks[static_cast<std::size_t>(i)].tick.t = Time(Duration(5 + i));
    (ticks[1].in.*device).health = Health::ok;
    (ticks[1].in.*device).t = Time(Duration(3));
    const std::vector<ReadMessage> said = exported(setup, ticks).topics.at(topic);
    ASSERT_EQ(said.size(), 2U) << topic;
    EXPECT_EQ(said[0].json.at("health"), "absent") << topic;
    EXPECT_FALSE(said[0].json.contains("stamp_s")) << topic;
    EXPECT_EQ(said[0].publish, 5U) << topic;
    EXPECT_EQ(said[1].json.at("stamp_s").get<double>(), 3e-9) << topic;
    EXPECT_EQ(said[1].publish, 3U) << topic;
  };
  check(gripper, "/wrench", &Inputs::wrench);
  check(gripper, "/gripper", &Inputs::grip);
  check(arm, "/arm", &Inputs::arm);
}

// A log must not count one packet twice; a packet without a tool, or with a fault, has no pose.
TEST(RecordMcap, APacketOfTheTrackerIsOneMessage) {
  const models::Setup setup = ball_setup();
  std::vector<RecordedTick> ticks = ticks_of(setup, 12);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ticks[i].in.tool.t = Time(Duration(1'000'000 * static_cast<std::int64_t>(i / 3) - 500));
    if (i / 3 == 1) ticks[i].in.tool.value.tool = -1;
    if (i / 3 == 2) ticks[i].in.tool.health = Health::fault;
  }
  const std::vector<ReadMessage> seen = exported(setup, ticks).topics.at("/tool");
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].publish, 0U);  // before the start of the experiment: MCAP has no such time
  EXPECT_EQ(seen[1].publish, 2'999'500U);
  EXPECT_EQ(seen[1].log, static_cast<std::uint64_t>(ticks[9].tick.t.time_since_epoch().count()));
  EXPECT_EQ(seen[1].json.at("timestamp"), Json({{"sec", 0}, {"nsec", 2'999'500}}));
  EXPECT_EQ(seen[1].json.at("frame_id"), "C");
}

// A drawn surface is also one message; before the first there is no message.
TEST(RecordMcap, ASurfaceThatWasDrawnIsOneMessage) {
  models::Setup setup;
  setup.scene = test::two_balls();
  std::vector<RecordedTick> ticks = ticks_of(setup, 10);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    DentSample dent;
    dent.object = 1;
    dent.depth = 1e-3 * static_cast<double>(i / 4);
    ticks[i].in.dent = {dent, Time(Duration(16'000'000 * static_cast<std::int64_t>(i / 4))),
                        i < 4 ? Health::absent : Health::ok};
  }
  const std::vector<ReadMessage> drawn = exported(setup, ticks).topics.at("/surface");
  ASSERT_EQ(drawn.size(), 2U);
  EXPECT_EQ(drawn[1].publish, 32'000'000U);
  EXPECT_EQ(drawn[1].json.at("object"), setup.scene.objects.at(1).name);
  EXPECT_EQ(drawn[1].json.at("depth_m").get<double>(), 2e-3);
}

// JSON has no NaN, and a viewer cannot draw a pose that contains one.
TEST(RecordMcap, WhatIsNotKnownIsLeftOut) {
  const models::Setup setup = ball_setup();
  std::vector<RecordedTick> ticks = ticks_of(setup, 2);
  ticks[0].in.wrench.value.force = Vec<'F'>(1.0, kUnset, std::numeric_limits<double>::infinity());
  ticks[0].in.wrench.value.torque = Vec<'F'>();
  ticks[0].in.wrench.health = static_cast<Health>(77);
  ticks[0].in.tip.value.X_RH.xyz[1] = kUnset;
  ticks[0].out.gap = kUnset;
  ticks[0].out.mode = static_cast<Mode>(99);
  ticks[0].out.object = 5;
  const ReadMcap read = exported(setup, ticks);
  const Json& wrench = read.topics.at("/wrench")[0].json;
  EXPECT_EQ(wrench.at("force_N"), Json({{"x", 1.0}}));
  EXPECT_FALSE(wrench.contains("torque_Nm"));
  EXPECT_EQ(wrench.at("health"), "unknown");
  EXPECT_EQ(read.topics.at("/tip").size(), 1U);
  const Json& core = read.topics.at("/core")[0].json;
  EXPECT_FALSE(core.contains("gap_m") || core.contains("object"));
  EXPECT_EQ(core.at("mode"), "unknown");
  EXPECT_EQ(read.topics.at("/core")[1].json.at("mode"), mode_name(ticks[1].out.mode));
}

// Viewers accept no list of types, and each field needs one of the types that they support.
void expect_plain(const Json& schema, const std::string& at) {
  ASSERT_TRUE(schema.at("type").is_string()) << at;
  const std::string type = schema.at("type");
  EXPECT_THAT(type, ::testing::AnyOf("object", "array", "number", "integer", "boolean", "string")) << at;
  if (type == "array") expect_plain(schema.at("items"), at + "[]");
  if (type != "object") return;
  for (const auto& [name, field] : schema.at("properties").items()) expect_plain(field, at + "." + name);
}
TEST(RecordMcap, SchemasHaveOneTypeForEachField) {
  const models::Setup setup = ball_setup();
  for (const auto& [topic, schema] : exported(setup, {}).schemas) expect_plain(schema, topic);
}

// A name may contain any character.
TEST(RecordMcap, NamesAndTextsAreQuoted) {
  models::Setup setup = ball_setup();
  setup.scene.objects.front().name = "a\"b\\c\n\x01 ä";
  std::vector<RecordedTick> ticks = ticks_of(setup, 1);
  ticks[0].out.object = 0;
  EXPECT_EQ(exported(setup, ticks).topics.at("/core")[0].json.at("object"), setup.scene.objects.front().name);
}

// The file keeps all information of the record, and counts missed ticks.
TEST(RecordMcap, TheFileSaysWhatTheRunWas) {
  const models::Setup setup = ball_setup();
  std::vector<RecordedTick> ticks = ticks_of(setup, 5);
  ticks[2].in.missed = 3;
  ticks[4].in.missed = 1;
  const std::string mesh("\0\xFF\x80", 3);
  const ReadMcap read =
      exported(setup, ticks, {{"resolved", "format = 1\n"}, {"mesh:a.glb", mesh}, {"seed", "7"}},
               {{"ledger", "contact\n"}, {"weather", "rain"}});
  EXPECT_EQ(read.attachments,
            (std::map<std::string, std::string>{
                {"ledger.csv", "contact\n"}, {"mesh:a.glb", mesh}, {"resolved.toml", "format = 1\n"}}));
  EXPECT_EQ(
      read.about,
      (std::map<std::string, std::string>{
          {"missed_cycles", "4"}, {"seed", "7"}, {"state", "whole"}, {"ticks", "5"}, {"weather", "rain"}}));
}

// Several texts with one name, or with the name of another entry.
TEST(RecordMcap, NoTextTakesThePlaceOfAnother) {
  const ReadMcap read = exported(ball_setup(), {}, {{"seed", "7"}, {"state", "wet"}, {"a\xE8", "1"}},
                                 {{"seed", "8"}, {"a\\xe8", "2"}});
  EXPECT_EQ(read.about, (std::map<std::string, std::string>{{"a\\xe8", "1"},
                                                            {"a\\xe8'", "2"},
                                                            {"missed_cycles", "0"},
                                                            {"seed", "7"},
                                                            {"seed'", "8"},
                                                            {"state", "whole"},
                                                            {"state'", "wet"},
                                                            {"ticks", "0"}}));
}

// Readers reject an MCAP file with a text that is not UTF-8.
TEST(RecordMcap, TextsAreUtf8AndKeepTheirLines) {
  const std::vector<std::array<std::string, 2>> texts{
      {"models/caf\xE9.toml", "models/caf\\xe9.toml"},  // Latin-1
      {"caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8E\xBE", "caf\u00E9 \u20AC \U0001F3BE"},
      {"cut \xE2\x82", "cut \\xe2\\x82"},
      {"\x80\xC3(\xFF", "\\x80\\xc3(\\xff"},
      {"\xC0\xAF \xE0\x9F\xBF \xF0\x8F\xBF\xBF",  // longer than necessary
       "\\xc0\\xaf \\xe0\\x9f\\xbf \\xf0\\x8f\\xbf\\xbf"},
      {"\xED\xA0\x80 \xF4\x90\x80\x80 \xF5",  // half of a pair; beyond the last letter
       "\\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80 \\xf5"},
      {"\xED\x9F\xBF \xEE\x80\x80 \xF4\x8F\xBF\xBF", "\uD7FF \uE000 \U0010FFFF"},
      {"wall stable\n ball\tstable\r\n", "wall stable\n ball\\tstable\\r\n"},
      {"\n\n", "\n\n"},
  };
  for (const auto& [text, said] : texts) {
    EXPECT_EQ(exported(ball_setup(), {}, {{"stability", text}}).about.at("stability"), said) << said;
    EXPECT_EQ(exported(ball_setup(), {}, {}, {}, text).about.at("state"), said) << said;
  }
  EXPECT_EQ(exported(ball_setup(), {}, {{"mesh:caf\xE9\n.glb", "m"}}).attachments,
            (std::map<std::string, std::string>{{"mesh:caf\\xe9\\n.glb", "m"}}));
}

}  // namespace
}  // namespace enc::trial
