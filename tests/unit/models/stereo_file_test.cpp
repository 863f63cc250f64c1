// The file of a calibrated stereo head: written, read, and refused with the place of the mistake.
#include "models/setup/stereo_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace enc::models {
namespace {

using test::replaced;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

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
  try {
    static_cast<void>(load_stereo(folder.file("none.toml")));
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(StartsWith(folder.file("none.toml") + ":1:1: "), HasSubstr("calibrate")));
  }
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
