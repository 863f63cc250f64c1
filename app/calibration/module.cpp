// `encounter calibrate IMAGES`: a stereo head out of a folder of pairs of a chessboard, or the colour of skin
// out of hands. What the program finds in encounter_calibration.so.
#include "core/devices/module.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include <encounter_version.h>
#include <fmt/format.h>

#include "app/calibration/calibration_module.h"
#include "app/calibration/pair_study.h"
#include "app/calibration/skin_study.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/stereo_file.h"
#include "sim/picture/picture.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;

// "9x6"
Board board_of(const CalibrateOptions& options) {
  if (!options.square_mm)
    throw Error(
        "calibrate: how large the squares of the board are is not in the images; expected --square-mm 25 "
        "or the like; measure them");
  if (!(*options.square_mm >= 0.1 && *options.square_mm <= 1000.0))
    throw Error("--square-mm: expected 0.1 to 1000 millimetres");
  Board board;
  board.square = *options.square_mm * 1e-3;
  const std::string text = options.corners.value_or("9x6");
  const char* end = text.data() + text.size();
  const auto columns = std::from_chars(text.data(), end, board.columns);
  bool good = columns.ec == std::errc() && columns.ptr != end && *columns.ptr == 'x';
  if (good) {
    const auto rows = std::from_chars(columns.ptr + 1, end, board.rows);
    good = rows.ec == std::errc() && rows.ptr == end;
  }
  if (!good || board.columns < 3 || board.rows < 3 || board.columns > 50 || board.rows > 50)
    throw Error(
        fmt::format("--corners: {} is no size of a board; expected its inner corners, 3 to 50 each, such as "
                    "9x6; count where two black squares touch",
                    models::quoted(text)));
  return board;
}

void refuse(bool given, const std::string& option, const std::string& of,
            const std::string& what = "a folder of images") {
  if (given)
    throw Error(
        fmt::format("{} is of {}; {} is none; expected the command without it; remove it", option, of, what));
}

std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("._-/+,=:@", c) != nullptr;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

// What made a file, as its first line: whoever repeats it gets the same numbers.
std::string made_by(const std::string& command) {
  return models::printable(
             fmt::format("# Encounter {}: ./encounter calibrate {}", ENCOUNTER_VERSION, command)) +
         "\n";
}

fs::path whole(const fs::path& path) {
  std::error_code none;
  return fs::weakly_canonical(fs::absolute(path, none), none);
}

// The report is what is printed, so a file has a name.
void refuse_names(const CalibrateOptions& options) {
  for (const auto& [option, name] : {std::pair{"--out", options.out}, {"--picture", options.picture}})
    if (name == "-")
      throw Error(fmt::format("{}: '-' is no name of a file; expected one; choose one", option));
  if (options.picture.empty()) return;
  const fs::path picture = whole(options.picture);
  if (!options.out.empty() && whole(options.out) == picture)
    throw Error(fmt::format(
        "{}: is both --out and --picture; expected two files; choose another name for one", options.picture));
  if (images::is_image_name(options.picture) && models::lower_case(picture.extension().string()) != ".png")
    throw Error(fmt::format("{}: --picture writes a PNG; expected a name that ends in .png; choose one",
                            options.picture));
}

int calibrate_skin(const CalibrateOptions& options) {
  for (const auto& [given, option] : {std::pair{options.square_mm.has_value(), "--square-mm"},
                                      {options.corners.has_value(), "--corners"},
                                      {!options.picture.empty(), "--picture"}})
    refuse(given, option, "a chessboard", "a hand");
  const std::vector<HandFiles> files = list_hands(options.log, options.skin);
  std::optional<models::OutFile> file;  // refused before the work
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  const SkinStudy study = study_skin(files);
  if (file) {
    file->write(made_by(fmt::format("{} --skin {}", shell_word(options.log), shell_word(options.skin))) +
                skin_toml(study));
    file->keep();
  }
  fmt::print("{}{}", options.json ? skin_json(study) : skin_text(study), options.json ? "\n" : "");
  return 0;
}

// A picture among the images would be read by the next calibration.
void refuse_among(const std::string& picture, const images::PairList& list) {
  if (picture.empty()) return;
  const fs::path home = whole(picture).parent_path();
  for (const images::PairFiles& pair : list.pairs)
    for (const std::string& image : {pair.left, pair.right})
      if (whole(image).parent_path() == home)
        throw Error(
            fmt::format("{}: is among the images, which the next calibration would read with it; expected "
                        "another folder; choose one",
                        picture));
}

std::string file_text(const PairStudy& study, const Board& board, const CalibrateOptions& options) {
  std::string made = made_by(fmt::format("{} --square-mm {:g} --corners {}x{}", shell_word(options.log),
                                         *options.square_mm, board.columns, board.rows));
  for (const std::string& image : study.missed) made += models::printable("# no board in " + image) + "\n";
  return made + models::stereo_text({study.title, study.found.rig, study.found.rms, study.found.epipolar});
}

// A head that no rig may use makes no file. Its picture shows why.
int calibrate_head(const CalibrateOptions& options) {
  images::PairReader reader = open_pairs(options.log);
  const Board board = board_of(options);
  refuse_among(options.picture, reader.list());
  std::optional<models::OutFile> file, picture;  // refused before the work
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  if (!options.picture.empty()) picture.emplace(options.picture, models::existing(options.force));
  const PairStudy study = study_pairs(reader, options.log, board);
  const bool fit = study.misfit.empty();
  if (file && fit) {
    file->write(file_text(study, board, options));
    file->keep();
  }
  if (picture) {
    picture->write(sim::png(study_picture(study)));
    picture->keep();
  }
  fmt::print("{}{}", options.json ? study_json(study) : study_text(study), options.json ? "\n" : "");
  if (file && !fit && !options.json) fmt::print("not written {}\n", models::printable(options.out));
  return fit ? 0 : 1;
}

int calibrate_images(const CalibrateOptions& options) {
  refuse(options.rate.has_value(), "--rate-Hz", "a log");
  refuse(options.pivot, "--pivot", "a log");
  refuse(options.pairs.has_value(), "--pairs", "a rig");
  refuse(options.frames.has_value(), "--frames", "a rig");
  refuse(options.seed.has_value(), "--seed", "a rig or of points");
  refuse(!options.set.empty(), "--set", "a rig");
  refuse(options.through_images, "--through-images", "a rig");
  refuse_names(options);
  return options.skin.empty() ? calibrate_head(options) : calibrate_skin(options);
}

constexpr CalibrationModule kCalibration{calibrate_images};

}  // namespace
}  // namespace enc::app

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "calibration", .calibration = &enc::app::kCalibration};
  return &kInfo;
}
