// The fake cameras against a program by other authors: v4l2-ctl of v4l-utils.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hw_drivers/v4l2/drive/offered.h"
#include "hw_drivers/v4l2/fake/server.h"
#include "hw_drivers/v4l2/wire/relay.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

// A fake camera that answers until this object is destroyed.
class AnsweringCamera {
 public:
  AnsweringCamera(const std::string& name, v4l2::NodeSpec spec) : door_(name, std::move(spec)) {
    thread_ = std::thread([this] {
      while (!end_) {
        door_.serve();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~AnsweringCamera() {
    end_ = true;
    thread_.join();
  }
  AnsweringCamera(const AnsweringCamera&) = delete;
  AnsweringCamera& operator=(const AnsweringCamera&) = delete;

 private:
  v4l2::Door door_;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

// The output of --list-formats-ext in the words of the driver (drive/offered.h).
std::string listed_by(const std::string& output) {
  std::string all, format, size;
  std::vector<double> rates;
  const auto close_size = [&] {
    if (size.empty()) return;
    std::sort(rates.begin(), rates.end());
    all += (all.empty() ? "" : "; ") + format + " " + size;
    for (std::size_t i = 0; i < rates.size(); ++i)
      all += fmt::format("{}{:.4g}", i == 0 ? " at " : ", ", rates[i]);
    all += rates.empty() ? "" : " Hz";
    size.clear();
    rates.clear();
  };
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t named = line.find("]: '"), sized = line.find("Size: Discrete ");
    const std::size_t rated = line.find("Interval") == std::string::npos ? line.npos : line.find(" (");
    if (named != line.npos || sized != line.npos) close_size();
    if (named != line.npos) format = line.substr(named + 4, 4);
    if (sized != line.npos) size = line.substr(sized + 15);
    if (sized != line.npos) size.replace(size.find('x'), 1, " x ");
    if (rated != line.npos) rates.push_back(std::stod(line.substr(rated + 2)));
  }
  close_size();
  return all;
}

TEST(VideoForeign, V4l2CtlListsWhatTheDriverLists) {
  const std::string control = "/usr/bin/v4l2-ctl";
  if (!std::filesystem::exists(control)) GTEST_SKIP() << "no " << control << ": ./check installs it";
  const std::string name = fmt::format("@encounter-test-{}", ::getpid());
  using v4l2::Pixels;
  const AnsweringCamera camera(name, {.card = "Two eyes",
                                      .modes = {{Pixels::yuyv, 640, 480, 20.0},
                                                {Pixels::yuyv, 640, 480, 7.5},
                                                {Pixels::yuyv, 1280, 480, 10.0},
                                                {Pixels::mjpeg, 1280, 480, 30.0},
                                                {Pixels::grey, 320, 240, 60.0}}});
  const auto system = v4l2::relayed();
  const int descriptor = system->open(name);
  ASSERT_GE(descriptor, 0);
  const std::string offered = v4l2::offered_by(*system, descriptor);
  system->close(descriptor);
  const TemporaryFolder folder;
  const std::string file = folder.file("video0");
  std::ofstream{file};
  const auto says = [&](const std::string& what) {
    const tests::Result result = tests::run({control, "-d", file, what},
                                            {{"LD_PRELOAD", tests::module_folder() + "/../video_preload.so"},
                                             {"ENCOUNTER_VIDEO_FILE", file},
                                             {"ENCOUNTER_VIDEO_SOCKET", name}});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    return result.out;
  };
  EXPECT_EQ(listed_by(says("--list-formats-ext")), offered);
  EXPECT_THAT(offered, testing::StartsWith("YUYV 640 x 480 at 7.5, 20 Hz; YUYV 1280 x 480 at 10 Hz; "));
  EXPECT_THAT(says("--info"), testing::HasSubstr("Two eyes"));
}

}  // namespace
}  // namespace enc::test
