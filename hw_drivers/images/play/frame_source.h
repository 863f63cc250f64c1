// A source of stereo frames: a folder of images, or a video that ffmpeg reads. A source may block, so a
// separate thread reads it (image_camera.h).
#pragma once

#include <memory>
#include <string>

#include "hw_drivers/images/files/pair_list.h"

namespace enc::images {

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // The next pair, of size(); false at the end. Throws Error in one line. `into` keeps its memory.
  virtual bool next(ImagePair& into) = 0;
  [[nodiscard]] virtual ImageSize size() const = 0;  // each image
  [[nodiscard]] virtual std::string words() const = 0;
  // Call from another thread: a waiting next() returns soon, and all later ones return false.
  virtual void stop() noexcept {}
};

// [driver.images]
struct Reel {
  std::string path;
  Layout layout = Layout::pairs;
  double rate = 20.0;      // Hz
  std::int64_t start = 0;  // number of the first frame
  bool repeat = false;
};

// Checks everything that can be checked beforehand. Throws Error in one line.
[[nodiscard]] std::unique_ptr<FrameSource> open_reel(const Reel& reel);

}  // namespace enc::images
