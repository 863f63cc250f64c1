// Tools and meshes of a size or at a place that nobody meant: what `check` prints of each, the warnings, and
// what a refusal says of the mesh.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/mesh_files/mesh_write.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_sizes.h"
#include "models/shapes/shapes.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "trial/assemble/prepare.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using tests::shipped_scene;

class Sizes : public ::testing::Test {
 protected:
  Sizes() { std::filesystem::copy(shipped_scene("hare"), folder_.path() / "ball.toml"); }
  // The hare's scene with another mesh, which stands at the origin of W.
  [[nodiscard]] models::Setup with_mesh(const Mesh& mesh, const std::vector<std::string>& more = {}) const {
    std::ofstream(folder_.path() / "ball.stl", std::ios::binary) << models::mesh_bytes(mesh, ".stl");
    std::vector<std::string> set{"object.hare.mesh=ball.stl", "object.hare.position_mm=[0, 0, -25]"};
    set.insert(set.end(), more.begin(), more.end());
    return models::load((folder_.path() / "ball.toml").string(), "sim", set);
  }
  static std::string refusal(const models::Setup& setup) {
    try {
      (void)trial::prepare_setup(setup);
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  }
  static Mesh at(Mesh mesh, double x, double scale = 1.0) {
    for (auto& v : mesh.vertices) v = {scale * v[0] + x, scale * v[1], scale * v[2]};
    return mesh;
  }
  TemporaryFolder folder_;
  const Mesh ball_ = models::geodesic_ball(6);  // 66 mm
};

TEST_F(Sizes, AMeshOfAnotherUnitIsRefusedWithItsExtentAndTheScale) {
  EXPECT_EQ(refusal(with_mesh(ball_)), "accepted");
  const auto said = [&](double scale) { return refusal(with_mesh(at(ball_, 0.0, scale))); };
  EXPECT_THAT(said(1000), AllOf(HasSubstr("mesh 'ball.stl' is 66 x 66 x 66 m in this scene"),
                                HasSubstr("middle at (0, 0, -25) mm of W"),
                                HasSubstr(": is the file in mm? then write scale = 0.001")));
  EXPECT_THAT(said(100), HasSubstr("6.6 x 6.6 x 6.6 m in this scene"));
  EXPECT_THAT(
      said(100),
      HasSubstr("is the file in cm? then write scale = 0.01; or in inches? then write scale = 0.0254"));
  // With that scale it is accepted.
  EXPECT_EQ(refusal(with_mesh(at(ball_, 0.0, 1000), {"object.hare.scale=0.001"})), "accepted");
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

// Markers in m or cm are too near to one another to be told apart, so the scene is refused.
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

}  // namespace
}  // namespace enc::test
