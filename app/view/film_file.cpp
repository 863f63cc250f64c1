#include "app/view/film_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/process.h"
#include "core/base/error.h"
#include "core/base/image.h"
#include "hw_drivers/child/child.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;

// ffmpeg's options for each ending. The film is written to PATH.part, so the name does not choose them.
const std::map<std::string, std::vector<std::string>>& endings() {
  static const std::map<std::string, std::vector<std::string>> kAll{
      {".mp4", {"-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"}},
      {".mov", {"-pix_fmt", "yuv420p", "-f", "mov"}},
      {".mkv", {"-pix_fmt", "yuv420p", "-f", "matroska"}},
      {".webm",
       {"-pix_fmt", "yuv420p", "-b:v", "0", "-crf", "34", "-deadline", "realtime", "-cpu-used", "8", "-f",
        "webm"}},
      // One palette for each frame: a common one would keep the whole film in memory.
      {".gif",
       {"-filter_complex",
        "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=none", "-f", "gif"}}};
  return kAll;
}

std::string ending_of(const std::string& path) {
  return models::lower_case(fs::path(path).extension().string());
}

// ffmpeg reads raw frames from a pipe, writes its output for `file` in the given format, and ends with the
// pipe.
std::vector<std::string> encoding(const FilmFormat& format, const std::string& file) {
  const std::string ffmpeg = program_path("ffmpeg");
  std::vector<std::string> words{ffmpeg,         "-nostdin",
                                 "-hide_banner", "-loglevel",
                                 "error",        "-y",
                                 "-f",           "rawvideo",
                                 "-pix_fmt",     "rgb24",
                                 "-s",           fmt::format("{}x{}", format.width, format.height),
                                 "-r",           std::to_string(format.rate),
                                 "-i",           "-"};
  const std::vector<std::string>& options = endings().at(format.ending);
  words.insert(words.end(), options.begin(), options.end());
  words.push_back("file:" + file);  // so that a colon in the name is not read as a protocol
  return words;
}

class EncodedFilm final : public FilmFile {
 public:
  EncodedFilm(const std::string& path, const FilmFormat& format, models::OverwritePolicy existing)
      : file_(path, existing), ffmpeg_(encoding(format, file_.aside()), Child::Pipe::write) {}
  void add(const Image& frame) override {
    if (!ffmpeg_.write(frame.rgb)) fail(ffmpeg_.wait());
  }
  void keep() override {
    if (const Child::End end = ffmpeg_.wait(); !end.success) fail(end);
    file_.keep();
  }

 private:
  [[noreturn]] void fail(const Child::End& end) {
    throw Error(fmt::format(
        "{}: ffmpeg failed: {}; choose another ending, or a name without one for a folder of PNGs",
        file_.aside(), end.error.empty() ? end.how : end.error));
  }

  models::OutFile file_;
  Child ffmpeg_;  // ends before its file is removed
};

std::string frame_name(std::size_t number) { return fmt::format("frame_{:05}.png", number); }

// True for "frame_00000.png", and with ".part", which a killed run leaves.
bool is_frame(std::string name) {
  if (name.ends_with(".part")) name.resize(name.size() - 5);
  return name.size() >= 15 && name.starts_with("frame_") && name.ends_with(".png") &&
         std::all_of(name.begin() + 6, name.end() - 4, [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_there(const std::string& path) {
  std::error_code none;
  return fs::symlink_status(path, none).type() != fs::file_type::not_found;
}

// Throws Error unless the folder is free, or --force may replace it: it holds frames of a film and nothing
// else.
void check_replaceable(const std::string& folder, models::OverwritePolicy existing) {
  if (!is_there(folder)) return;
  std::error_code failed;
  const bool is_folder = fs::symlink_status(folder, failed).type() == fs::file_type::directory;
  if (is_folder && fs::is_empty(folder, failed) && !failed) return;
  if (existing == models::OverwritePolicy::keep)
    throw Error(
        fmt::format("{}: is there already; expected a new folder; choose another name, or give --force to "
                    "replace it",
                    folder));
  for (const auto& entry : is_folder ? fs::directory_iterator(folder, failed) : fs::directory_iterator()) {
    if (is_frame(entry.path().filename().string())) continue;
    throw Error(fmt::format(
        "{}: holds '{}'; expected a folder with nothing but frames of a film; choose another name", folder,
        entry.path().filename().string()));
  }
  if (!is_folder || failed)
    throw Error(fmt::format(
        "{}: is no folder that can be replaced; expected a new name, or a folder with frames of a "
        "film; choose another name",
        folder));
}

// Requires the parent folder, as for a file: a mistyped path creates no folders.
void check_parent(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  std::error_code none;
  if (parent.empty() || fs::is_directory(parent, none)) return;
  throw Error(fmt::format("{}: cannot be made: there is no folder {}; make it, or choose another name", path,
                          parent.string()));
}

void remove_frames(const std::string& folder) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_frame(entry.path().filename().string())) fs::remove(entry.path(), failed);
  fs::remove(folder, failed);
}

class FilmFolder final : public FilmFile {
 public:
  FilmFolder(const std::string& path, models::OverwritePolicy existing,
             std::function<std::string(const Image&)> png)
      : path_(fs::path(path).has_filename() ? path : fs::path(path).parent_path().string()),
        aside_(path_ + ".part"),
        existing_(existing),
        png_(std::move(png)) {
    check_parent(path_);
    check_replaceable(path_, existing_);
    check_replaceable(aside_, existing_);
    lock_.emplace(aside_);
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(aside_, failed)) fs::remove(entry.path(), failed);
  }
  ~FilmFolder() override {
    if (!kept_) remove_frames(aside_);
  }
  FilmFolder(const FilmFolder&) = delete;
  FilmFolder& operator=(const FilmFolder&) = delete;
  void add(const Image& frame) override {
    models::write_file((fs::path(aside_) / frame_name(frames_++)).string(), png_(frame),
                       models::OverwritePolicy::keep);
  }
  // rename() replaces only an empty folder.
  void keep() override {
    check_replaceable(path_, existing_);
    if (is_there(path_)) remove_frames(path_);
    kept_ = true;
    if (std::rename(aside_.c_str(), path_.c_str()) != 0)
      throw Error(fmt::format("{}: cannot be put in its place: {}; the film is whole in {}", path_,
                              std::strerror(errno), aside_));
  }

 private:
  std::string path_, aside_;
  models::OverwritePolicy existing_;
  std::function<std::string(const Image&)> png_;
  std::optional<models::OutFolder> lock_;
  std::size_t frames_ = 0;
  bool kept_ = false;
};

}  // namespace

FilmFormat film_format(const std::string& path) {
  FilmFormat format;
  const std::string ending = ending_of(path);
  if (!ending.empty() && !endings().contains(ending)) {
    std::string known;
    for (const auto& [name, options] : endings()) known += (known.empty() ? "" : ", ") + name;
    throw Error(
        fmt::format("{}: no film ends in '{}'; expected {}, or no ending for a folder of PNGs; choose one",
                    path, ending, known));
  }
  // A GIF is large, so use half the size and half the rate.
  if (ending == ".gif") format = {640, 360, 15};
  format.ending = ending;
  format.folder = ending.empty() || program_path("ffmpeg").empty();
  return format;
}

std::unique_ptr<FilmFile> open_film(const std::string& path, const FilmFormat& format,
                                    models::OverwritePolicy existing,
                                    std::function<std::string(const Image&)> png) {
  if (format.folder) return std::make_unique<FilmFolder>(path, existing, std::move(png));
  return std::make_unique<EncodedFilm>(path, format, existing);
}

}  // namespace enc::app
