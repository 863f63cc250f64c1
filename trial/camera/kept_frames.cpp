#include "trial/camera/kept_frames.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::trial {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code none;
  return fs::exists(path, none);
}

// Refuses a folder with frames, because frames of two runs would mix into one sequence.
const std::string& without_frames(const std::string& folder) {
  for (const char* side : {"left", "right"}) {
    if (is_there(fs::path(folder) / side))
      throw Error(fmt::format("{}: there is a '{}' in it; expected a folder without frames; name a new one",
                              folder, side));
  }
  return folder;
}

Time exposure_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::int64_t nanoseconds = -1;
  const auto [end, bad] = std::from_chars(stem.data(), stem.data() + stem.size(), nanoseconds);
  if (bad != std::errc() || end != stem.data() + stem.size() || nanoseconds < 0)
    throw Error(
        fmt::format("{}: is named by no time of exposure; expected frames as `run --frames` keeps "
                    "them; name such a folder",
                    file.string()));
  return Time(Duration(nanoseconds));
}

}  // namespace

KeepingCamera::KeepingCamera(std::unique_ptr<StereoCamera> camera, const std::string& folder,
                             const FrameFiles& files)
    : camera_(std::move(camera)),
      path_(without_frames(folder)),
      made_(!is_there(path_)),
      folder_(path_),
      left_(path_ + "/left"),
      right_(path_ + "/right"),
      files_(files) {}

KeepingCamera::~KeepingCamera() {
  std::error_code kept;  // only empty folders are removed
  fs::remove(path_ + "/left", kept);
  fs::remove(path_ + "/right", kept);
  if (made_) fs::remove(path_, kept);
}

bool KeepingCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  if (!camera_->poll(now, newest)) return false;
  if (newest.health != Health::ok || !failure_.empty()) return true;
  try {
    const std::int64_t exposed = newest.t.time_since_epoch().count();
    for (const auto& [side, image] : {std::pair{"left", newest.value.left}, {"right", newest.value.right}})
      models::write_file(fmt::format("{}/{}/{}.png", path_, side, exposed), files_.png(image),
                         models::OverwritePolicy::keep);
  } catch (const std::exception& e) {
    failure_ = e.what();
  }
  return true;
}

std::vector<std::string> KeepingCamera::remarks() const {
  std::vector<std::string> lines = camera_->remarks();
  if (!failure_.empty()) lines.push_back("frames are kept no more: " + failure_);
  return lines;
}

std::vector<Time> exposures_in(const std::string& folder) {
  std::vector<Time> exposed;
  std::error_code failed;
  for (fs::directory_iterator entry(fs::path(folder) / "left", failed), end; !failed && entry != end;
       entry.increment(failed))
    if (entry->path().extension() != ".part")  // left by a killed run
      exposed.push_back(exposure_of(entry->path()));
  if (failed || exposed.empty())
    throw Error(
        fmt::format("{}: has no frames in 'left'; expected frames as `run --frames` keeps them; "
                    "name such a folder",
                    folder));
  std::sort(exposed.begin(), exposed.end());
  return exposed;
}

bool KeptCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  const auto next = static_cast<std::size_t>(played_.n);
  if (next == exposed_.size() || exposed_[next] > now) return false;
  Measurement<StereoFrame> frame;
  const bool there = camera_->poll(played_.next(), frame);
  ++played_.n;
  if (!there || frame.health != Health::ok) return false;
  newest = {frame.value, exposed_[next], Health::ok};
  return true;
}

}  // namespace enc::trial
