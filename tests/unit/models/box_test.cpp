// An object of shape "box": its surface, and a press on it in a whole run.
#include <fstream>
#include <random>
#include <sstream>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/control/world/object.h"
#include "models/mesh_files/mesh_check.h"
#include "models/setup/scene_file.h"
#include "models/shapes/shapes.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using testing::HasSubstr;

// The distance to a box in closed form: outside from the part beyond each face, inside to the nearest face.
double distance_to_box(const Vec3& p, const Vec3& size) {
  const Vec3 beyond = p.cwiseAbs() - 0.5 * size;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

class BoxShape : public testing::Test {
 protected:
  // The tennis ball's scene with a cube of 60 mm instead, whose top is at the height of the ball's top.
  [[nodiscard]] std::string scene(const std::string& lines) const {
    std::ifstream from(tests::source_dir() + "/models/scenes/tennis_ball.toml");
    std::stringstream text;
    text << from.rdbuf();
    std::string all = text.str();
    const auto put = [&](const std::string& old, const std::string& by) {
      all.replace(all.find(old), old.size(), by);
    };
    put("shape = \"sphere\"", "shape = \"box\"");
    put("radius_mm = 33", lines);
    put("position_mm = [0, 0, -20]", "position_mm = [0, 0, -17]");
    std::ofstream(folder_.file("cube.toml")) << all;
    return folder_.file("cube.toml");
  }
  [[nodiscard]] std::string said(const std::string& lines) const {
    return test::refusal([&] { (void)trial::prepare_setup(models::load(scene(lines), "sim")); });
  }
  const TemporaryFolder folder_;
};

TEST_F(BoxShape, ItsSurfaceIsASolidAndItsDistancesAreThoseOfABox) {
  const Vec3 size(0.060, 0.021, 0.130);
  const models::CheckedMesh checked = models::check_mesh(*models::box_surface(size), "box");
  EXPECT_THAT(checked.notes, testing::IsEmpty());
  ObjectSpec spec;
  spec.shape = ShapeKind::box;
  spec.size = size;
  spec.surface = models::box_surface(size);
  const Surface surface = surface_of(spec);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(share(random) * size.x(), share(random) * size.y(), share(random) * size.z());
    EXPECT_NEAR(surface.nearest(Point<'O'>(p)).distance, distance_to_box(p, size), 1e-12) << p.transpose();
  }
}

TEST_F(BoxShape, APressOnItsTopIsFeltAsFarAsOnTheBall) {
  const models::Setup setup = models::load(scene("size_mm = [60, 60, 60]"), "sim");
  trial::TrialOptions options;
  options.seconds = 14.0;  // the first press
  trial::Trial trial(setup, options);
  double deepest = 0.0, highest = 0.0;
  while (trial.tick()) {
    if (trial.outputs().mode != Mode::contact) continue;
    deepest = std::max(deepest, trial.outputs().deflection);
    highest = std::max(highest, trial.truth().contact_force.norm());
    EXPECT_GT(dot(contact_of(trial.state()).X_WN * Vec<'N'>(0, 0, 1), Vec<'W'>(0, 0, 1)), 0.999);
  }
  EXPECT_NEAR(deepest, 6.0e-3, 0.1e-3);
  EXPECT_NEAR(highest, 12.0, 1.0) << "the ball's own curve: 12 N at 6 mm [VHMR Fig 8]";
}

TEST_F(BoxShape, WhatIsWrongIsOneLine) {
  EXPECT_THAT(said(""), HasSubstr("'size_mm'"));
  EXPECT_THAT(said("size_mm = [60, 60]"), HasSubstr("'size_mm' "));
  EXPECT_THAT(said("size_mm = [60, 0, 60]"), HasSubstr("'size_mm[1]'"));
  EXPECT_THAT(said("size_mm = [60, 60, 2]"), HasSubstr("thinner than the haptic-tip"));
  EXPECT_THAT(said("radius_mm = 33"), HasSubstr("radius_mm"));
}

}  // namespace
}  // namespace enc::test
