// Wrong objects, tools and meshes, or of an unintended size or place.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "models/mesh_files/mesh_file.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_sizes.h"
#include "models/shapes/shapes.h"
#include "tests/support/built.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"
#include "trial/assemble/assemble.h"
#include "trial/trial.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using test::replaced;
using test::TemporaryFolder;
using test::Variable;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using tests::shipped_scene;

// ---- Files of the world subsystem: scenes of an arm, the interaction database, and their mistakes, one line
// each.

const fs::path kModels = fs::path(tests::source_dir()) / "models";

models::Setup setup_of(const std::string& scene, const std::vector<std::string>& set = {},
                       const std::string& rig = "vishap") {
  return models::load((kModels / "scenes" / (scene + ".toml")).string(), rig, set);
}

// The error message; empty if prepare() accepts the scene.
std::string said_objects(const std::string& scene, const std::vector<std::string>& set) {
  return test::error_of([&] { (void)trial::prepare_setup(setup_of(scene, set)); });
}

TEST(ObjectsInput, TheShippedScenesAreReadyAndHaveTheirProps) {
  for (const char* scene : {"keypad", "room", "hit_ball", "tiles", "drum"}) {
    EXPECT_EQ(said_objects(scene, {}), "") << scene;
    EXPECT_THAT(setup_of(scene).notes, IsEmpty()) << scene;
  }
  EXPECT_EQ(trial::prepare_setup(setup_of("keypad")).objects.size(), 12U);
  EXPECT_EQ(std::get<DynamicObjectTask>(trial::prepare_setup(setup_of("tiles")).task).movers.size(), 2U);
}

TEST(ObjectsInput, NumbersOutOfRange) {
  for (const char* set :
       {"object.key_1.width_mm=0", "object.key_1.height_mm=-15", "object.key_1.thickness_mm=0",
        "follow.hysteresis_mm=-1", "object.key_1.width_mm=nan"})
    EXPECT_THAT(said_objects("keypad", {set}), HasSubstr("; expected a ")) << set;
  for (const char* set :
       {"behaviour.hit_ball.interaction.mass_kg=-0.1", "behaviour.hit_ball.interaction.mass_kg=0",
        "behaviour.hit_ball.interaction.restitution=0", "behaviour.hit_ball.interaction.restitution=1.1",
        "behaviour.hit_ball.interaction.travel_mm=0", "behaviour.hit_ball.stiffness_N_per_mm=-1"})
    EXPECT_THAT(said_objects("hit_ball", {set}), HasSubstr("; expected a ")) << set;
  EXPECT_THAT(said_objects("tiles", {"behaviour.tile.interaction.friction_N=-1"}),
              HasSubstr("; expected a "));
  EXPECT_THAT(said_objects("tiles", {"behaviour.tile.interaction.way=[0,0,-0.5]"}),
              HasSubstr("expected length 1"));
}

TEST(ObjectsInput, AnEntryThatTheDatabaseDoesNotHaveIsOneLineWithItsPlace) {
  const std::string what = said_objects("keypad", {"object.key_3.behaviour=\"key_buton\""});
  EXPECT_THAT(what, AllOf(HasSubstr("there is no behaviour 'key_buton'"), HasSubstr("behaviours.toml"),
                          HasSubstr("did you mean 'key_button'?")));
  EXPECT_EQ(std::count(what.begin(), what.end(), '\n'), 0);
}

TEST(ObjectsInput, ANormalOfAnotherLengthIsMendedAndTold) {
  const models::Setup setup = setup_of("keypad", {"object.key_2.normal=[0,0,2]"});
  EXPECT_EQ(setup.scene.objects[1].normal, Vec3(0, 0, 1));
  EXPECT_THAT(setup.notes, ElementsAre(AllOf(HasSubstr("'normal' has length 2"), HasSubstr("[0, 0, 1]"))));
  EXPECT_THAT(said_objects("keypad", {"object.key_2.normal=[0,0,0]"}), HasSubstr("no direction"));
}

TEST(ObjectsInput, AWrongPropIsWarnedOf) {
  const models::Setup setup = setup_of("room", {"prop.kind=\"plate\""});
  EXPECT_THAT(setup.notes, ElementsAre(AllOf(HasSubstr("room.toml"),
                                             HasSubstr("warning: object 'key' shall feel like a key and the "
                                                       "arm carries a plate"))));
}

TEST(ObjectsInput, MoreObjectsThanCanMove) {
  models::Setup setup = setup_of("hit_ball");
  const ObjectSpec ball = setup.scene.objects[0];
  for (std::size_t i = 0; i < kMostMoving; ++i) {
    setup.scene.objects.push_back(ball);
    setup.scene.objects.back().name = "ball_" + std::to_string(i);
  }
  try {
    (void)prepare(setup.scene, setup.rig);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("at most 16"));
    EXPECT_EQ(e.key(), "object.ball_15.behaviour");
  }
}

// An edited entry changes only the objects that name it.
TEST(ObjectsInput, EachEntryIsItsObjectsAlone) {
  const TemporaryFolder folder;
  fs::copy(kModels, folder.path(), fs::copy_options::recursive);
  const Variable models("ENCOUNTER_MODELS", folder.path().string());
  const fs::path file = fs::path(folder.path()) / "behaviours.toml";
  const auto room = [&] {
    return trial::prepare_setup(
        models::load((fs::path(folder.path()) / "scenes" / "room.toml").string(), "vishap", {}));
  };
  const Scene before = room();
  std::string text = test::bytes_of(file);
  const std::string old = "stiffness_N_per_mm = 0.6";
  const auto at = text.find(old, text.find("name = \"passive_key\""));
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << text.replace(at, old.size(), "stiffness_N_per_mm = 0.4");
  const Scene after = room();
  EXPECT_EQ(before.objects[0].stiffness, 600.0);
  EXPECT_EQ(after.objects[0].stiffness, 400.0);
  for (std::size_t i = 1; i < before.objects.size(); ++i) {
    EXPECT_EQ(before.objects[i].stiffness, after.objects[i].stiffness);
    EXPECT_EQ(before.objects[i].interaction.kind, after.objects[i].interaction.kind);
    EXPECT_EQ(before.objects[i].X_WO.xyz, after.objects[i].X_WO.xyz);
  }
}

// A machine that only its file describes [L18].
TEST(ObjectsInput, AStageOfTwoSlidesRunsTheWall) {
  trial::TrialOptions options;
  trial::Trial trial(
      setup_of("wall", {"user.approach_mm_s=[50]", "user.press_s=1", "user.release_s=1"}, "stage"), options);
  double peak = 0.0;
  while (trial.tick()) peak = std::max(peak, trial.world().truth().contact_force.norm());
  EXPECT_EQ(trial.scene().impedance()->arm.joints(), 2U);
  EXPECT_GE(trial.result().contacts, 1);
  EXPECT_GT(peak, 1.0);
  EXPECT_TRUE(trial.result().holds.empty());
}

// ---- Tools and meshes of an unintended size or place: the output of `check` for each, the warnings, and the
// refusals of meshes.

class Sizes : public ::testing::Test {
 protected:
  Sizes() { std::filesystem::copy(shipped_scene("hare"), folder_.path() / "ball.toml"); }
  // The hare's scene with another mesh, at the origin of W.
  [[nodiscard]] models::Setup with_mesh(const Mesh& mesh, const std::vector<std::string>& more = {}) const {
    std::ofstream(folder_.path() / "ball.stl", std::ios::binary) << models::mesh_bytes(mesh, ".stl");
    std::vector<std::string> set{"object.hare.mesh=ball.stl", "object.hare.position_mm=[0, 0, -25]"};
    set.insert(set.end(), more.begin(), more.end());
    return models::load((folder_.path() / "ball.toml").string(), "sim", set);
  }
  static std::string refusal(const models::Setup& setup) {
    return test::error_of([&] { (void)trial::prepare_setup(setup); });
  }
  static Mesh at(Mesh mesh, double x, double scale = 1.0) {
    for (auto& v : mesh.vertices) v = {scale * v[0] + x, scale * v[1], scale * v[2]};
    return mesh;
  }
  TemporaryFolder folder_;
  const Mesh ball_ = models::geodesic_ball(6);  // 66 mm
};

TEST_F(Sizes, AMeshOfAnotherUnitIsRefusedWithItsExtentAndTheScale) {
  EXPECT_EQ(refusal(with_mesh(ball_)), "");
  const auto said = [&](double scale) { return refusal(with_mesh(at(ball_, 0.0, scale))); };
  EXPECT_THAT(said(1000), AllOf(HasSubstr("mesh 'ball.stl' is 66 x 66 x 66 m in this scene"),
                                HasSubstr("middle at (0, 0, -25) mm of W"),
                                HasSubstr(": is the file in mm? then write scale = 0.001")));
  EXPECT_THAT(said(100), HasSubstr("6.6 x 6.6 x 6.6 m in this scene"));
  EXPECT_THAT(
      said(100),
      HasSubstr("is the file in cm? then write scale = 0.01; or in inches? then write scale = 0.0254"));
  // The program accepts the mesh with that scale.
  EXPECT_EQ(refusal(with_mesh(at(ball_, 0.0, 1000), {"object.hare.scale=0.001"})), "");
}

TEST_F(Sizes, AMeshWithItsMiddleFarFromItsOriginIsRefusedWithThePosition) {
  EXPECT_THAT(refusal(with_mesh(at(ball_, 1200))), HasSubstr("middle at (-1.2, 0, 0) km of W"));
  const std::string said = refusal(with_mesh(at(ball_, 1.2), {"object.hare.rotation_deg=[0, 0, 0]"}));
  EXPECT_THAT(
      said, AllOf(HasSubstr("66 x 66 x 66 mm in this scene"), HasSubstr("middle at (1.2, 0, -0.025) m of W"),
                  HasSubstr(": position_mm = [-1200, 0, 0] puts its middle at the origin of W")));
  const models::Setup moved = with_mesh(
      at(ball_, 1.2), {"object.hare.rotation_deg=[0, 0, 0]", "object.hare.position_mm=[-1200, 0, -25]"});
  EXPECT_THAT(refusal(moved), HasSubstr("passes the mesh by"));  // the user presses through the mesh's origin
  EXPECT_THAT(refusal(moved), HasSubstr("66 x 66 x 66 mm in this scene"));
}

TEST_F(Sizes, AnExtraordinaryMeshIsWarnedOf) {
  EXPECT_THAT(with_mesh(ball_).notes, IsEmpty());
  EXPECT_THAT(
      with_mesh(at(ball_, 0.0, 1000)).notes,
      ElementsAre(AllOf(
          HasSubstr("warning: mesh 'ball.stl' is 66 x 66 x 66 m; expected a longest side of 5 mm to 2 m"),
          HasSubstr("is the file in mm? then write scale = 0.001"))));
  EXPECT_THAT(
      with_mesh(ball_, {"object.hare.scale=0.001"}).notes,
      ElementsAre(AllOf(HasSubstr("66 x 66 x 66 um"), HasSubstr("is the file in km? then write scale = 1"))));
}

TEST(ToolSizes, ATipInMetresIsWarnedOf) {
  const auto notes = [](const std::string& set) {
    return models::load(shipped_scene("plane"), "sim", {set}).notes;
  };
  EXPECT_THAT(notes("tool.stylus.tip_mm=[0, 0, -120]"), IsEmpty());
  EXPECT_THAT(notes("tool.stylus.tip_mm=[0, 0, -0.120]"),
              ElementsAre(AllOf(HasSubstr("warning: the tip of tool 'stylus' is "),
                                HasSubstr("expected 20 mm to 1 m"),
                                HasSubstr("is 'tip_mm' in m? then write tip_mm = [0, 0, -120]"))));
  EXPECT_THAT(notes("tool.stylus.tip_mm=[0, 0, -120000]"),
              ElementsAre(HasSubstr("is 'tip_mm' in um? then write tip_mm = [0, 0, -120]")));
  EXPECT_THAT(notes("tool.stylus.tip_radius_mm=0.002"),
              ElementsAre(HasSubstr("has a radius of 2 um; expected 50 um to 30 mm")));
  EXPECT_THAT(notes("tool.stylus.markers_mm=[[0, 0, 0], [5200, 0, 0], [0, 4100, 0], [-1700, -3000, 1200]]"),
              Not(IsEmpty()));
}

// Markers in m or cm are too close together to be distinguished, so the program refuses the scene.
TEST(ToolSizes, MarkersInAnotherUnitAreAskedFor) {
  const auto said = [](const std::string& markers, const std::string& tip) -> std::string {
    try {
      const auto notes = models::load(shipped_scene("plane"), "sim",
                                      {"tool.stylus.markers_mm=" + markers, "tool.stylus.tip_mm=" + tip})
                             .notes;
      return fmt::format("{}", fmt::join(notes, "\n"));
    } catch (const Error& e) {
      return e.what();
    }
  };
  EXPECT_THAT(said("[[0, 0, 0], [0.052, 0, 0], [0, 0.041, 0], [-0.017, -0.03, 0.012]]", "[0, 0, -120]"),
              AllOf(HasSubstr("are on a line, or almost"),
                    HasSubstr("; is 'markers_mm' in m? then multiply each number of it by 1000")));
  for (const char* markers : {"[[0, 0, 0], [5.2, 0, 0], [0, 4.1, 0], [-1.7, -3, 1.2]]",
                              "[[0, 0, 0], [9, 0, 0], [0, 3, 0], [-7, -9, 2]]"})
    EXPECT_THAT(said(markers, "[0, 0, -12]"),
                HasSubstr("; is 'markers_mm' in cm? then multiply each number of it by 10"));
  const std::string micrometres = "[[0, 0, 0], [52000, 0, 0], [0, 41000, 0], [-17000, -30000, 12000]]";
  EXPECT_THAT(
      said(micrometres, "[0, 0, -120]"),
      AllOf(HasSubstr("the markers of tool 'stylus' are up to 76.2 m apart; expected 20 mm to 500 mm; is "
                      "'markers_mm' in um? then multiply each number of it by 0.001"),
            Not(HasSubstr("'tip_mm'"))));
  EXPECT_THAT(said(micrometres, "[0, 0, -120000]"),
              HasSubstr("is 'tip_mm' in um? then write tip_mm = [0, 0, -120]"));
  EXPECT_THAT(said("[[0, 0, 0], [60, 0, 0], [130, 0, 0]]", "[0, 0, -120]"), HasSubstr("; move one of"));
}

TEST(ObjectSizes, ABallOrAButtonInAnotherUnitIsWarnedOf) {
  const auto notes = [](const std::string& scene, const std::string& set) {
    return models::load(shipped_scene(scene), "", {set}).notes;
  };
  EXPECT_THAT(
      notes("tennis_ball", "object.ball.radius_mm=0.0335"),
      ElementsAre(HasSubstr("has a diameter of 67 um; expected 5 mm to 2 m; is 'radius_mm' in m? then write "
                            "radius_mm = 33.5")));
  EXPECT_THAT(notes("tennis_ball", "object.ball.radius_mm=1"),
              ElementsAre(HasSubstr("is 'radius_mm' in cm? then write radius_mm = 10")));
  EXPECT_THAT(
      notes("button", "object.button.width_mm=0.015"),
      ElementsAre(HasSubstr("button 'button' has a width of 15 um; expected 5 mm to 2 m; is 'width_mm' in m? "
                            "then write width_mm = 15")));
  EXPECT_THAT(notes("button", "object.button.height_mm=1.5"),
              ElementsAre(HasSubstr("is 'height_mm' in m? then write height_mm = 1500; or in cm? then write "
                                    "height_mm = 15")));
  EXPECT_THAT(notes("button", "object.button.thickness_mm=0.05"),
              ElementsAre(HasSubstr("a thickness of 50 um; expected 1 mm to 1 m; is 'thickness_mm' in m?")));
  EXPECT_THAT(
      notes("plane", "object.wall.position_mm=[0, 0, 100000]"),
      ElementsAre(AllOf(HasSubstr("object 'wall' is 100 m from the origin of W; expected at most 10 m"),
                        HasSubstr("is 'position_mm' in um? then write position_mm = [0, 0, 100]"))));
}

TEST(ToolSizes, ShippedScenesAreOrdinary) {
  for (const std::string& name : models::files_in(tests::source_dir() + "/models", "scenes"))
    EXPECT_THAT(models::load(shipped_scene(name), "").notes, Not(testing::Contains(HasSubstr("expected"))))
        << name;
}

// `check` prints each tool and each mesh.
TEST(SizesText, IsPrintedByCheck) {
  const std::string text = models::sizes_text(models::load(shipped_scene("hare"), ""));
  EXPECT_THAT(text,
              AllOf(HasSubstr("sizes       tool 'stylus': tip radius 2 mm, 123 mm from the middle of its 4 "
                              "markers, up to 76.2 mm apart; 50 g\n"),
                    HasSubstr("\n            mesh 'hare' (hare.glb): "), HasSubstr(" of W, volume "),
                    HasSubstr(" faces\n")));
  const tests::Result r = tests::run_program({"check", shipped_scene("hare")});
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("\n" + text));
  EXPECT_EQ(models::sizes_text(models::load(shipped_scene("wall"), "")),
            "sizes       tool 'finger': tip radius 8 mm; 20 g\n");
}

// ---- Wrong mesh files: the program refuses each with exit code 2 and one line that names the file.

// A tetrahedron.
Mesh good() {
  return {{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}
std::string bytes(const std::string& ending) { return models::mesh_bytes(good(), ending); }
std::string put(std::string text, std::size_t at, std::uint32_t word) {
  std::memcpy(text.data() + at, &word, sizeof(word));
  return text;
}
// Changes a word of the tetrahedron's .glb, counted from the end: 12 indices of two bytes after 12 floats.
std::string with_float(std::size_t i, float value) {
  std::string text = bytes(".glb");
  std::memcpy(text.data() + text.size() - 24 - 48 + 4 * i, &value, sizeof(value));
  return text;
}
std::string with_index(std::uint16_t value) {
  std::string text = bytes(".glb");
  std::memcpy(text.data() + text.size() - 24, &value, sizeof(value));
  return text;
}
// The tetrahedron as .gltf, its numbers as a data URI, with one part of the JSON changed.
std::string gltf(const std::string& from = "{", const std::string& to = "{") {
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  return replaced(json, from, to);
}
constexpr const char* kUri =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

struct InvalidInput {
  const char* name;
  const char* file;
  std::string content;
  const char* words;  // a part of the line
};
void PrintTo(const InvalidInput& bad, std::ostream* out) { *out << bad.name; }

class BadMesh : public ::testing::TestWithParam<InvalidInput> {
 protected:
  BadMesh() { std::ofstream(folder_ / "points.csv") << "x_m,y_m,z_m\n0,0,0\n"; }
  void expect_refused(const std::string& path, const std::string& words) const {
    const Result r = run_program({"nearest", path, (folder_ / "points.csv").string()});
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(r.out, "");
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    EXPECT_THAT(r.err, StartsWith("encounter: " + path + ":"));
    EXPECT_THAT(r.err, HasSubstr(words));
  }
  test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

TEST_P(BadMesh, IsRefusedInOneLine) {
  const fs::path path = folder_ / GetParam().file;
  std::ofstream(path, std::ios::binary) << GetParam().content;
  expect_refused(path.string(), GetParam().words);
}

// Many nodes share one mesh: the time to read them must grow with their number, not with its square.
std::string many_nodes(int count) {
  std::string nodes, roots;
  for (int i = 0; i < count; ++i) {
    nodes += i > 0 ? R"(,{"mesh":0})" : R"({"mesh":0})";
    roots += (i > 0 ? "," : "") + std::to_string(i);
  }
  return replaced(gltf(R"("nodes":[0])", R"("nodes":[)" + roots + "]"), R"([{"mesh":0}])", "[" + nodes + "]");
}

constexpr const char* kOpen = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
std::string obj(const std::string& more) { return kOpen + more; }
const std::string kClosed = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

std::vector<InvalidInput> bad_glb() {
  const std::string whole = bytes(".glb");
  const std::size_t json = whole.find("BIN") - 24;  // its chunk ends 4 bytes before
  return {
      {"CutInMagic", "a.glb", whole.substr(0, 3), "byte 0: this is no .glb"},
      {"CutInHeader", "a.glb", whole.substr(0, 15), "ends in its header"},
      {"CutInJson", "a.glb", whole.substr(0, 100), "byte 8"},
      {"CutInBinary", "a.glb", whole.substr(0, whole.size() - 10), "byte 8"},
      {"CutInBinaryAndSaysSo", "a.glb",
       put(whole.substr(0, whole.size() - 12), 8, static_cast<std::uint32_t>(whole.size() - 12)),
       "a chunk of"},
      // tinygltf 2.7 alone would read 8 bytes beyond the end here.
      {"ChunkLongerByItsHead", "a.glb",
       put(whole, 20 + json, static_cast<std::uint32_t>(whole.size() - 20 - json)), "a chunk of"},
      {"HugeJsonChunk", "a.glb", put(whole, 12, 0xfffffff0U), "a JSON chunk of"},
      {"WrongMagic", "a.glb", "Not" + whole.substr(3), "this is no .glb"},
      {"WrongVersion", "a.glb", put(whole, 4, 1), "glTF version 1"},
      {"NanPosition", "a.glb", with_float(4, std::numeric_limits<float>::quiet_NaN()),
       "vertex 1 of accessors[0]"},
      {"InfinitePosition", "a.glb", with_float(0, std::numeric_limits<float>::infinity()), "is not finite"},
      {"IndexOutOfRange", "a.glb", with_index(4), "index 0 of accessors[1] is 4"}};
}

std::vector<InvalidInput> bad_gltf() {
  std::string deep(100000, '[');
  return {
      {"BadJson", "a.gltf", "{\"asset\": {\n  \"version\" 2}", "a.gltf:2:"},
      {"NoGltfAtAll", "a.gltf", "hello, world", "cannot be read"},
      {"NestedForEver", "a.gltf", "{\"extras\":" + deep, "nested 101 deep"},
      {"CyclicNodes", "a.gltf", gltf("[{\"mesh\":0}]", "[{\"mesh\":0,\"children\":[1]},{\"children\":[0]}]"),
       "nodes[0] is met twice"},
      {"OwnChild", "a.gltf", gltf("[{\"mesh\":0}]", "[{\"mesh\":0,\"children\":[0]}]"),
       "nodes[0] is met twice"},
      {"NoSuchNode", "a.gltf", gltf("\"nodes\":[0]", "\"nodes\":[7]"), "nodes[7] is not there"},
      {"NoSuchMesh", "a.gltf", gltf("\"mesh\":0", "\"mesh\":9"), "meshes[9] is not there"},
      {"NoSuchAccessor", "a.gltf", gltf("\"POSITION\":0", "\"POSITION\":-3"), "accessors[-3] is not there"},
      {"NoPosition", "a.gltf", gltf("\"POSITION\"", "\"NORMAL\""), "without POSITION"},
      {"PositionOfBytes", "a.gltf", gltf("5126", "5121"), "expected VEC3 of float"},
      {"UnknownComponent", "a.gltf", gltf("5126", "99"), "Invalid `componentType`"},
      {"HugeCount", "a.gltf", gltf("\"count\":3", "\"count\":4000000000000"), "accessors[0]"},
      {"HugeView", "a.gltf",
       gltf("\"buffer\":0,\"byteLength\":36", "\"buffer\":0,\"byteLength\":99999999999"), "bufferViews[0]"},
      {"HugeOffset", "a.gltf", gltf("\"buffer\":0,", "\"buffer\":0,\"byteOffset\":18446744073709551615,"),
       "bufferViews[0]"},
      {"HugeBuffer", "a.gltf", gltf("[{\"byteLength\":36", "[{\"byteLength\":99999999999999"),
       "cannot be read"},
      {"NoSuchFile", "a.gltf", gltf(kUri, "data.bin"), "File not found : data.bin"},
      {"ImageUpwards", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"images\":[{\"uri\":\"../../etc/passwd\"}],"),
       "outside of its folder"},
      {"PathUpwards", "a.gltf", gltf(kUri, "../../../../../../etc/passwd"), "outside of its folder"},
      {"PathAbsolute", "a.gltf", gltf(kUri, "/etc/passwd"), "'/etc/passwd', which is outside"},
      {"Sparse", "a.gltf",
       gltf("\"count\":3,",
            "\"count\":3,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5123},"
            "\"values\":{\"bufferView\":0}},"),
       "sparse"},
      {"Draco", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],"),
       "compressed with Draco ('KHR_draco_mesh_compression'); expected plain glTF 2.0; export it without"},
      {"DracoWithoutItsData", "a.gltf",
       replaced(gltf("\"bufferView\":0,\"componentType\"", "\"componentType\""), "\"scene\":0,",
                "\"extensionsRequired\" : [ \"KHR_texture_transform\", \"KHR_draco_mesh_compression\" ],"),
       "a.gltf:1:51: the mesh is compressed with Draco"},
      {"Meshopt", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"EXT_meshopt_compression\"],"),
       "compressed with meshopt ('EXT_meshopt_compression')"},
      {"Quantised", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_mesh_quantization\"],"), "quantised"},
      {"UnknownExtension", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"ACME_bend\"],"),
       "requires the extension 'ACME_bend'"},
      {"Skewed", "a.gltf", gltf("{\"mesh\":0}", "{\"mesh\":0,\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}"),
       "perspective"},
      {"OneTriangle", "a.gltf", gltf(), "face 0 at a hole"},
      {"ManyNodes", "a.gltf", many_nodes(30'000), "doubled: another face"}};
}

std::vector<InvalidInput> bad_others() {
  const std::string stl = bytes(".stl");
  return {
      {"Empty", "a.obj", "", "it is empty"},
      {"NoTriangles", "a.obj", obj(""), "no triangles"},
      {"UnknownEnding", "a.ply", "ply", "is no ending of a mesh file"},
      {"ObjIndexZero", "a.obj", obj("f 0 1 2\n"), "a.obj:5:3: vertex 0"},
      {"ObjIndexBeyond", "a.obj", obj("f 1 2 5\n"), "a.obj:5:7: vertex 5"},
      {"ObjIndexBeyondBackwards", "a.obj", obj("f -1 -2 -5\n"), "vertex -5"},
      {"ObjTextInNumber", "a.obj", obj("v 1 2 x3\n"), "a.obj:5:7: 'x3'"},
      {"ObjNan", "a.obj", obj("v 1 nan 3\n"), "'nan' is no coordinate"},
      {"ObjShortVertex", "a.obj", obj("v 1 2\n"), "is no coordinate"},
      {"ObjTwoCorners", "a.obj", obj("f 1 2\n"), "2 corners"},
      {"ObjContinued", "a.obj", obj("f 1 2 \\\n3\n"), "a.obj:5:7: a line that goes on"},
      {"ObjGarbage", "a.obj", "hello\n", "a.obj:1:1: 'hello'"},
      {"Open", "a.obj", obj("f 1 3 2\nf 1 2 4\nf 2 3 4\n"), "a.obj:5: faces of lines 5, 6 and 7 at a hole"},
      {"Doubled", "a.obj", obj(kClosed + "f 1 3 2\n"), "doubled"},
      {"NonManifold", "a.obj", obj("v 0.1 -1 -1\n" + kClosed + "f 1 2 5\n"), "non-manifold"},
      {"BowTie", "a.obj",
       obj("v -1 0 0\nv 0 -1 0\nv 0 0 -1\n" + kClosed + "f 1 5 6\nf 1 7 5\nf 5 7 6\nf 1 6 7\n"),
       "meet in a point"},
      {"FlatFace", "a.obj",
       "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 5\nf 1 5 4\nf 3 4 5\n",
       "a.obj:6: face of line 6 of zero area"},
      {"ThroughItself", "a.obj",
       obj("v 0.1 0.1 0.1\nv 1.1 0.1 0.1\nv 0.1 1.1 0.1\nv 0.1 0.1 1.1\n" + kClosed +
           "f 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n"),
       "passing through other faces"},
      {"FarVertex", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e20 0\nv 0 0 1\n" + kClosed,
       "vertex 2 is at y = 1e+20 m; expected at most 1e+06 m from the origin"},
      {"ObjFaceNotFlat", "a.obj", obj("v 1 1 1\nf 1 2 5 3\n"), "a.obj:6:1: a face that is not flat"},
      {"ObjFaceCrossesItself", "a.obj", obj("v 2 2 0\nv 3 0 0\nf 1 5 2 3 6\n"),
       "a.obj:7:1: a face whose sides cross"},
      {"ObjFaceTouchesItself", "a.obj", obj("v 0.5 0 0\nv 1 1 0\nf 1 2 6 5 3\n"),
       "a.obj:7:1: a face whose sides cross or touch"},
      {"ObjFaceBowTie", "a.obj", obj("v 1 1 0\nf 1 5 2 3\n"), "a.obj:6:1: a face of no area"},
      {"FaceToFace", "a.obj",
       obj("v 0.2 0.2 0\nv 0.4 0.2 0\nv 0.2 0.4 0\nv 0.2 0.2 -1\n" + kClosed +
           "f 5 6 7\nf 5 8 6\nf 6 8 7\nf 5 7 8\n"),
       "a.obj:9: faces of lines 9, 13 and 3 more touching others (the first face of line 1"},
      {"StlWrongCount", "a.stl", put(stl, 80, 5),
       "byte 80: the file says 5 triangles, but its 284 bytes fit 4"},
      {"StlHugeCount", "a.stl", put(stl, 80, 0xffffffffU), "the file says 4294967295 triangles"},
      {"StlCut", "a.stl", stl.substr(0, stl.size() - 7), "byte 80"},
      {"StlNan", "a.stl", put(stl, 84 + 12, 0x7fc00000U), "byte 96"},
      {"StlTextCut", "a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0",
       "the file ends here"},
      {"StlTextOutOfPlace", "a.stl", "solid x\nfacet normal 0 0 1\nouter lop\n",
       "a.stl:3:7: 'lop' is out of place"},
      {"StlTextNumber", "a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n",
       "a.stl:4:10: 'zero'"}};
}

const auto kName = [](const auto& tested) { return std::string(tested.param.name); };
INSTANTIATE_TEST_SUITE_P(Glb, BadMesh, ::testing::ValuesIn(bad_glb()), kName);
INSTANTIATE_TEST_SUITE_P(Gltf, BadMesh, ::testing::ValuesIn(bad_gltf()), kName);
INSTANTIATE_TEST_SUITE_P(Others, BadMesh, ::testing::ValuesIn(bad_others()), kName);

using BadPlace = BadMesh;

// A mesh at the limit of its size is accepted; a scene that scales it beyond the limit is refused.
TEST_F(BadPlace, AsFarAsItMayAndNoFarther) {
  const fs::path path = folder_ / "a.obj";
  std::ofstream(path) << "v 0 0 0\nv 1e6 0 0\nv 0 1e6 0\nv 0 0 1e6\n" << kClosed;
  const Result far = run_program({"nearest", path.string(), (folder_ / "points.csv").string()});
  EXPECT_EQ(far.code, 0) << far.err;
  EXPECT_THAT(far.out, HasSubstr("\n-0,0,0,0,-0.577"));
  const Result scaled = run_program(
      {"check", std::string(source_dir()) + "/models/scenes/hare.toml", "--set", "object.hare.scale=1e9"});
  EXPECT_EQ(scaled.code, 2) << scaled.out;
  EXPECT_THAT(scaled.err, HasSubstr("with this scale the mesh reaches beyond 1000 km"));
}

TEST_F(BadPlace, AFolderAndNothing) {
  fs::create_directory(folder_ / "folder.glb");
  expect_refused((folder_ / "folder.glb").string(), "it is a folder");
  expect_refused((folder_ / "none.glb").string(), "there is no such file");
}

TEST_F(BadPlace, ALinkOutOfTheFolder) {
  fs::create_directory(folder_ / "mesh");
  std::ofstream(folder_ / "outside.bin") << std::string(36, '\0');
  fs::create_symlink("../outside.bin", folder_ / "mesh" / "data.bin");
  std::ofstream(folder_ / "mesh" / "a.gltf") << gltf(kUri, "data.bin");
  expect_refused((folder_ / "mesh" / "a.gltf").string(), "outside of its folder");
}

TEST_F(BadPlace, PointsThatAreWrong) {
  const std::string path = (folder_ / "a.glb").string(), csv = (folder_ / "bad.csv").string();
  models::write_mesh(good(), path);
  const auto refused = [&](const std::string& text, const std::string& words) {
    std::ofstream(csv) << text;
    const Result r = run_program({"nearest", path, csv});
    EXPECT_EQ(r.code, 2);
    EXPECT_EQ(r.out, "");
    EXPECT_THAT(r.err, StartsWith("encounter: " + csv + words));
  };
  refused("x,y,z\n0,0,0\n", ":1:1: the header");
  refused("x_m,y_m,z_m\n0,0,0\n1,two,3\n", ":3:3: 'two' is no number");
  refused("x_m,y_m,z_m\n0,0\n", ":2:");
  refused("x_m,y_m,z_m\n0,0,0,0\n", ":2:6: more than three");
  refused("x_m,y_m,z_m\n0,0,inf\n", ":2:5: 'inf'");
}

}  // namespace
}  // namespace enc::tests
