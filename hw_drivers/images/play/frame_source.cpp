#include "hw_drivers/images/play/frame_source.h"

#include <atomic>
#include <charconv>
#include <filesystem>
#include <mutex>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/child/child.h"

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

// Command to decode a video of side-by-side images with ffmpeg. ffmpeg writes each frame as PPM: RGB bytes
// after a header with the size. So the size need not be queried first.
std::vector<std::string> command(const std::string& path) {
  return {"ffmpeg",     "-nostdin", "-v",  "error",    "-i",    "file:" + path, "-map",        "0:v:0", "-f",
          "image2pipe", "-c:v",     "ppm", "-pix_fmt", "rgb24", "-vsync",       "passthrough", "-"};
}

// The first line of ffmpeg's standard error, or how it ended; empty on success.
std::string last_words(Child& ffmpeg) {
  Child::End end = ffmpeg.wait();
  std::string& line = end.error;
  if (const std::size_t part = line.find("] "); line.starts_with('[') && part != std::string::npos)
    line.erase(0, part + 2);  // removes the name and address of the part of ffmpeg
  if (!line.empty()) return line;
  return end.success ? "" : end.how;
}

class VideoSource final : public FrameSource {
 public:
  explicit VideoSource(const Reel& reel) : reel_(reel) {
    begin();
    if (!read_header()) refuse_empty();
    waiting_ = true;
    if (size_.width % 2 != 0)
      throw Error(fmt::format("{}: is {} px wide; expected two images side by side, of an even width",
                              reel.path, size_.width));
    ImagePair passed;
    for (std::int64_t i = 0; i < reel.start; ++i) {
      next(passed);
      if (!read_header())
        throw Error(fmt::format("{}: has {} frames and start is {}; expected fewer; correct start", reel.path,
                                i + 1, reel.start));
      waiting_ = true;
    }
  }
  bool next(ImagePair& into) override {
    if (!std::exchange(waiting_, false) && !read_header()) {
      if (stopped_) return false;
      if (const std::string words = last_words(*child_); !words.empty())
        throw Error(
            fmt::format("{}: ffmpeg stopped: {}; expected a video that it can read", reel_.path, words));
      if (!reel_.repeat) return false;
      begin();
      if (!read_header()) refuse_empty();
    }
    if (child_->read(reinterpret_cast<char*>(both_.rgb.data()), both_.rgb.size()) != both_.rgb.size()) {
      if (stopped_) return false;
      throw Error(fmt::format("{}: is cut off within a frame; expected a whole video; {}", reel_.path,
                              last_words(*child_)));
    }
    split(both_.view(), into);
    return true;
  }
  [[nodiscard]] ImageSize size() const override { return {size_.width / 2, size_.height}; }
  [[nodiscard]] std::string words() const override { return reel_.path + ", read by ffmpeg"; }
  void stop() noexcept override {
    const std::lock_guard lock(child_changes_);
    stopped_ = true;
    if (child_ != nullptr) child_->kill();
  }

 private:
  void begin() {
    const std::lock_guard lock(child_changes_);
    if (stopped_) return;
    try {
      child_ = std::make_unique<Child>(command(reel_.path), Child::Pipe::read);
    } catch (const Error& e) {
      throw Error(
          fmt::format("{}: {}; expected ffmpeg for a video; install it (apt-get install ffmpeg), or give a "
                      "folder of PNG or JPEG images",
                      reel_.path, e.what()));
    }
  }
  [[noreturn]] void refuse_empty() {
    const std::string words = last_words(*child_);
    throw Error(fmt::format("{}: ffmpeg finds no frame in it ({}); expected a video or a folder of images",
                            reel_.path, words.empty() ? "no error told" : words));
  }
  // Reads "P6\n1280 480\n255\n"; returns false at the end.
  bool read_header() {
    std::string header;
    for (int lines = 0; lines < 3;) {
      char c = 0;
      if (header.size() > 40 || child_->read(&c, 1) != 1) {
        if (header.empty()) return false;
        throw Error(
            fmt::format("{}: what ffmpeg writes is no PPM image; expected ffmpeg 4 or later", reel_.path));
      }
      header += c;
      lines += c == '\n' ? 1 : 0;
    }
    ImageSize size;
    const char* end = header.data() + header.size();
    const auto width = std::from_chars(header.data() + 3, end, size.width);
    std::from_chars(width.ptr + 1, end, size.height);
    if (!header.starts_with("P6\n") || !header.ends_with("\n255\n") || size.width < 2 || size.height < 1 ||
        size.width > kLargest || size.height > kLargest)
      throw Error(
          fmt::format("{}: ffmpeg writes frames that are not to be had; expected RGB of at most {} px",
                      reel_.path, kLargest));
    if (size_.width != 0 && size != size_)
      throw Error(fmt::format("{}: a frame is {} x {} px; expected {} x {} as the first", reel_.path,
                              size.width, size.height, size_.width, size_.height));
    if (size_.width == 0) both_ = Image(size.width, size.height);
    size_ = size;
    return true;
  }

  Reel reel_;
  std::mutex child_changes_;  // guards against stop()
  std::unique_ptr<Child> child_;
  std::atomic<bool> stopped_ = false;
  bool waiting_ = false;  // a header has been read
  ImageSize size_;        // size of both images together
  Image both_;
};

}  // namespace

std::unique_ptr<FrameSource> open_reel(const Reel& reel) {
  std::error_code none;
  if (!std::filesystem::exists(reel.path, none))
    throw Error(
        fmt::format("{}: is not there; expected a folder of images or a video; see path in "
                    "[driver.images], from the folder that the program was started in",
                    reel.path));
  if (std::filesystem::is_directory(reel.path, none)) return std::make_unique<FolderSource>(reel);
  if (!std::filesystem::is_regular_file(reel.path, none))
    throw Error(fmt::format(
        "{}: is neither a file nor a folder; expected a folder of images or a video; copy it into one",
        reel.path));
  return std::make_unique<VideoSource>(reel);
}

}  // namespace enc::images
