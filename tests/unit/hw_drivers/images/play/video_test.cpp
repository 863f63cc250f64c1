// A video through ffmpeg, of which a shell script plays the part: what is read, and that no child is left.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/images/play/frame_source.h"
#include "tests/support/temporary_folder.h"

namespace enc::images {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Video : public testing::Test {
 protected:
  Video() : path_(std::getenv("PATH")) {
    reel_.path = folder_.file("film.mp4");
    std::ofstream(reel_.path) << "a film";
    setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1);
  }
  ~Video() override { setenv("PATH", path_.c_str(), 1); }
  void ffmpeg(const std::string& script) const {
    std::ofstream(folder_.file("ffmpeg")) << "#!/bin/sh\necho $$ >" << folder_.file("pid") << "\n" << script;
    std::filesystem::permissions(folder_.file("ffmpeg"), std::filesystem::perms::owner_all);
  }
  [[nodiscard]] bool child_is_there() const {
    int pid = 0;
    std::ifstream(folder_.file("pid")) >> pid;
    return pid > 0 && kill(pid, 0) == 0;  // a zombie is there, too
  }
  // Of opening it and reading it to the end.
  [[nodiscard]] std::string refusal() const {
    try {
      const std::unique_ptr<FrameSource> source = open_reel(reel_);
      ImagePair pair;
      while (source->next(pair)) {
      }
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
      return e.what();
    }
    return {};
  }
  test::TemporaryFolder folder_;
  std::string path_;
  Reel reel_;
};

const std::string kFrame = "printf 'P6\\n4 2\\n255\\n'; printf 'aaaaaabbbbbbccccccdddddd'\n";
const std::string kOther = "printf 'P6\\n4 2\\n255\\n'; printf 'AAAAAABBBBBBCCCCCCDDDDDD'\n";

TEST_F(Video, FramesAreSplitAndRead) {
  ffmpeg(kFrame + kOther);
  const std::unique_ptr<FrameSource> source = open_reel(reel_);
  EXPECT_EQ(source->size(), (ImageSize{2, 2}));
  ImagePair pair;
  ASSERT_TRUE(source->next(pair));
  EXPECT_EQ(std::string(pair.left.rgb.begin(), pair.left.rgb.end()), "aaaaaacccccc");
  EXPECT_EQ(std::string(pair.right.rgb.begin(), pair.right.rgb.end()), "bbbbbbdddddd");
  ASSERT_TRUE(source->next(pair));
  EXPECT_EQ(pair.left.rgb[0], 'A');
  EXPECT_FALSE(source->next(pair));
}

TEST_F(Video, RepeatsAndStartsLater) {
  ffmpeg(kFrame + kOther);
  reel_.repeat = true;
  reel_.start = 1;
  const std::unique_ptr<FrameSource> source = open_reel(reel_);
  std::string firsts;
  ImagePair pair;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(source->next(pair));
    firsts += static_cast<char>(pair.left.rgb[0]);
  }
  EXPECT_EQ(firsts, "AaAaA");
  reel_.start = 2;
  EXPECT_THAT(refusal(), HasSubstr("has 2 frames and start is 2"));
}

TEST_F(Video, TheChildIsGoneWithTheSource) {
  ffmpeg(kFrame + "exec sleep 1000\n");
  {
    const std::unique_ptr<FrameSource> source = open_reel(reel_);
    EXPECT_TRUE(child_is_there());
  }
  EXPECT_FALSE(child_is_there());
}

// A script that waits for another program: both are ended, or the pipe would stay open.
TEST_F(Video, StopEndsAReadThatWaits) {
  ffmpeg(kFrame + "sleep 1000\n");
  const std::unique_ptr<FrameSource> source = open_reel(reel_);
  ImagePair pair;
  ASSERT_TRUE(source->next(pair));
  bool more = true;
  std::thread reader([&] { more = source->next(pair); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  source->stop();
  reader.join();
  EXPECT_FALSE(more);
}

TEST_F(Video, WhatFfmpegSaysIsInTheLine) {
  ffmpeg("echo 'film.mp4: Invalid data found' >&2\nexit 1\n");
  EXPECT_THAT(refusal(), AllOf(StartsWith(reel_.path), HasSubstr("Invalid data found")));
  ffmpeg(kFrame + "echo 'moov atom broken' >&2\nexit 1\n");
  EXPECT_THAT(refusal(), HasSubstr("ffmpeg stopped: moov atom broken"));
  ffmpeg(kFrame + "echo '[mov,mp4 @ 0x55d0c0de] moov atom broken' >&2\nexit 1\n");
  EXPECT_THAT(refusal(), HasSubstr("ffmpeg stopped: moov atom broken"));
  ffmpeg(kFrame + "printf 'P6\\n4 2\\n255\\n'; printf 'abc'\nkill -9 $$\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("cut off within a frame"), HasSubstr("signal 9")));
  ffmpeg("exit 0\n");
  EXPECT_THAT(refusal(), HasSubstr("finds no frame"));
  ffmpeg(kFrame + "printf 'P6\\n6 2\\n255\\n'; printf 'aaaaaaaaabbbbbbbbbccccccccczzzzzzzzz'\n");
  EXPECT_THAT(refusal(), HasSubstr("a frame is 6 x 2 px; expected 4 x 2"));
  ffmpeg("printf 'P6\\n5 1\\n255\\n'; printf 'aaaaaaaaabbbbbb'\n");
  EXPECT_THAT(refusal(), HasSubstr("is 5 px wide; expected two images side by side"));
  ffmpeg("printf 'P6\\n99999 99999\\n255\\n'\n");
  EXPECT_THAT(refusal(), HasSubstr("not to be had"));
  ffmpeg("printf 'this is certainly no image, is it? no, it is not'\n");
  EXPECT_THAT(refusal(), HasSubstr("is no PPM image"));
}

TEST_F(Video, WithoutFfmpegOneLineSaysWhatToDo) {
  setenv("PATH", folder_.path().c_str(), 1);
  EXPECT_THAT(refusal(), AllOf(StartsWith(reel_.path), HasSubstr("apt-get install ffmpeg"),
                               HasSubstr("folder of PNG or JPEG")));
}

}  // namespace
}  // namespace enc::images
