// `encounter calibrate stereo FOLDER`: a stereo head out of a folder of pairs of a chessboard.
#include <charconv>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "app/calibrate/images/commands.h"
#include "app/calibrate/images/pair_study.h"
#include "app/common/shell_word.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/stereo_file.h"
#include "sim/picture/picture.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;

// "9x6"
Board board_of(const StereoOptions& options) {
  if (!options.square_mm)
    throw Error(
        "calibrate stereo: how large the board's squares are is not in the images; expected --square-mm "
        "25 or the like; measure them");
  if (!(*options.square_mm >= 0.1 && *options.square_mm <= 1000.0))
    throw Error("--square-mm: expected 0.1 to 1000 millimetres");
  Board board;
  board.square = *options.square_mm * 1e-3;
  const std::string text = options.corners;
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

fs::path whole(const fs::path& path) {
  std::error_code none;
  return fs::weakly_canonical(fs::absolute(path, none), none);
}

void refuse_names(const StereoOptions& options) {
  refuse_dash("--out", options.out);
  refuse_dash("--picture", options.picture);
  if (options.picture.empty()) return;
  const fs::path picture = whole(options.picture);
  if (!options.out.empty() && whole(options.out) == picture)
    throw Error(fmt::format(
        "{}: is both --out and --picture; expected two files; choose another name for one", options.picture));
  if (images::is_image_name(options.picture) && models::lower_case(picture.extension().string()) != ".png")
    throw Error(fmt::format("{}: --picture writes a PNG; expected a name that ends in .png; choose one",
                            options.picture));
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

std::string file_text(const PairStudy& study, const Board& board, const StereoOptions& options) {
  std::string made =
      made_by(fmt::format("stereo {} --square-mm {:g} --corners {}x{}", shell_word(options.folder),
                          *options.square_mm, board.columns, board.rows));
  for (const std::string& image : study.missed) made += models::printable("# no board in " + image) + "\n";
  return made + models::stereo_text({study.title, study.found.rig, study.found.rms, study.found.epipolar});
}

}  // namespace

// A head that no rig may use makes no file. Its picture shows why.
int calibrate_stereo(const StereoOptions& options) {
  refuse_names(options);
  images::PairReader reader = open_pairs(options.folder);
  const Board board = board_of(options);
  refuse_among(options.picture, reader.list());
  std::optional<models::OutFile> file, picture;  // refused before the work
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  if (!options.picture.empty()) picture.emplace(options.picture, models::existing(options.force));
  const PairStudy study = study_pairs(reader, options.folder, board);
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

}  // namespace enc::app
