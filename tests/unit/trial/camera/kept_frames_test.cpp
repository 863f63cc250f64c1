// The folder in which a run keeps its camera's frames: a run without a frame leaves nothing behind.
#include "trial/camera/kept_frames.h"

#include <filesystem>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/files.h"

namespace enc::trial {
namespace {

namespace fs = std::filesystem;

struct OneFrame final : StereoCamera {
  Image image{4, 3};
  bool told = true;
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
    if (std::exchange(told, true)) return false;
    newest = {{image.view(), image.view()}, now, Health::ok};
    return true;
  }
  [[nodiscard]] std::string describe() const override { return "one frame"; }
};

std::string some_bytes(const ImageView& /*image*/) { return "bytes"; }
constexpr FrameFiles kFiles{.png = some_bytes};

std::unique_ptr<KeepingCamera> keeping(const std::string& folder, bool with_a_frame) {
  auto camera = std::make_unique<OneFrame>();
  camera->told = !with_a_frame;
  return std::make_unique<KeepingCamera>(std::move(camera), folder, kFiles);
}

TEST(KeptFrames, ARunWithoutAFrameLeavesNoFolderBehind) {
  const test::TemporaryFolder root;
  const std::string made = root.file("new"), there = root.file("there");
  Measurement<StereoFrame> frame;
  EXPECT_FALSE(keeping(made, false)->poll(Time{}, frame));
  EXPECT_FALSE(fs::exists(made));
  fs::create_directory(there);
  EXPECT_FALSE(keeping(there, false)->poll(Time{}, frame));
  EXPECT_TRUE(fs::is_empty(there)) << "what was there stays, as it was";
}

TEST(KeptFrames, WhatWasSeenStays) {
  const test::TemporaryFolder root;
  const std::string folder = root.file("run");
  Measurement<StereoFrame> frame;
  EXPECT_TRUE(keeping(folder, true)->poll(Time(Duration(50)), frame));
  EXPECT_TRUE(fs::exists(folder + "/left/50.png"));
  EXPECT_TRUE(fs::exists(folder + "/right/50.png"));
  EXPECT_THROW(keeping(folder, true), Error) << "frames of two runs would be one sequence";
  EXPECT_TRUE(fs::exists(folder + "/left/50.png"));
}

}  // namespace
}  // namespace enc::trial
