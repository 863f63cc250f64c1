// A stereo camera that plays files: a folder of PNG or JPEG images, or a video through ffmpeg. It plays the
// recorded frames at a set rate, identically in every run.
#include "core/devices/module.h"
#include "hw_drivers/images/play/image_camera.h"

namespace enc::images {
namespace {

constexpr std::array<std::string_view, 2> kRepeat{"no", "yes"};

// [driver.images] of the rig file.
struct Wire {
  Reel reel;
  std::string layout{word_of(Layout::pairs)}, repeat = "no";

  void declare(Settings& table) {
    table.value({.name = "path",
                 .meaning = "folder of PNG or JPEG images, or a video; relative to the folder in which the "
                            "program was started",
                 .needed = true},
                reel.path);
    table.value({.name = "layout",
                 .meaning = "layout of a folder: pairs (left01.png, right01.png) or both halves in one "
                            "image; a video always has the latter",
                 .words = kWords<Layout>},
                layout);
    table.value({.name = "rate_hz", .meaning = "frames per second", .low = 0.1, .high = 1000.0}, reel.rate);
    table.value({.name = "repeat", .meaning = "repeat from the beginning at the end", .words = kRepeat},
                repeat);
    table.value({.name = "start", .meaning = "number of the first frame, from 0", .low = 0, .high = 1e9},
                reel.start);
  }
  explicit Wire(const Offer& offer) {
    declare(offer.table);
    reel.layout = layout == word_of(Layout::pairs) ? Layout::pairs : Layout::side_by_side;
    reel.repeat = repeat == "yes";
  }
  Wire() = default;
};

std::unique_ptr<StereoCamera> make_camera(const Offer& offer) {
  return std::make_unique<ImageCamera>(Wire(offer).reel, offer.log, offer.waits);
}

constexpr DriverModule kDriver{
    .settings = [](Settings& table) { Wire{}.declare(table); }, .camera = make_camera, .plays = true};
constexpr FrameFiles kFrames{.png = png_of};
constexpr ModuleInfo kInfo{.name = "images", .driver = &kDriver, .frames = &kFrames};

}  // namespace
}  // namespace enc::images

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::images::kInfo;
}
