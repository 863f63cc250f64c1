// A stage's pictures: equal for equal seeds, with the requested light, exposure and colours; an office
// without skin's hue; two stages at a time; EGL beside OSMesa.
#include "sim/camera/stage.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>
#include <thread>
#include <vector>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/vision/finger_tracker.h"
#include "core/vision/segmentation/skin.h"
#include "sim/camera/camera_scene.h"
#include "sim/camera/context.h"
#include "sim/camera/sensor.h"
#include "tests/support/built.h"

namespace enc::sim {
namespace {

const HandPose kHand{{0.01, -0.03, 0.38}, {0.2, -1, 0}, 0.2};

StageSpec small(Scenery scenery = Scenery::office, std::uint64_t seed = 1) {
  StageSpec spec;
  spec.scenery = scenery;
  spec.seed = seed;
  spec.camera.width = 320;
  spec.camera.height = 240;
  spec.camera.left = spec.camera.right = {360.5, 360.5, 159.5, 119.5, {}};
  return spec;
}

Image drawn(const StageSpec& spec, const HandPose* hand = &kHand, const Light& light = {},
            std::uint64_t frame = 0) {
  Stage stage(spec);
  Image left, right;
  stage.draw(hand, {}, light, frame, left, right);
  return left;
}

// Hue in degrees and saturation.
std::array<double, 2> hue(const std::uint8_t* p) {
  const double most = std::max({p[0], p[1], p[2]}), least = std::min({p[0], p[1], p[2]});
  if (most == least) return {0, 0};
  const double span = most - least;
  double h = most == p[0]   ? (p[1] - p[2]) / span
             : most == p[1] ? 2 + (p[2] - p[0]) / span
                            : 4 + (p[0] - p[1]) / span;
  h *= 60.0;
  return {h < 0 ? h + 360 : h, span / most};
}

TEST(Stage, TheSameSeedGivesTheSameBits) {
  for (const Scenery scenery : {Scenery::office, Scenery::clutter, Scenery::skin_hued}) {
    const Image one = drawn(small(scenery, 3));
    EXPECT_EQ(one.rgb, drawn(small(scenery, 3)).rgb);
    EXPECT_NE(one.rgb, drawn(small(scenery, 4)).rgb);
  }
  EXPECT_NE(drawn(small()).rgb, drawn(small(), &kHand, {}, 1).rgb);  // noise
  StageSpec still = small();
  still.sensor.noise = 0.0;
  EXPECT_EQ(drawn(still).rgb, drawn(still, &kHand, {}, 1).rgb);
}

TEST(Stage, APictureDoesNotDependOnThoseBefore) {
  Stage stage(small());
  Image left, right, again, other;
  stage.draw(&kHand, {}, {}, 5, left, right);
  stage.draw(nullptr, {}, {0.4, -1, {1, 0.5F, 0.5F}}, 6, again, other);
  PixelTruth truth;
  stage.draw(&kHand, {}, {}, 5, again, other, &truth);
  EXPECT_EQ(left.rgb, again.rgb);
  EXPECT_EQ(right.rgb, other.rgb);
  stage.draw(&kHand, {}, {}, 5, again, other);
  EXPECT_EQ(left.rgb, again.rgb);
}

// The picture of a stage with layers is that of one drawing of all geoms, wherever the things are: in front
// of the room, in it, or behind its wall.
TEST(Stage, LayersShowWhatIsDrawnAtOnce) {
  StageSpec spec = small(Scenery::clutter);
  spec.sensor.noise = 0.0;
  Stage stage(spec);
  const auto upright = [](Image picture) {
    Image flipped(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y)
      std::copy_n(picture.at(0, picture.height - 1 - y), 3 * picture.width, flipped.at(0, y));
    return flipped;
  };
  Image left, right, left_once, right_once, bare, other;
  PixelTruth truth, bare_truth;
  stage.draw(nullptr, {}, {}, 0, bare, other, &bare_truth);
  for (const double z : {0.4, 1.3, 1.5, 1.7, 1.9, 2.0, 2.1, 2.2, 2.3, 5.0}) {
    CameraScene shown;
    shown.hand = z < 2.0;
    shown.pose = kHand;
    shown.things = {{.shape = ThingShape::box, .at = {0, 0.15 * z, z}, .half = {0.3 * z, 0.1 * z, 0.2}},
                    {.shape = ThingShape::sphere, .at = {0.1 * z, 0, z}, .half = {0.1, 0.1, 0.1}}};
    shown.light.gain = z < 1.0 ? 0.8 : 1.0;
    stage.draw(shown, 0, left, right, &truth);
    stage.draw_at_once(shown, left_once, right_once);
    EXPECT_EQ(left.rgb, upright(left_once).rgb) << z;
    EXPECT_EQ(right.rgb, upright(right_once).rgb) << z;
    const bool hidden = z > 3.0;  // the wall is nearer
    EXPECT_EQ(std::count(truth.things.on.begin(), truth.things.on.end(), 255) == 0, hidden) << z;
    EXPECT_EQ(left.rgb == bare.rgb, hidden) << z;
    EXPECT_EQ(truth.depth == bare_truth.depth, hidden) << z;
  }
}

TEST(Stage, WhatIsExposedAgainHasTheNoiseOfItsFrame) {
  Stage stage(small());
  Image left, right, again, other;
  stage.again(7, again, other);
  EXPECT_TRUE(again.rgb.empty());  // nothing was drawn
  stage.draw(&kHand, {}, {}, 5, left, right);
  stage.again(7, again, other);
  EXPECT_NE(left.rgb, again.rgb);
  stage.draw(&kHand, {}, {}, 7, left, right);
  EXPECT_EQ(left.rgb, again.rgb);
  EXPECT_EQ(right.rgb, other.rgb);
}

// Values of a sensor are proportional to light, and end at 255.
TEST(Stage, LightExposureAndWhiteBalanceMultiply) {
  StageSpec spec = small();
  spec.sensor.noise = 0.0;
  const Image one = drawn(spec);
  const Image brighter = drawn(spec, &kHand, {1.6, 0, {1, 1, 1}});
  spec.sensor.exposure = 0.5;
  const Image half = drawn(spec);
  spec.sensor = {0.0, 1.0, {1.25F, 1, 0.5F}};
  const Image balanced = drawn(spec);
  for (std::size_t i = 0; i < one.rgb.size(); ++i) {
    EXPECT_NEAR(half.rgb[i], 0.5 * one.rgb[i], 1.01) << i;
    EXPECT_NEAR(brighter.rgb[i], std::min(255.0, 1.6 * one.rgb[i]), 2.01) << i;
    const double gain = i % 3 == 0 ? 1.25 : i % 3 == 1 ? 1.0 : 0.5;
    EXPECT_NEAR(balanced.rgb[i], std::min(255.0, gain * one.rgb[i]), 1.51) << i;
  }
}

TEST(Stage, TheLampsSideShows) {
  StageSpec spec = small();
  spec.sensor.noise = 0.0;
  Stage stage(spec);
  Image left_lit, right_lit, other;
  PixelTruth truth;
  stage.draw(&kHand, {}, {1, -1, {1, 1, 1}}, 0, left_lit, other, &truth);
  stage.draw(&kHand, {}, {1, 1, {1, 1, 1}}, 0, right_lit, other);
  const int row = static_cast<int>(std::lround(truth.row + 2 * truth.radius));
  int first = 0, last = 319;
  while (!truth.skin.at(first, row)) ++first;
  while (!truth.skin.at(last, row)) --last;
  EXPECT_GT(left_lit.at(first + 1, row)[0], right_lit.at(first + 1, row)[0] + 20);
  EXPECT_LT(left_lit.at(last - 1, row)[0] + 20, right_lit.at(last - 1, row)[0]);
}

TEST(Stage, AnOfficeHasNothingOfTheHueOfSkin) {
  for (const Scenery scenery : {Scenery::office, Scenery::clutter})
    for (int seed = 1; seed <= tests::thorough(2, 6); ++seed) {
      StageSpec spec = small(scenery, static_cast<std::uint64_t>(seed));
      spec.sensor.noise = 0.0;
      const Image office = drawn(spec, nullptr);
      int skin_hued = 0;
      for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 320; ++x) {
          const auto [h, saturation] = hue(office.view().at(x, y));
          skin_hued += saturation > 0.2 && office.view().at(x, y)[0] > 20 && (h < 50 || h > 345) ? 1 : 0;
        }
      EXPECT_EQ(skin_hued, 0) << seed;
    }
  int skin_hued = 0;
  const Image room = drawn(small(Scenery::skin_hued), nullptr);
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const auto [h, saturation] = hue(room.view().at(x, y));
      skin_hued += saturation > 0.2 && (h < 50 || h > 345) ? 1 : 0;
    }
  EXPECT_GT(skin_hued, 320 * 240 / 2);
}

TEST(Stage, SkinHasTheHueOfItsTone) {
  StageSpec spec = small();
  spec.sensor.noise = 0.0;
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  for (const SkinTone& tone : kSkinTones) {
    HandLook look{.skin = tone.colour};
    stage.draw(&kHand, look, {}, 0, left, right, &truth);
    double sum[3] = {0, 0, 0};
    for (std::size_t i = 0; i < truth.skin.on.size(); ++i)
      if (truth.skin.on[i] != 0)
        for (std::size_t c = 0; c < 3; ++c) sum[c] += left.rgb[3 * i + c];
    EXPECT_NEAR(sum[1] / sum[0], static_cast<double>(tone.colour[1] / tone.colour[0]), 0.04)
        << word_of(tone.tone);
    EXPECT_NEAR(sum[2] / sum[0], static_cast<double>(tone.colour[2] / tone.colour[0]), 0.04)
        << word_of(tone.tone);
  }
}

TEST(Stage, AHandFillsAsMuchAsItsDistanceSays) {
  Stage stage(small());
  Image left, right;
  PixelTruth truth;
  const auto share = [&](double z) {
    const HandPose hand{{0.25 * z, -0.15 * z, z}, {0.8, -0.6, 0}, 0.0};
    HandLook look{.bare = 0.2};
    stage.draw(&hand, look, {}, 0, left, right, &truth);
    return static_cast<double>(std::count(truth.skin.on.begin(), truth.skin.on.end(), 255)) / (320.0 * 240.0);
  };
  EXPECT_GT(share(0.30), 0.15);
  EXPECT_GT(share(0.45), 0.15);
  EXPECT_LT(share(0.90), 0.08);
}

TEST(Stage, TwoStagesLiveSideBySide) {
  const Image alone = drawn(small(Scenery::office, 1)), other_alone = drawn(small(Scenery::clutter, 2));
  Stage one(small(Scenery::office, 1));
  Image left, right;
  {
    Stage two(small(Scenery::clutter, 2));
    two.draw(&kHand, {}, {}, 0, left, right);
    EXPECT_EQ(left.rgb, other_alone.rgb);
    one.draw(&kHand, {}, {}, 0, left, right);
    EXPECT_EQ(left.rgb, alone.rgb);
    two.draw(&kHand, {}, {}, 0, left, right);
    EXPECT_EQ(left.rgb, other_alone.rgb);
  }
  one.draw(&kHand, {}, {}, 0, left, right);
  EXPECT_EQ(left.rgb, alone.rgb);
}

TEST(Stage, FinishChangesEdgesAndShadowsNotTheTruth) {
  StageSpec spec = small();
  spec.sensor.noise = 0.0;
  Stage plain(spec);
  spec.finish = {4, true, true};
  Stage fine(spec);
  Image a, b, other;
  PixelTruth truth_a, truth_b;
  plain.draw(&kHand, {}, {}, 0, a, other, &truth_a);
  fine.draw(&kHand, {}, {}, 0, b, other, &truth_b);
  EXPECT_NE(a.rgb, b.rgb);
  std::int64_t differ = 0;
  for (std::size_t i = 0; i < truth_a.skin.on.size(); ++i)
    differ += truth_a.skin.on[i] != truth_b.skin.on[i] ? 1 : 0;
  EXPECT_LT(differ, 320 * 240 / 200);
}

TEST(Stage, BadSpecsAreRefused) {
  const auto refused = [](auto change) {
    StageSpec spec = small();
    change(spec);
    EXPECT_THROW(const Stage stage(spec), Error);
  };
  refused([](StageSpec& s) { s.camera.width = 1; });
  refused([](StageSpec& s) { s.camera.left.focal_x = 0; });
  refused([](StageSpec& s) { s.camera.right.centre_y = kUnset; });
  refused([](StageSpec& s) { s.camera.X_CD = {}; });
  refused([](StageSpec& s) { s.sensor.noise = -1; });
  refused([](StageSpec& s) { s.finish.samples = 3; });
}

// This program again, as a child that draws with the other library: MuJoCo looks OpenGL up once a process.
std::vector<char> drawn_by(const char* kind) {
  const std::string file = testing::TempDir() + "stage_" + kind + "_" + std::to_string(getpid());
  const pid_t child = fork();
  if (child == 0) {
    setenv("ENCOUNTER_GL", kind, 1);
    setenv("ENCOUNTER_TEST_PICTURE", file.c_str(), 1);
    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // libOSMesa keeps 480 bytes of its own
    unsetenv("GTEST_TOTAL_SHARDS");
    unsetenv("GTEST_SHARD_INDEX");
    execl("/proc/self/exe", "test", "--gtest_filter=StageRenderer.Draws", "--gtest_brief=1", nullptr);
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << kind;
  std::ifstream in(file, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  unlink(file.c_str());
  return bytes;
}

// The fingertip in six frames of a moving hand, m; NaN without a find.
std::vector<double> followed() {
  Stage stage(small());
  Image left, right;
  PixelTruth truth;
  SkinLearner learner;
  stage.draw(&kHand, {}, {}, 100, left, right, &truth);
  learner.add(left.view(), truth.skin);
  SegmentationSpec segmentation;
  segmentation.model = learner.model();
  FingerTracker tracker(small().camera, segmentation, {}, {});
  std::vector<double> tips;
  for (std::uint64_t frame = 0; frame < 16; ++frame) {
    HandPose hand = kHand;
    hand.tip = Point<'C'>(Vec3(kHand.tip.e() + 0.01 * static_cast<double>(frame) * Vec3(0.3, 0.5, 0.8)));
    stage.draw(frame < 10 ? nullptr : &hand, {}, {}, frame, left, right);
    const Finger finger =
        tracker.see({left.view(), right.view()}, Time(from_seconds(0.05 * static_cast<double>(frame))));
    if (frame >= 10) tips.insert(tips.end(), finger.tip.xyz.begin(), finger.tip.xyz.end());
  }
  return tips;
}

TEST(Stage, AThreadWaitsUntilAnotherHasDrawn) {
  std::atomic<bool> drawn_by_then = false;
  std::thread thread;
  {
    const auto lock = drawing_lock();
    thread = std::thread([&] {
      drawn(small());
      drawn_by_then = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_FALSE(drawn_by_then);
  }
  thread.join();
  EXPECT_TRUE(drawn_by_then);
}

TEST(Stage, SeveralThreadsDrawTheSame) {
  const Image alone = drawn(small(Scenery::clutter, 3));
  const int times = tests::thorough(2, 5);
  std::array<int, 3> same{};
  std::vector<std::thread> threads;
  for (int& count : same)
    threads.emplace_back([&] {
      for (int i = 0; i < times; ++i) count += drawn(small(Scenery::clutter, 3)).rgb == alone.rgb ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : same) EXPECT_EQ(count, times);
}

TEST(StageRenderer, Draws) {
  const char* file = std::getenv("ENCOUNTER_TEST_PICTURE");
  if (file == nullptr) GTEST_SKIP() << "a part of EglAndOsMesaDrawTheSame";
  const Image picture = drawn(small(Scenery::clutter, 5));
  const std::vector<double> tips = followed();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(picture.rgb.data()),
             static_cast<std::streamsize>(picture.rgb.size()))
      .write(reinterpret_cast<const char*>(tips.data()),
             static_cast<std::streamsize>(tips.size() * sizeof(double)));
}

TEST(StageRenderer, EglAndOsMesaDrawTheSame) {
  constexpr std::size_t kPicture = 3UL * 320 * 240, kTips = 3 * 6;
  void* library = dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) GTEST_SKIP() << "libosmesa6 is not there";
  const std::vector<char> egl = drawn_by("egl"), mesa = drawn_by("osmesa");
  ASSERT_EQ(egl.size(), kPicture + kTips * sizeof(double));
  ASSERT_EQ(mesa.size(), egl.size());
  std::size_t differ = 0;
  int most = 0;
  for (std::size_t i = 0; i < kPicture; ++i) {
    const int d = std::abs(static_cast<unsigned char>(egl[i]) - static_cast<unsigned char>(mesa[i]));
    differ += d > 0 ? 1 : 0;
    most = std::max(most, d);
  }
  std::printf("EGL and OSMesa: %zu of %zu values differ, by at most %d of 255\n", differ, kPicture, most);
  // EGL with a graphics card draws slightly different edges.
  EXPECT_LT(differ, kPicture / 20);
  for (std::size_t i = 0; i < kTips; ++i) {
    double a = kUnset, b = kUnset;
    std::memcpy(&a, egl.data() + kPicture + i * sizeof(double), sizeof(double));
    std::memcpy(&b, mesa.data() + kPicture + i * sizeof(double), sizeof(double));
    EXPECT_NEAR(a, b, 0.002) << i;
  }
}

TEST(StageRenderer, AnUnknownOneIsRefused) {
  setenv("ENCOUNTER_GL", "vulkan", 1);
  EXPECT_THROW(const Stage stage(small()), Error);
  unsetenv("ENCOUNTER_GL");
}

// Positions in the stage's pictures: a fingertip's cap, both cameras, bent lenses, depth.

constexpr double kWidth = 0.020;  // m, of the finger

StageSpec still() {
  StageSpec spec;
  spec.sensor.noise = 0.0;
  return spec;
}

HandLook untapered() {
  HandLook look{.finger_width = kWidth, .taper = 1.0};
  return look;
}

// The middle of a sphere's outline in a picture, and its area.
struct Outline {
  double column, row, area;
};
Outline outline(const Lens& lens, const Vec3& centre, double radius) {
  const double share = radius * radius / centre.squaredNorm();
  const Vec3 a = centre.unitOrthogonal(), b = centre.normalized().cross(a);
  Outline o{0, 0, 0};
  std::array<double, 2> p{};
  for (int i = 0; i <= 720; ++i) {
    const double angle = std::numbers::pi * i / 360.0;
    const auto q = projected(lens, (1 - share) * centre + radius * std::sqrt(1 - share) *
                                                              (std::cos(angle) * a + std::sin(angle) * b));
    if (i > 0) {
      const double cross = 0.5 * (p[0] * q[1] - q[0] * p[1]);
      o.area += cross;
      o.column += cross * (p[0] + q[0]) / 3.0;
      o.row += cross * (p[1] + q[1]) / 3.0;
    }
    p = q;
  }
  return {o.column / o.area, o.row / o.area, std::abs(o.area)};
}

// The cap of a finger that points at the camera hides the finger: pixels as near as its middle.
Outline seen(const Lens& lens, const PixelTruth& truth, double distance) {
  Outline o{0, 0, 0};
  for (int y = 0; y < truth.skin.height; ++y)
    for (int x = 0; x < truth.skin.width; ++x) {
      if (!truth.skin.at(x, y)) continue;
      const auto [u, v] =
          undistorted(lens, (x - lens.centre_x) / lens.focal_x, (y - lens.centre_y) / lens.focal_y);
      const auto at = static_cast<std::size_t>(y * truth.skin.width + x);
      if (Vec3(u, v, 1.0).norm() * static_cast<double>(truth.depth[at]) > distance) continue;
      o.column += x;
      o.row += y;
      o.area += 1.0;
    }
  return {o.column / o.area, o.row / o.area, o.area};
}

void expect_in_place(const StageSpec& spec) {
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  for (const Vec3& tip :
       {Vec3(0, 0, 0.3), Vec3(-0.08, -0.05, 0.3), Vec3(0.15, 0.09, 0.45), Vec3(-0.14, 0.10, 0.42)}) {
    const HandPose hand{Point<'C'>(tip), Vec<'C'>(Vec3(-tip)), 0.3};
    stage.draw(&hand, untapered(), {}, 0, left, right, &truth);
    const Outline there = seen(spec.camera.left, truth, tip.norm() + 0.001),
                  wanted = outline(spec.camera.left, tip, 0.5 * kWidth);
    EXPECT_NEAR(there.column, wanted.column, 0.1) << tip.transpose();
    EXPECT_NEAR(there.row, wanted.row, 0.1) << tip.transpose();
    EXPECT_NEAR(there.area / wanted.area, 1.0, 0.02) << tip.transpose();
    EXPECT_NEAR(truth.radius, std::sqrt(wanted.area / std::numbers::pi), 0.01);
    EXPECT_NEAR(truth.column, projected(spec.camera.left, tip)[0], 1e-9);
  }
}

TEST(StageGeometry, TheCapIsWhereAPinholeHasIt) { expect_in_place(still()); }

TEST(StageGeometry, AnOffAxisCameraWithUnequalFocalLengths) {
  StageSpec spec = still();
  spec.camera.left = {690.0, 702.0, 341.7, 228.2, {}};
  expect_in_place(spec);
}

TEST(StageGeometry, ABentLens) {
  StageSpec spec = still();
  spec.camera.left = {690.0, 702.0, 341.7, 228.2, {-0.25, 0.08, 0.001, -0.0008, 0.01}};
  expect_in_place(spec);
}

// The stage gives no truth for the right camera. So another stage looks through the same lens as left camera,
// from the right one's place: its cap has the same pixels, which are those that differ from the background.
TEST(StageGeometry, TheRightCameraIsWhereItsPoseSays) {
  StageSpec spec = still();
  spec.camera.X_CD = {Quat(Eigen::AngleAxisd(0.05, Vec3(0.3, -1.0, 0.4).normalized())),
                      Vec3(0.090, 0.004, -0.006)};
  spec.camera.right = {700.0, 703.0, 325.0, 230.0, {}};
  StageSpec turned = still();
  turned.camera.left = spec.camera.right;
  Stage stage(spec), from_there(turned);
  Image left, with, without;
  stage.draw(nullptr, {}, {}, 0, left, without);
  for (const Vec3& tip : {Vec3(0.06, 0.0, 0.42), Vec3(0.10, -0.05, 0.5), Vec3(-0.03, 0.03, 0.45)}) {
    const HandPose hand{Point<'C'>(tip), {0, -1, 0}, 0.0};
    stage.draw(&hand, untapered(), {}, 0, left, with);
    const Pose<'D', 'C'> X_DC = spec.camera.X_CD.inverse();
    const HandPose seen_there{Point<'C'>((X_DC * hand.tip).e()), Vec<'C'>((X_DC * hand.along).e()), 0.0};
    PixelTruth truth;
    Image other;
    from_there.draw(&seen_there, untapered(), {}, 0, left, other, &truth);
    int cap = 0, differ = 0;
    for (int y = 0; y < truth.row + truth.radius; ++y)
      for (int x = 0; x < 640; ++x) {
        const bool on = !std::equal(with.at(x, y), with.at(x, y) + 3, without.at(x, y));
        cap += on ? 1 : 0;
        differ += on != truth.skin.at(x, y) ? 1 : 0;
      }
    EXPECT_GT(cap, 500);
    EXPECT_LE(differ, 4) << tip.transpose();  // out of about 60 along its edge: 0.1 px
  }
}

// A pinhole gives the place of a ball; a rod and a box have their true size; nothing counts as skin.
TEST(StageGeometry, ThingsAreWhereTheyAreShown) {
  const StageSpec spec = still();
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  const auto pixels = [&](const CameraScene& shown) {
    stage.draw(shown, 0, left, right, &truth);
    Outline o{0, 0, 0};
    for (int y = 0; y < truth.things.height; ++y)
      for (int x = 0; x < truth.things.width; ++x) {
        if (!truth.things.at(x, y)) continue;
        o = {o.column + x, o.row + y, o.area + 1.0};
      }
    return Outline{o.column / o.area, o.row / o.area, o.area};
  };
  CameraScene shown;
  const Vec3 at(0.05, -0.03, 0.5);
  shown.things = {{ThingShape::sphere, Point<'C'>(at), Mat3::Identity(), {0.03, 0, 0}, {0.1F, 0.6F, 0.2F}}};
  const Outline ball = pixels(shown), wanted = outline(spec.camera.left, at, 0.03);
  EXPECT_NEAR(ball.column, wanted.column, 0.1);
  EXPECT_NEAR(ball.row, wanted.row, 0.1);
  EXPECT_NEAR(ball.area / wanted.area, 1.0, 0.01);

  const double px = spec.camera.left.focal_x / 0.5;  // px per metre at that depth
  const Mat3 along_x = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()).toRotationMatrix();
  shown.things = {{ThingShape::capsule, Point<'C'>(0, 0, 0.5), along_x, {0.004, 0, 0.06}, {}}};
  const double edge = 0.5 / px * (2.0 * 0.12 + 2.0 * M_PI * 0.004);  // half a pixel all round
  EXPECT_NEAR(pixels(shown).area / (px * px), 0.12 * 0.008 + M_PI * 0.004 * 0.004, edge);
  shown.things = {{ThingShape::box, Point<'C'>(0, 0, 0.5), Mat3::Identity(), {0.04, 0.02, 1e-4}, {}}};
  EXPECT_NEAR(pixels(shown).area / (px * px), 0.08 * 0.04, 0.5 / px * 2.0 * (0.08 + 0.04));  // half a px, too

  // The nearer object hides the one behind it.
  shown.hand = true;
  shown.pose = {Point<'C'>(0, 0, 0.45), {0, -1, 0}, 0.0};
  const double shown_box = pixels(shown).area;
  EXPECT_LT(shown_box / (px * px), 0.9 * 0.08 * 0.04);
  for (int y = 0; y < truth.things.height; ++y)
    for (int x = 0; x < truth.things.width; ++x) ASSERT_FALSE(truth.things.at(x, y) && truth.skin.at(x, y));
  shown.things.clear();
  EXPECT_TRUE(std::isnan(pixels(shown).row));  // nothing is left of it
}

// r = K / z with K = f R [VisHap 2.1.2].
TEST(StageGeometry, TheOutlinesRadiusFollowsTheDepth) {
  const StageSpec spec = still();
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  for (double z = 0.3; z <= 0.9; z += 0.1)
    for (const double x : {-0.1, 0.0, 0.1}) {
      const HandPose hand{{x, 0.02, z}, {0, -1, 0}, 0.0};
      stage.draw(&hand, untapered(), {}, 0, left, right, &truth);
      const double expected = spec.camera.left.focal_x * 0.5 * kWidth / z;
      EXPECT_NEAR(truth.radius, expected, 1.0);
      // The picture agrees: measured across the finger behind its cap, where it is round.
      int wide = 0;
      const int row = static_cast<int>(std::lround(truth.row));
      for (int c = 0; c < 640; ++c) wide += truth.skin.at(c, row) ? 1 : 0;
      if (x != 0.0) continue;
      EXPECT_NEAR(0.5 * wide, expected, 1.0) << z;
    }
}

TEST(StageGeometry, TheMaskAgreesWithTheDepth) {
  Stage stage(still());
  Image left, right;
  PixelTruth truth;
  const HandPose hand{{0.02, -0.02, 0.4}, {0.3, -1, 0.1}, 0.4};
  HandLook look;
  look.bare = 0.4;  // no sleeve in the picture
  stage.draw(&hand, look, {}, 0, left, right, &truth);
  std::int64_t skin = 0;
  for (std::size_t i = 0; i < truth.depth.size(); ++i) {
    EXPECT_EQ(truth.skin.on[i] != 0, truth.depth[i] < 0.7F) << i;
    skin += truth.skin.on[i] != 0 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(skin), 0.05 * 640 * 480);
  const auto at = static_cast<std::size_t>(std::lround(truth.row) * 640 + std::lround(truth.column));
  EXPECT_NEAR(static_cast<double>(truth.depth[at]), 0.4 - 0.008, 2e-4);  // the cap's nearest point
  stage.draw(nullptr, look, {}, 0, left, right, &truth);
  for (const std::uint8_t on : truth.skin.on) ASSERT_EQ(on, 0);
  EXPECT_TRUE(std::isnan(truth.radius));
}

}  // namespace
}  // namespace enc::sim
