#include "hw_drivers/images/play/image_camera.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::images {

ImageCamera::ImageCamera(const Reel& reel, Log& log, bool waits) {
  try {
    std::unique_ptr<FrameSource> source = open_reel(reel);
    size_ = source->size();
    words_ = fmt::format("images {}: {} x {} px each at {:.4g} Hz", source->words(), size_.width,
                         size_.height, reel.rate);
    playback_ = std::make_unique<Playback>(
        std::move(source), reel.rate, [&log](const std::string& line) { log.say("images " + line); }, waits);
  } catch (const Error& e) {
    throw Error(e.what(), {}, ErrorKind::device);
  }
}

bool ImageCamera::poll(Time now, Stamped<StereoFrame>& newest) noexcept {
  using State = Playback::State;
  // The end comes after the last frame, though both may be known at once.
  const bool newer = playback_->take(now);
  const State state = newer ? State::playing : playback_->state();
  if (!newer && state == told_) return false;
  told_ = state;
  const ImagePair& frame = playback_->frame();
  newest = {{frame.left.view(), frame.right.view()},
            playback_->exposed(),
            state == State::playing  ? Health::ok
            : state == State::failed ? Health::fault
                                     : Health::stale};
  return true;
}

}  // namespace enc::images
