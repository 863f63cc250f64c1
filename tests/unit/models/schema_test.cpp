// The schema and its visitors: units, names, --set, the resolved text.
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/calibration_files.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using test::replaced;
using testing::AllOf;
using ::testing::HasSubstr;
using testing::HasSubstr, testing::StartsWith;

std::string source(const std::string& path) { return tests::source_dir() + "/" + path; }

// The committed scenes without the measured curve, so that these tests need no generated file.
models::Setup plane() { return load(source("models/scenes/plane.toml"), "sim"); }

models::Setup full() {
  models::Setup s = plane();
  s.scene.title = "A \"title\" with \\ and \\n, caf\xC3\xA9";
  s.scene.objects[0].limit = 0.003;
  ObjectSpec ball;
  ball.name = "ball";
  ball.radius = 0.033;
  ball.position = {0, 0, -0.02};
  ball.behaviour = "wall";
  s.scene.objects.push_back(ball);
  ObjectSpec hare;
  hare.name = "hare";
  hare.shape = ShapeKind::mesh;
  hare.behaviour = "wall";
  hare.mesh = "hare.glb";
  s.scene.objects.push_back(hare);
  s.scene.display.emplace();
  s.scene.questionnaire = QuestionnaireSpec{"vhmr_2020"};
  s.scene.user->approach = {0.01, 0.02, 0.05};
  s.scene.behaviours[0].curves = {
      {1.0 / 3.0 * 1e3, -2.0 / 7.0 * 1e6, 1e9 / 9.0, 0.0}, {600, 0, 0, 1e12}, 0.006};
  s.scene.behaviours[0].curves.stops = StopsSpec{{6.0, 1.0 / 3.0, -2.5}, {0.2e-3, 1e-3 / 3.0}, {900.0, 0.0}};
  s.twin.tracker.blackout_at = 10.0;
  round_to_text(s);
  return s;
}

// Number of members of an aggregate: the longest list that can initialise it.
struct AnyValue {
  template <class T>
  operator T() const {  // NOLINT(google-explicit-constructor)
    std::abort();
  }
};
template <class T, class... Args>
constexpr std::size_t members() {
  if constexpr (requires { T{Args{}..., AnyValue{}}; }) {
    return members<T, Args..., AnyValue>();
  } else {
    return sizeof...(Args);
  }
}

// Counts the described members of each table; tables and lists in it count as one.
class Levels final : public Visitor {
 public:
  std::map<std::string, std::size_t> found;
  void value(const Key&, const Target&) override { ++found[paths_.back()]; }
  bool open(std::string_view table, bool present) override {
    ++found[paths_.back()];
    if (present) push(table);
    return present;
  }
  std::size_t open_list(std::string_view, std::size_t size) override {
    ++found[paths_.back()];
    return size;
  }
  void open_entry(std::string_view list, std::size_t, std::string_view name) override {
    push(std::string(list) + "." + std::string(name));
    found[paths_.back()] = 0;
  }
  void close() override { paths_.pop_back(); }
  void drivers(std::string_view, std::vector<DriverTable>&) override { ++found[paths_.back()]; }

 private:
  void push(std::string_view name) {
    paths_.push_back(paths_.back().empty() ? std::string(name) : paths_.back() + "." + std::string(name));
  }
  std::vector<std::string> paths_{""};
};

// A member without a description could be neither set nor recorded.
TEST(Schema, describes_every_member) {
  models::Setup s = full();
  Levels levels;
  describe_all(levels, s.scene, s.rig, s.twin);
  auto& n = levels.found;
  // Rig and truth are extra tables. Each base has one: [probe] and [travel].
  EXPECT_EQ(n[""], members<SceneSpec>() + 2);
  EXPECT_EQ(n["object.ball"], members<ObjectSpec>() - 11);  // no normal, nothing of mesh, button or box
  EXPECT_EQ(n["object.wall"], members<ObjectSpec>() - 11);  // no radius, nothing of mesh, button or box
  // A mesh has no keys of other shapes; its triangles and its file's material are data.
  EXPECT_EQ(n["object.hare"], members<ObjectSpec>() - 8);
  EXPECT_EQ(n["tool.stylus"], members<ToolSpec>() - 3);  // a sphere has no axis, angle or edge
  EXPECT_EQ(n["follow"], members<FollowSpec>());
  EXPECT_EQ(n["user"], members<UserSpec>());
  EXPECT_EQ(n["questionnaire"], members<QuestionnaireSpec>());
  EXPECT_EQ(n["behaviour.wall"], members<BehaviourSpec>());
  EXPECT_EQ(n["behaviour.wall.curves"], members<ResponseSpec>());
  EXPECT_EQ(n["behaviour.wall.curves.stops"], members<StopsSpec>());
  EXPECT_EQ(n["rig"], members<RigSpec>());
  EXPECT_EQ(n["rig.loop"], members<LoopRig>());
  EXPECT_EQ(n["rig.frames"], members<FramesRig>());
  EXPECT_EQ(n["rig.frames.W_C"], members<PoseSpec>());
  EXPECT_EQ(n["rig.manipulator"], members<ManipulatorRig>());
  EXPECT_EQ(n["rig.manipulator.geometry"], members<HexapodGeometry>());
  EXPECT_EQ(n["rig.force"], members<ForceRig>());
  EXPECT_EQ(n["rig.tracker"], members<TrackerRig>());
  EXPECT_EQ(n["rig.display"], members<DisplayRig>());
  EXPECT_EQ(n["rig.gripper"], members<GripperRig>());
  EXPECT_EQ(n["rig.contact"], members<ContactRig>());
  EXPECT_EQ(n["rig.admittance"], members<AdmittanceRig>());
  EXPECT_EQ(n["truth"], members<sim::TwinSpec>());
  EXPECT_EQ(n["truth.world"], members<sim::WorldTruth>());
  EXPECT_EQ(n["truth.hexapod"], members<sim::HexapodTruth>());
  EXPECT_EQ(n["truth.structure"], members<sim::StructureTruth>());
  EXPECT_EQ(n["truth.gripper"], members<sim::GripperTruth>());
  EXPECT_EQ(n["truth.force"], members<sim::ForceTruth>());
  EXPECT_EQ(n["truth.tracker"], members<sim::TrackerTruth>());
  EXPECT_EQ(n["truth.display"], members<sim::DisplayTruth>());
  EXPECT_EQ(n["truth.contact"], members<sim::ContactTruth>());
  EXPECT_EQ(n["truth.hand"], members<sim::HandTruth>());
}

TEST(Units, come_from_the_suffix_longest_first) {
  EXPECT_EQ(unit_of("radius_mm").label, "mm");
  EXPECT_EQ(unit_of("speed_mm_s").label, "mm/s");
  EXPECT_EQ(unit_of("acceleration_m_s2").label, "m/s^2");
  EXPECT_EQ(unit_of("press_N_per_mm_k").label, "N/mm^k");
  EXPECT_EQ(unit_of("drift_N_per_sqrt_s").label, "N/sqrt(s)");
  EXPECT_EQ(unit_of("damping").label, "");
  EXPECT_EQ(stem_of("approach_mm_s"), "approach");
  EXPECT_EQ(stem_of("_mm"), "_mm");  // a suffix alone is a name
}

TEST(Units, convert_by_moving_the_decimal_point) {
  EXPECT_EQ(to_si(unit_of("x_mm"), 0.0779),
            0.0779e-3);  // 0.0779 * 1e-3 and 0.0779 / 1e3 may differ in the last bit
  EXPECT_EQ(to_si(unit_of("x_mm"), 33), 0.033);
  EXPECT_EQ(to_si(unit_of("x_um"), 3), 3e-6);
  EXPECT_EQ(to_si(unit_of("x_us"), 1000), 0.001);
  EXPECT_EQ(to_si(unit_of("x_N_per_mm"), 0.3), 300.0);
  EXPECT_EQ(to_si(unit_of("x_deg"), 180), M_PI);
  EXPECT_EQ(to_si(unit_of("x_N_per_mm_k"), 2.5, 4), 2.5e12);  // N/mm^4
  EXPECT_TRUE(std::isinf(to_si(unit_of("x_N_per_mm"), 1e308)));
  EXPECT_EQ(to_si(unit_of("x_mm"), -0.0), 0.0);
}

TEST(Units, text_is_short_and_comes_back) {
  EXPECT_EQ(text_of(unit_of("x_mm"), 0.0779e-3), "0.0779");
  EXPECT_EQ(text_of(unit_of("x_deg"), 22.0 * M_PI / 180.0), "22");
  EXPECT_EQ(text_of(unit_of("x_mm"), -0.02), "-20");
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> size(-12.0, 12.0);
  for (int i = 0; i < 20000; ++i) {
    for (const char* key : {"x_mm", "x_deg", "x_N_per_mm", "x_us", "x"}) {
      const Unit& unit = unit_of(key);
      const double si = to_si(unit, std::pow(10.0, size(random)));
      const std::string text = text_of(unit, si);
      ASSERT_EQ(to_si(unit, std::stod(text)), si) << key << " " << text;
      ASSERT_EQ(text_of(unit, to_si(unit, std::stod(text))), text);
    }
  }
}

TEST(NearestName, knows_misspelt_words_and_other_units) {
  const std::vector<std::string> names{"name", "radius_mm", "position_mm", "limit_mm", "stiffness_N_per_mm"};
  EXPECT_EQ(nearest_name("radius_cm", names), "radius_mm");
  EXPECT_EQ(nearest_name("radius", names), "radius_mm");
  EXPECT_EQ(nearest_name("Radius_mm", names), "radius_mm");
  EXPECT_EQ(nearest_name("stifness_N_per_mm", names), "stiffness_N_per_mm");
  EXPECT_EQ(nearest_name("stiffness_N_per_m", names), "stiffness_N_per_mm");
  EXPECT_EQ(nearest_name("colour", names), "");
  EXPECT_THAT(advice("colour", names), HasSubstr("'name', 'radius_mm'"));
}

TEST(UnitFactors, are_between_units_of_one_kind_and_one_stem) {
  EXPECT_DOUBLE_EQ(factor_between("tip_m", "tip_mm").value(), 1000.0);
  EXPECT_DOUBLE_EQ(factor_between("tip_mm", "tip_m").value(), 0.001);
  EXPECT_DOUBLE_EQ(factor_between("radius_cm", "radius_mm").value(), 10.0);
  EXPECT_DOUBLE_EQ(factor_between("stiffness_N_per_m", "stiffness_N_per_mm").value(), 0.001);
  EXPECT_DOUBLE_EQ(factor_between("polar_rad", "polar_deg").value(), 180.0 / M_PI);
  EXPECT_DOUBLE_EQ(factor_between("mass_g", "mass_kg").value(), 0.001);
  EXPECT_DOUBLE_EQ(factor_between("force_N", "force_N").value(), 1.0);
  EXPECT_FALSE(factor_between("tip_s", "tip_mm"));
  EXPECT_FALSE(factor_between("tip_m", "top_mm"));
  EXPECT_FALSE(factor_between("tip", "tip_mm"));
  // Count each unit of a key, so that none is forgotten.
  for (const char* unit : {"_mm_s2", "_m_s2", "_mm_s", "_m_s", "_deg", "_MPa", "_kPa", "_mm", "_um", "_ms",
                           "_us", "_hz", "_kg", "_N", "_s", "_m", "_N_per_mm", "_N_per_m", "_N_per_um"})
    EXPECT_DOUBLE_EQ(factor_between("x" + std::string(unit), "x" + std::string(unit)).value(), 1.0) << unit;
}

TEST(NearestName, another_unit_comes_with_its_factor) {
  EXPECT_EQ(unknown_text("[[tool]]", "tip_m", {"name", "tip_mm"}),
            "unknown key 'tip_m'; expected the unit mm; did you mean 'tip_mm'? then multiply by 1000");
  EXPECT_EQ(unknown_text("[[tool]]", "mass_g", {"name", "mass_kg"}),
            "unknown key 'mass_g'; expected the unit kg; did you mean 'mass_kg'? then multiply by 0.001");
  EXPECT_EQ(unknown_text("[[tool]]", "tip", {"name", "tip_mm"}),
            "unknown key 'tip'; expected the unit mm; did you mean 'tip_mm'?");
}

TEST(Resolved, reads_back_to_the_same_text) {
  for (const models::Setup& setup : {plane(), full()}) {
    const std::string text = resolved(setup);
    EXPECT_EQ(resolved(parse_resolved(text, "resolved")), text);
  }
}

TEST(Resolved, reads_back_to_the_same_bits) {
  const models::Setup a = full(), b = parse_resolved(resolved(a), "resolved");
  EXPECT_EQ(a.scene.title, b.scene.title);
  EXPECT_EQ(a.scene.objects[1].radius, b.scene.objects[1].radius);
  EXPECT_EQ(a.scene.behaviours[0].curves.press, b.scene.behaviours[0].curves.press);
  EXPECT_EQ(a.scene.behaviours[0].curves.release, b.scene.behaviours[0].curves.release);
  ASSERT_TRUE(b.scene.behaviours[0].curves.stops);
  EXPECT_EQ(a.scene.behaviours[0].curves.stops->curve, b.scene.behaviours[0].curves.stops->curve);
  EXPECT_EQ(a.scene.behaviours[0].curves.stops->radii, b.scene.behaviours[0].curves.stops->radii);
  EXPECT_EQ(a.scene.behaviours[0].curves.stops->weights, b.scene.behaviours[0].curves.stops->weights);
  EXPECT_EQ(a.scene.user->approach_tilt, b.scene.user->approach_tilt);
  EXPECT_EQ(a.rig.frames.W_C.position, b.rig.frames.W_C.position);
  EXPECT_EQ(a.twin.hexapod.geometry.base_half_angle, b.twin.hexapod.geometry.base_half_angle);
  EXPECT_EQ(a.twin.tracker.bias, b.twin.tracker.bias);
}

// A defect of a polynomial's text would only show in rare digits.
TEST(Resolved, random_numbers_survive) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  models::Setup setup = full();
  for (int i = 0; i < 20; ++i) {
    for (double& a : setup.scene.behaviours[0].curves.press) a = 1e7 * number(random);
    setup.scene.objects[1].position = Vec3(number(random), number(random), number(random));
    setup.rig.frames.W_C.rotation = Vec3(number(random), number(random), number(random));
    round_to_text(setup);
    const models::Setup again = parse_resolved(resolved(setup), "resolved");
    EXPECT_EQ(resolved(again), resolved(setup));
    EXPECT_EQ(again.scene.behaviours[0].curves.press, setup.scene.behaviours[0].curves.press);
    EXPECT_EQ(again.rig.frames.W_C.rotation, setup.rig.frames.W_C.rotation);
  }
}

TEST(Resolved, says_no_less_than_the_files) {
  const std::string text = resolved(plane());
  for (const char* part :
       {"[[object]]", "[follow]", "[force]", "[behaviour.curves]", "press_N_per_mm_k = [2, 0, 0, 0]",
        "[rig.manipulator.geometry]", "[truth.tracker]", "bias_mm = [0.0779, 0.0659, 0.1192]"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("[display]")));
}

TEST(Parameters, each_can_be_set_to_its_own_value) {
  const models::Setup setup = full();
  const std::string text = resolved(setup);
  const std::vector<Parameter> all = parameters(setup);
  EXPECT_GT(all.size(), 120U);
  for (const Parameter& p : all) {
    models::Setup copy = setup;
    ASSERT_NO_THROW(set(copy, p.name + "=" + p.value)) << p.name << "=" << p.value;
    EXPECT_EQ(resolved(copy), text) << p.name << "=" << p.value;
  }
}

TEST(Parameters, each_is_named_once_and_described) {
  std::set<std::string> names;
  for (const Parameter& p : parameters(full())) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_FALSE(p.source.empty() || p.confidence.empty() || p.meaning.empty()) << p.name;
    EXPECT_EQ(p.meaning.find('\n'), std::string::npos) << p.name;
  }
  EXPECT_TRUE(names.contains("object.ball.radius_mm") && names.contains("rig.force.filter_hz") &&
              names.contains("truth.world.timestep_us") &&
              names.contains("behaviour.wall.stiffness_N_per_mm"));
}

TEST(Set, changes_what_it_names) {
  models::Setup s = full();
  for (const char* text :
       {"object.ball.radius_mm=30", "rig.force.filter_hz=20", "truth.tracker.bias_mm=[0, 0, 0.5]",
        "user.approach_mm_s=[10]", "rig.force.tare=start", "title=two words", "user.push_N=30",
        "truth.tracker.blackout_at_s=unset"}) {
    set(s, text);
  }
  EXPECT_EQ(s.scene.objects[1].radius, 0.030);
  EXPECT_EQ(s.rig.force.filter, 20.0);
  EXPECT_EQ(s.twin.tracker.bias, Vec3(0, 0, 0.0005));
  EXPECT_EQ(s.scene.user->approach, std::vector<double>{0.01});
  EXPECT_EQ(s.rig.force.tare, Tare::start);
  EXPECT_EQ(s.scene.title, "two words");
  EXPECT_EQ(s.scene.user->push, 30.0);
  EXPECT_TRUE(std::isnan(s.twin.tracker.blackout_at));
  EXPECT_EQ(place_of(s, "object.ball.radius"), "--set object.ball.radius_mm=30");
}

TEST(Set, refuses_in_one_line_that_begins_with_the_words_given) {
  models::Setup s = full();
  const auto refuse = [&](const std::string& text) { return test::refusal([&] { set(s, text); }); };
  EXPECT_THAT(refuse("object.ball.radius_mm"), HasSubstr("there is no value"));
  EXPECT_THAT(refuse("object.ball.radius_cm=3"), HasSubstr("did you mean 'object.ball.radius_mm'?"));
  EXPECT_THAT(refuse("object.bal.radius_mm=3"), HasSubstr("did you mean 'object.ball.radius_mm'?"));
  EXPECT_THAT(refuse("timestep_us=125"), HasSubstr("did you mean 'truth.world.timestep_us'?"));
  EXPECT_THAT(refuse("object.ball.name=x"), HasSubstr("unknown parameter"));
  EXPECT_EQ(refuse("object.ball.radius_mm=-3"),
            "--set object.ball.radius_mm=-3: 'radius_mm' is -3; expected a positive number in mm (radius of "
            "the sphere); "
            "write it like 'radius_mm = 1.5'");
  EXPECT_THAT(refuse("object.ball.radius_mm=unset"), HasSubstr("'unset' is no value"));
  EXPECT_THAT(refuse("object.ball.radius_mm=1\nx=2"), HasSubstr("is no value"));
  EXPECT_THAT(refuse("truth.world.timestep_us=6000"), HasSubstr("above 0 and at most 5000 in us"));
}

// A locale with a decimal comma must not read "33.5" as 33. In SI it would be 0, which the key refuses.
TEST(Set, refuses_what_is_lost_in_si) {
  models::Setup s = plane();
  EXPECT_THAT(test::refusal([&] { set(s, "user.depth_mm=5e-324"); }),
              HasSubstr("is 5e-324; expected 0, or a number of 1e-300 or more"));
  EXPECT_NO_THROW(set(s, "user.depth_mm=1e-300"));
}
TEST(Set, shows_what_it_was_given_on_one_line) {
  models::Setup s = plane();
  EXPECT_THAT(test::refusal([&] { set(s, "a\nb=1"); }),
              HasSubstr("--set a\\nb=1: unknown parameter 'a\\nb'"));
  EXPECT_THAT(test::refusal([&] { set(s, "a\nb"); }), HasSubstr("--set a\\nb: there is no value"));
}

TEST(Locale, does_not_matter) {
  const std::string text = resolved(full());
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"", "de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    EXPECT_EQ(resolved(full()), text) << name;
    EXPECT_EQ(resolved(parse_resolved(text, "resolved")), text) << name;
  }
  std::setlocale(LC_ALL, before.c_str());
}

// The file shows every value, and each equals the default in code, so both agree.
TEST(SimRig, is_what_the_structs_say) {
  models::Setup file = plane(), code = plane();
  code.rig = RigSpec{};
  code.rig.title = file.rig.title;
  code.twin = sim::TwinSpec{};
  code.twin.tracker.marker_noise = 0.003e-3;  // unset in the struct: a tool need not have markers
  code.rig.tracker.rate = 100.0;              // unset in the struct: a tracker need not have a rate
  round_to_text(code);
  EXPECT_EQ(resolved(file), resolved(code));
}

TEST(ResponseFile, is_written_as_it_is_read) {
  const ResponseSpec response{{600.0, 4e5, -1e8 / 3.0, 1e10}, {300.0, 2e5, 0.0, 1e10}, 0.006};
  const std::string path = ::testing::TempDir() + "response_test.toml";
  const std::string text = response_text(response, "a \"test\"");
  std::ofstream(path) << text;
  const ResponseSpec again = load_response(path);
  EXPECT_EQ(response_text(again, "a \"test\""), text);
  EXPECT_EQ(again.release, response.release);
  EXPECT_EQ(again.limit, response.limit);
  fs::remove(path);
}

// Words of a file that are printed on a terminal.

TEST(Wording, WhatATerminalObeysIsShownInLetters) {
  EXPECT_EQ(printable("left\033[2J\r\n\t01\x7F.png"), "left\\x1b[2J\\r\\n\\t01\\x7f.png");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("a\u009b31m"), "a\\u009b31m");  // a second introducer of terminal sequences
  EXPECT_EQ(printable("a\x9B 31m"), "a\\x9b 31m");    // and as one byte
  for (const auto& [letter, shown] : {std::pair{"\u2028", "\\u2028"},
                                      {"\u202e", "\\u202e"},
                                      {"\u2066", "\\u2066"},
                                      {"\u2069", "\\u2069"},
                                      {"\u200f", "\\u200f"}})
    EXPECT_EQ(printable(letter), shown);
  for (const char* plain : {"H\u00e4nde \u00b5m \u2026 \u2212 \U0001F3BE", "a\\b", ""})
    EXPECT_EQ(printable(plain), plain);
  EXPECT_EQ(printable("'\xC2' is \xE2\x80"),
            "'\\xc2' is \\xe2\\x80");  // half a letter; the text behind it stays
  EXPECT_EQ(printable("\xC0\x8A\xED\xA0\x80"),
            "\\xc0\\x8a\\xed\\xa0\\x80");  // letters that are invalid in UTF-8
  EXPECT_EQ(quoted("a\nb"), "'a\\nb'");
  EXPECT_EQ(quoted(std::string(79, 'x') + "\u00e4y"), "'" + std::string(79, 'x') + "...'");
}

TEST(Wording, NamesOfAFileAreShownAsTheyMayBe) {
  EXPECT_EQ(advice("ball", {"bal\n"}), "did you mean 'bal\\n'?");
  EXPECT_EQ(advice("b", {"stylus\t", "plane"}), "the names here are 'stylus\\t', 'plane'");
  EXPECT_EQ(unknown_text("[behaviour.\t]", "kin", {"kind"}),
            "unknown key 'kin'; expected a key of [behaviour.\\t]; did you mean 'kind'?");
}

TEST(Wording, AllNamesAreOffered) {
  std::vector<std::string> names;
  std::string list;
  for (int i = 0; i < 30; ++i) {
    names.push_back("name_number_" + std::to_string(i));
    list += (i == 0 ? "'" : ", '") + names.back() + "'";
  }
  EXPECT_EQ(advice("quite_another", names), "the names here are " + list);
}

// A comparison of two names of this length letter by letter would take hours.
TEST(Wording, AVeryLongNameIsNearToNone) {
  const std::string one(1'000'000, 'a'), other(1'000'000, 'b');
  EXPECT_EQ(nearest_name(one, {other, "radius_mm"}), "");
  EXPECT_EQ(nearest_name("radius_m", {other, "radius_mm"}), "radius_mm");
  EXPECT_EQ(nearest_name(std::string(1'000'000, '_'), {"radius_mm"}), "");
}

TEST(Wording, LowerCaseIsOfTheLatinLetters) { EXPECT_EQ(lower_case(".JPG\xC3\x84"), ".jpg\xC3\x84"); }

// The file of a calibrated stereo head: written, read, and refused with the place of the mistake.

StereoFile good() {
  StereoFile file;
  file.title = "13 pairs";
  file.rig.left = {533.71234567, 533.7, 342.2, 235.1, {-0.2891, 0.096, 0.0011, -0.0001, 0.0}};
  file.rig.right = {536.8, 536.4, 327.1, 249.9, {-0.2892, 0.1051, -0.0005, 0.0002, 0.0}};
  file.rig.X_CD = Pose<'C', 'D'>(rotation_xyz(Vec3(0.001, 0.02, -0.003)), Vec3(0.08316, -0.00064, 0.00055));
  file.reprojection = 0.194;
  file.epipolar = 0.142;
  return file;
}

std::string refused_change(const std::string& from, const std::string& to) {
  try {
    static_cast<void>(parse_stereo(replaced(stereo_text(good()), from, to), "head.toml"));
  } catch (const Error& e) {
    EXPECT_EQ(e.key(), "");
    return e.what();
  }
  return {};
}

TEST(StereoFile, ComesBackAsItWasWritten) {
  const std::string text = stereo_text(good());
  const StereoFile read = parse_stereo(text, "head.toml");
  EXPECT_EQ(stereo_text(read), text);
  EXPECT_EQ(read.title, "13 pairs");
  EXPECT_DOUBLE_EQ(read.rig.left.focal_x, 533.7123);
  EXPECT_DOUBLE_EQ(read.rig.right.distortion[1], 0.1051);
  EXPECT_NEAR((read.rig.X_CD.p() - good().rig.X_CD.p()).norm(), 0.0, 1e-7);
  EXPECT_LT(read.rig.X_CD.q().angularDistance(good().rig.X_CD.q()), 1e-6);
  EXPECT_DOUBLE_EQ(read.epipolar, 0.142);
}

TEST(StereoFile, WhatIsTooLargeToBeRoundedComesBack) {
  StereoFile file = good();
  file.reprojection = 1e305;
  EXPECT_DOUBLE_EQ(parse_stereo(stereo_text(file), "head.toml").reprojection, 1e305);
}

TEST(StereoFile, KeysSayTheirUnits) {
  EXPECT_THAT(
      stereo_text(good()),
      AllOf(HasSubstr("width_px = 640\n"), HasSubstr("focal_px = [533.7123, 533.7]\n"),
            HasSubstr("position_mm = [83.16, -0.64, 0.55]\n"), HasSubstr("rotation_deg = [0.0573, ")));
}

TEST(StereoFile, MistakesAreRefusedWithTheirPlace) {
  EXPECT_THAT(refused_change("focal_px = [533.7123, 533.7]", "focal_px = [533.7123]"),
              AllOf(StartsWith("head.toml:9:"), HasSubstr("has 1 element; expected 2 positive numbers")));
  EXPECT_THAT(refused_change("focal_px = [533.7123, 533.7]", "focal_px = [-533.7, 533.7]"),
              AllOf(StartsWith("head.toml:9:"), HasSubstr("positive")));
  EXPECT_THAT(refused_change("width_px", "widht_px"),
              AllOf(StartsWith("head.toml:3:1: "), HasSubstr("width_px")));
  EXPECT_THAT(refused_change("[right]", "[rihgt]"), AllOf(StartsWith("head.toml:"), HasSubstr("right")));
  EXPECT_THAT(refused_change("[342.2, 235.1]", "[3420.2, 235.1]"),
              AllOf(StartsWith("head.toml:10:1: "), HasSubstr("a place in an image of 640 x 480 px")));
  EXPECT_THAT(refused_change("[-0.2891, ", "[-2.891, "),
              AllOf(StartsWith("head.toml:11:1: "), HasSubstr("folds the image")));
  EXPECT_THAT(refused_change("position_mm = [83.16", "position_mm = [-83.16"),
              AllOf(StartsWith("head.toml:17:1: "), HasSubstr("to the right")));
  EXPECT_THAT(refused_change("format = 1", "format = 2"), StartsWith("head.toml:1:10: "));
  EXPECT_THAT(refused_change("[left]", "[left"), HasSubstr("is not TOML"));
}

TEST(StereoFile, AFileThatIsNotThereIsOneLine) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::refusal([&] { (void)load_stereo(folder.file("none.toml")); }),
              AllOf(StartsWith(folder.file("none.toml") + ":1:1: "), HasSubstr("calibrate")));
  std::ofstream(folder.file("head.toml")) << stereo_text(good());
  EXPECT_EQ(load_stereo(folder.file("head.toml")).width, 640);
}

TEST(StereoFile, SaysWhatARigCallsSo) {
  for (const char* name : {"rig.camera.width_px", "rig.camera.height_px", "rig.camera.left",
                           "rig.camera.left.focal_px", "rig.camera.right.position_mm"})
    EXPECT_TRUE(of_calibration(name)) << name;
  for (const char* name :
       {"rig.camera", "rig.camera.rate_hz", "rig.camera.latency_ms", "rig.camera.calibration",
        "rig.camera.leftover", "truth.camera.left", "left.focal_px"})
    EXPECT_FALSE(of_calibration(name)) << name;
}

}  // namespace
}  // namespace enc::models
