// What of a record is said on which channel of an MCAP file, and what is left out.
#include "trial/mcap/record_mcap.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "tests/unit/trial/mcap/walked_mcap.h"
#include "trial/mcap/json_schema.h"

namespace enc::trial {
namespace {

using Json = nlohmann::json;
using test::McapCursor;
using ::testing::ElementsAre;

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
  for (const test::McapRecord& record : test::walked_mcap(file)) {
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

// Exports the ticks of a scene; what a test changes is in `ticks`.
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
// No two of its seven numbers are alike.
const Pose<'R', 'H'> kTurned(Quat(0.4, 0.2, -0.4, 0.8), Vec3(0.011, -0.023, 0.047));

TEST(RecordMcap, EachTickIsSaidWithItsTimeAndItsNumbers) {
  const models::Setup setup = ball_setup();
  std::vector<RecordedTick> ticks = ticks_of(setup, 40);
  ticks[7].in.wrench.value.force = Vec<'F'>(0.1, -2e-17, 1e300);
  ticks[12].in.tip.value.X_RH = ticks[13].out.tip = kTurned;
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
  expect_pose(read.topics.at("/command")[9].json, "R", ticks[9].out.tip);
  expect_pose(read.topics.at("/command")[13].json, "R", kTurned);
  expect_pose(read.topics.at("/tool")[0].json, "C", ticks[0].in.tool.value.X_CT);
  const Json& core = read.topics.at("/core")[9].json;
  EXPECT_EQ(core.at("tick"), ticks[9].tick.index);
  EXPECT_EQ(core.at("mode"), mode_name(ticks[9].out.mode));
  EXPECT_EQ(core.at("why"), why_text(ticks[9].out.why));
  EXPECT_EQ(core.at("gap_m").get<double>(), ticks[9].out.gap);
}

// A camera that stands anywhere, turned: parent and child taken for each other, or one way for the other, are
// seen.
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
  // About the fixed x, then y, then z, written out.
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
  const models::Setup arm = models::load(tests::source_dir() + "/models/scenes/wall.toml", "vishap", {});
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

// A log must not count one packet twice; a packet that names no tool, or is at fault, tells no pose.
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
  EXPECT_EQ(seen[0].publish, 0U);  // before the experiment began: MCAP knows no such time
  EXPECT_EQ(seen[1].publish, 2'999'500U);
  EXPECT_EQ(seen[1].log, static_cast<std::uint64_t>(ticks[9].tick.t.time_since_epoch().count()));
  EXPECT_EQ(seen[1].json.at("timestamp"), Json({{"sec", 0}, {"nsec", 2'999'500}}));
  EXPECT_EQ(seen[1].json.at("frame_id"), "C");
}

// So is a surface that was drawn; before the first there is none.
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

// JSON has no NaN. A pose with one cannot be drawn.
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

// Viewers take no list of types, and each field needs one of those that they know.
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

// A name may have any sign.
TEST(RecordMcap, NamesAndTextsAreQuoted) {
  models::Setup setup = ball_setup();
  setup.scene.objects.front().name = "a\"b\\c\n\x01 ä";
  std::vector<RecordedTick> ticks = ticks_of(setup, 1);
  ticks[0].out.object = 0;
  EXPECT_EQ(exported(setup, ticks).topics.at("/core")[0].json.at("object"), setup.scene.objects.front().name);
}

// Nothing that the record says of itself is lost; what was missed is counted.
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

// Texts that have one name, or that of something else that is said.
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

// Readers take a file with a text that is not UTF-8 for no MCAP file.
TEST(RecordMcap, TextsAreUtf8AndKeepTheirLines) {
  const std::vector<std::array<std::string, 2>> texts{
      {"models/caf\xE9.toml", "models/caf\\xe9.toml"},  // Latin-1
      {"caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8E\xBE", "caf\u00E9 \u20AC \U0001F3BE"},
      {"cut \xE2\x82", "cut \\xe2\\x82"},
      {"\x80\xC3(\xFF", "\\x80\\xc3(\\xff"},
      {"\xC0\xAF \xE0\x9F\xBF \xF0\x8F\xBF\xBF",  // longer than need be
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
