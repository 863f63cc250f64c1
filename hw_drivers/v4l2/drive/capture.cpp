#include "hw_drivers/v4l2/drive/capture.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/fake.h"

namespace enc::v4l2 {
namespace {

constexpr int kMostDamaged = 64;  // frames in a row: then the device is opened again

// Half a period, and 1 % of a period for the jitter of stamps: a frame that is farther away has a nearer
// neighbour.
Duration apart_of(const V4l2Settings& settings, double rate) {
  const double half = 0.51 / rate;
  return from_seconds(settings.apart > 0.0 ? std::min(settings.apart, half) : half);
}

}  // namespace

Capture::Capture(System& system, const V4l2Settings& settings, ImageSize each, double rate)
    : system_(system),
      settings_(settings),
      each_(each),
      rate_(rate),
      pairs_(from_seconds(1.0 / rate), apart_of(settings, rate)) {
  if (settings_.left == settings_.right)
    throw Error(settings_.left +
                    ": is named as left and right; expected two devices; leave `right` out if one device "
                    "sends both images side by side",
                {}, ErrorKind::device);
  open();
}

void Capture::open() {
  StreamRequest wanted{settings_.pixels(), two() ? each_.width : 2 * each_.width, each_.height, rate_,
                       static_cast<int>(settings_.buffers)};
  if (wanted.pixels == Pixels::yuyv && each_.width % 2 != 0)
    throw Error(fmt::format("{}: an image of {} px cannot be YUYV, whose colour is for two columns; expected "
                            "an even width; set format",
                            settings_.left, each_.width),
                {}, ErrorKind::device);
  std::array<std::unique_ptr<VideoDevice>, 2> devices;
  devices[0] = std::make_unique<VideoDevice>(system_, settings_.left, wanted);
  if (two()) devices[1] = std::make_unique<VideoDevice>(system_, settings_.right, wanted);
  devices_ = std::move(devices);
  fake_ = true;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (!devices_[i]) continue;
    for (RawFrame& frame : sides_[i].frames) frame.bytes.resize(devices_[i]->frame_bytes());
    fake_ = fake_ && devices_[i]->card().starts_with(kFakeName);
  }
  pairs_.forget();
  any_ = false;
  damaged_in_a_row_ = 0;
  heard_ = system_.now();
}

std::string Capture::describe() const {
  const std::string names = devices_[0]->name() + (two() ? " and " + devices_[1]->name() : "");
  return fmt::format("{} camera {}, {}", two() ? "paired" : "side-by-side", names, devices_[0]->form());
}

std::string Capture::remark(const CaptureCounts& counts) const {
  std::string text =
      fmt::format("v4l2 {}: {} pairs, {} frames lost, {} damaged, {} pairs replaced by a newer one",
                  settings_.left, counts.pairs, counts.lost, counts.damaged, counts.replaced);
  if (two())
    text += fmt::format(
        ", {} left frames without a partner; the stamps of a pair are {:.3f} ms apart on "
        "average, {:.3f} ms at most",
        counts.unpaired, 1e3 * counts.errors.mean(), 1e3 * counts.errors.largest);
  if (counts.gone > 0) text += fmt::format("; it was unplugged {}", counted(counts.gone, "time"));
  return text;
}

void Capture::reopen() {
  if (!there()) open();
}

void Capture::close() {
  ++counts_.gone;
  for (std::unique_ptr<VideoDevice>& device : devices_) {
    if (device) lost_before_ += device->lost();
    device.reset();
  }
}

// Takes every frame that waits. The number is limited, because a faulty device may never be empty.
void Capture::drain(std::size_t side) {
  constexpr int kMost = 64;
  VideoDevice& device = *devices_[side];
  for (int i = 0; i < kMost; ++i) {
    Side& of = sides_[side];
    RawFrame& frame = of.frames[of.next];
    const VideoDevice::TakeResult taken = device.take(frame);
    if (taken == VideoDevice::TakeResult::nothing) return;
    if (taken == VideoDevice::TakeResult::damaged) {
      ++counts_.damaged;
      ++damaged_in_a_row_;
    }
    if (taken == VideoDevice::TakeResult::gone || damaged_in_a_row_ >= kMostDamaged) return close();
    if (taken != VideoDevice::TakeResult::frame) continue;
    damaged_in_a_row_ = 0;
    const Shot shot{frame.stamp, of.next};
    of.next = (of.next + 1) % kSlots;
    if (!two()) {
      counts_.replaced += any_ ? 1 : 0;
      single_ = shot;
      any_ = true;
    } else if (side == 0) {
      pairs_.add_left(shot);
    } else {
      pairs_.add_right(shot);
    }
  }
}

bool Capture::newest(ShotPair& pair) {
  if (!two()) {
    pair = {single_, single_};
    return std::exchange(any_, false);
  }
  bool found = false;
  while (pairs_.next(pair)) {
    counts_.replaced += found ? 1 : 0;
    found = true;
  }
  counts_.unpaired = pairs_.unpaired();
  counts_.errors = pairs_.errors();
  return found;
}

bool Capture::decode(const ShotPair& pair, StereoPicture& into) {
  into.exposed = pair.stamp() - from_seconds(settings_.stamp_late);
  const RawFrame& left = sides_[0].frames[pair.left.slot];
  const Raster& raster = devices_[0]->raster();
  if (!two()) return decoder_.halves(left.view(), raster, into.left, into.right);
  const RawFrame& right = sides_[1].frames[pair.right.slot];
  return decoder_.whole(left.view(), raster, into.left) &&
         decoder_.whole(right.view(), devices_[1]->raster(), into.right);
}

bool Capture::turn(Duration most, StereoPicture& into) {
  if (!there()) return false;
  std::array<int, 2> descriptors{devices_[0]->descriptor(), -1};
  if (two()) descriptors[1] = devices_[1]->descriptor();
  system_.wait(std::span(descriptors).first(two() ? 2 : 1), most);
  for (std::size_t side = 0; side < 2 && there(); ++side)
    if (devices_[side]) drain(side);
  if (!there()) return false;
  counts_.lost = lost_before_;
  for (const std::unique_ptr<VideoDevice>& device : devices_) counts_.lost += device ? device->lost() : 0;
  ShotPair pair;
  if (!newest(pair)) return false;
  if (!decode(pair, into)) {
    ++counts_.damaged;
    return false;
  }
  ++counts_.pairs;
  heard_ = system_.now();
  return true;
}

}  // namespace enc::v4l2
