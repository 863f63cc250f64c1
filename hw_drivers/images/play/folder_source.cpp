#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/images/play/frame_source.h"

namespace enc::images {
namespace {

class FolderSource final : public FrameSource {
 public:
  explicit FolderSource(const Reel& reel)
      : reader_(list_pairs(reel.path, reel.layout)), repeat_(reel.repeat), words_(reel.path) {
    const std::size_t count = reader_.list().pairs.size();
    if (reel.start >= static_cast<std::int64_t>(count))
      throw Error(fmt::format("{}: has {} frames and start is {}; expected at most {}; correct start",
                              reel.path, count, reel.start, count - 1));
    next_ = static_cast<std::size_t>(reel.start);
  }
  bool next(ImagePair& into) override {
    if (next_ == reader_.list().pairs.size()) {
      if (!repeat_) return false;
      next_ = 0;
    }
    reader_.read(next_++, into);
    return true;
  }
  [[nodiscard]] ImageSize size() const override { return reader_.list().size; }
  [[nodiscard]] std::string words() const override {
    return fmt::format("{}, {} pairs", words_, reader_.list().pairs.size());
  }

 private:
  PairReader reader_;
  bool repeat_;
  std::string words_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_folder(const Reel& reel) { return std::make_unique<FolderSource>(reel); }

std::unique_ptr<FrameSource> open_reel(const Reel& reel) {
  std::error_code none;
  if (!std::filesystem::exists(reel.path, none))
    throw Error(
        fmt::format("{}: is not there; expected a folder of images or a video; see path in "
                    "[driver.images], from the folder that the program was started in",
                    reel.path));
  if (std::filesystem::is_directory(reel.path, none)) return open_folder(reel);
  if (!std::filesystem::is_regular_file(reel.path, none))
    throw Error(fmt::format(
        "{}: is neither a file nor a folder; expected a folder of images or a video; copy it into one",
        reel.path));
  return open_video(reel);
}

}  // namespace enc::images
