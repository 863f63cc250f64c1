// `encounter calibrate stereo FOLDER`: calibrates a stereo head from a folder of image pairs of a chessboard.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/calibrate/images/commands.h"
#include "app/common/words.h"
#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "core/base/words.h"
#include "hw_drivers/images/files/pair_list.h"
#include "models/files.h"
#include "models/identify/stereo/stereo_calibration.h"
#include "models/schema/wording.h"
#include "models/setup/calibration_files.h"
#include "sim/picture/picture.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct StudiedPair {
  std::string name;  // left file's path in the folder
  images::ImagePair images;
  PairCorners corners;
};
struct PairStudy {
  std::string title;                // the input and the board of the calibration
  double square = kUnset;           // m, side, as given by the user
  std::string images;               // description of the folder's pairing
  std::vector<StudiedPair> pairs;   // pairs with the board found in both images
  std::vector<std::string> missed;  // images without the board
  StereoCalibration found;
  std::string misfit;  // reason why no rig may use the result; empty: usable
};
inline constexpr double kMostRows = 0.6;      // px rms, allowed row difference of one pair
inline constexpr double kMostSquare = 0.005;  // share by which the squares may differ without a note

// Lists at most six names, separated by commas.
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, names.size())));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMost ? ", ..." : "");
}

// ---- the study

// Path of an image relative to the folder, as "left01.png" or "cam0/01.png".
std::string name_of(const std::string& path, const std::string& folder) {
  return std::filesystem::path(path).lexically_relative(folder).string();
}

// Prints progress every few seconds: searching an image without a board takes seconds.
class SearchProgress {
 public:
  void tell(std::size_t done, std::size_t all, std::size_t found) {
    constexpr auto kEach = std::chrono::seconds(5);
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < kEach) return;
    told_ = now;
    fmt::print(stderr, "looked at {} of {} pairs: the board is in {}\n", done, all, found);
  }

 private:
  std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

// An image in which the board was not found.
struct FailedImage {
  std::string name;
  Image image;
};

// Refuses images of a single camera: without sides in their names they would be cut in two.
void refuse_whole(const images::PairList& list, const std::string& folder, const Board& board) {
  if (list.layout != images::Layout::side_by_side) return;
  Image whole;
  images::read_image(list.pairs.front().left, whole);
  if (board_in(whole.view(), board))
    throw Error(fmt::format(
        "{}: {} shows one board across its middle and was read as two images side by side, as no name says "
        "left or right; expected images of two cameras; name them left01.png and right01.png, or put them "
        "into folders left and right",
        folder, name_of(list.pairs.front().left, folder)));
}

void refuse_other_size(const std::vector<FailedImage>& missed, const std::string& folder,
                       const Board& board) {
  for (const auto& [name, image] : missed) {
    const std::optional<Board> size = board_in(image.view(), board);
    if (!size || (size->columns == std::max(board.columns, board.rows) &&
                  size->rows == std::min(board.columns, board.rows)))
      continue;
    throw Error(fmt::format(
        "{}: {} has a board of {} x {}: count inner corners, where two black squares touch; expected {} x {} "
        "by "
        "--corners; give --corners {}x{}",
        folder, name, size->columns, size->rows, board.columns, board.rows, size->columns, size->rows));
  }
}

// Looks for the board in all pairs. A pair without it is left out, and its image is named.
class BoardSearch {
 public:
  BoardSearch(images::PairReader& reader, const std::string& folder, const Board& board)
      : reader_(reader), folder_(folder), board_(board) {}

  void find_all(PairStudy& study) {
    const std::size_t pairs = reader_.list().pairs.size();
    SearchProgress waiting;
    for (std::size_t i = 0; i < pairs; ++i) {
      waiting.tell(i, pairs, study.pairs.size());
      look_at(i, study);
      if (i + 1 == std::min(kTried, pairs) && !found_) {
        refuse_whole(reader_.list(), folder_, board_);
        refuse_other_size(missed_, folder_, board_);
      }
    }
  }

 private:
  // After this many pairs without a board, look for a board of another size, and search the rest quickly.
  static constexpr std::size_t kTried = 2;

  void look_at(std::size_t i, PairStudy& study) {
    const images::PairFiles& files = reader_.list().pairs[i];
    const bool halves = reader_.list().layout == images::Layout::side_by_side;
    StudiedPair pair;
    pair.name = name_of(files.left, folder_);
    reader_.read(i, pair.images);
    const Search search = found_ || i < kTried ? Search::thorough : Search::quick;
    std::optional<Corners> left = find_corners(pair.images.left.view(), board_, search);
    std::optional<Corners> right = find_corners(pair.images.right.view(), board_, search);
    found_ = found_ || left || right;
    const std::string names[] = {name_of(files.left, folder_) + (halves ? " (left)" : ""),
                                 name_of(files.right, folder_) + (halves ? " (right)" : "")};
    if (!left) study.missed.push_back(names[0]);
    if (!right) study.missed.push_back(names[1]);
    if (left && right) {
      pair.corners = in_one_order(std::move(*left), std::move(*right), board_);
      study.pairs.push_back(std::move(pair));
    } else if (!found_ && i < kTried) {
      missed_.push_back({names[0], std::move(pair.images.left)});
      missed_.push_back({names[1], std::move(pair.images.right)});
    }
  }

  images::PairReader& reader_;
  const std::string& folder_;
  const Board& board_;
  std::vector<FailedImage> missed_;  // images of the first pairs, while none had a board
  bool found_ = false;               // found in any image
};

void refuse_too_few(const PairStudy& study, const images::PairList& list, const std::string& folder,
                    const Board& board) {
  if (study.pairs.size() >= kFewestBoards) return;
  throw Error(fmt::format(
      "{}: a board of {} x {} inner corners was found in {}{}; expected at least {}; {}see to "
      "--corners "
      "and that the whole board is seen",
      folder, board.columns, board.rows, counted(study.pairs.size(), "pair"),
      list.layout == images::Layout::side_by_side ? " of images side by side" : "", kFewestBoards,
      study.missed.empty() ? "take more pairs, " : fmt::format("none in {}; ", some_of(study.missed))));
}

// A single wrong pair spoils the calibration, and the others fit without it. If each lens alone fits badly,
// no pair is to blame.
void refuse_unlike(const PairStudy& study, const std::string& folder) {
  const StereoCalibration& found = study.found;
  if (found.rms <= kLargestRms) return;
  const std::vector<PairResidual>& pairs = found.pairs;
  const auto suspect = std::min_element(pairs.begin(), pairs.end(),
                                        [](const auto& a, const auto& b) { return a.rms < b.rms; });
  const bool lenses = found.left.unlike() || found.right.unlike();
  if (suspect->rms > kLargestRms && lenses) return;
  throw Error(fmt::format(
      "{}: the pairs do not go together: {:.1f} px rms are left over, {:.1f} px without {}; "
      "expected the same board, head and moment in both images of a pair; leave it out or take it again",
      folder, found.rms, suspect->rms, study.pairs[static_cast<std::size_t>(suspect - pairs.begin())].name));
}

std::string misfit_of(const PairStudy& study) {
  if (!(study.found.rms <= kLargestRms))
    return fmt::format("{:.1f} px rms are left over, more than {} px", study.found.rms, kLargestRms);
  for (std::size_t i = 0; i < study.pairs.size(); ++i) {
    const double rows = study.found.pairs[i].rows;
    if (!(rows <= kMostRows))
      return fmt::format("rows of {} are not within {} px of each other", study.pairs[i].name, kMostRows);
  }
  if (!(study.found.focal_deviation < kLoosestFocal))
    return fmt::format("the focal length is known to {:.0f} % only", 100.0 * study.found.focal_deviation);
  try {
    models::check_stereo(study.found.rig);  // so that the written file can be read again
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

// Throws Error in one line that begins with the folder or a file. No output can overwrite the images after
// this call.
images::PairReader open_pairs(const std::string& folder) {
  images::PairReader reader(images::list_pairs(folder, images::layout_of(folder)));
  for (const images::PairFiles& files : reader.list().pairs) {
    models::note_input(files.left);
    models::note_input(files.right);
  }
  return reader;
}

// Throws Error like open_pairs().
PairStudy study_pairs(images::PairReader& reader, const std::string& folder, const Board& board) {
  const images::PairList& list = reader.list();
  PairStudy study;
  study.square = board.square;
  study.images = list.words;
  BoardSearch(reader, folder, board).find_all(study);
  refuse_too_few(study, list, folder, board);
  std::vector<PairCorners> corners;
  for (const StudiedPair& pair : study.pairs) corners.push_back(pair.corners);
  try {
    study.found = calibrate_stereo(corners, board, list.size.width, list.size.height);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", folder, e.what()));
  }
  refuse_unlike(study, folder);
  study.misfit = misfit_of(study);
  study.title = fmt::format("{} pairs of {} x {} px, board {} x {}, squares of {:.6g} mm", study.pairs.size(),
                            list.size.width, list.size.height, board.columns, board.rows, board.square * 1e3);
  return study;
}

// The worst pair, a median one and the best, rectified.
Image study_picture(const PairStudy& study) {
  std::vector<std::size_t> order(study.pairs.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return study.found.pairs[a].rows > study.found.pairs[b].rows;
  });
  std::vector<ShownPair> shown;
  for (std::size_t i : {order.front(), order[order.size() / 2], order.back()}) {
    const StudiedPair& pair = study.pairs[i];
    shown.push_back({pair.images.left.view(), pair.images.right.view(), pair.corners,
                     fmt::format("{}: rows differ by {:.2f} px rms in a calibration without this pair",
                                 pair.name, study.found.pairs[i].rows)});
  }
  return rectified_picture(study.found.rig, shown);
}

// ---- its text and JSON

constexpr double kGoodEpipolar = 0.6;  // px rms

std::string size_of_error(double square, double should) {
  if (std::isnan(square)) return "no ray of the lens meets its corners";
  return fmt::format("{:.2f} % too {}", 100.0 * std::abs(square / should - 1.0),
                     square > should ? "large" : "small");
}

std::string residuals_text(const PairStudy& study) {
  std::size_t widest = 5;
  for (const StudiedPair& pair : study.pairs) widest = std::max(widest, pair.name.size());
  std::string out = fmt::format("{:{}}{:>11}{:>11}{:>14}{:>10}{:>13}\n", "pair", widest, "left, px",
                                "right, px", "epipolar, px", "rows, px", "square, mm");
  for (std::size_t i = 0; i < study.pairs.size(); ++i) {
    const PairResidual& p = study.found.pairs[i];
    out += fmt::format("{:{}}{:>11.3f}{:>11.3f}{:>14.3f}{:>10.3f}{:>13.3f}\n",
                       models::printable(study.pairs[i].name), widest, p.left, p.right, p.epipolar, p.rows,
                       p.square * kMmPerM);
  }
  return out + fmt::format("{:{}}{:>22.3f}{:>14.3f}{:>10.3f}\n", "all", widest, study.found.rms,
                           study.found.epipolar, study.found.rows);
}

std::string lens_text(const char* side, const Lens& lens) {
  return fmt::format("{:12}focal {:.2f}, {:.2f} px; centre {:.2f}, {:.2f} px; distortion {:.4f}\n", side,
                     lens.focal_x, lens.focal_y, lens.centre_x, lens.centre_y,
                     fmt::join(lens.distortion, " "));
}

const char* words_for(K3 k3) {
  switch (k3) {
    case K3::zero:
      return "k3 is 0: no more of it is seen than chance would show";
    case K3::fitted:
      return "k3 is more than three standard deviations from 0";
    case K3::folds:
      return "k3 is 0: with it, a lens would fold before the image's corner";
  }
  return "";
}

std::string head_text(const PairStudy& study) {
  const StereoRig& rig = study.found.rig;
  const Vec3 p = rig.X_CD.p() * kMmPerM, turn = angles_xyz(rig.X_CD.q()) * kDegPerRad;
  constexpr double kAt = 0.6;  // m
  const double pixel = kAt * kAt / (rig.left.focal_x * rig.X_CD.p().norm());
  return lens_text("left", rig.left) + lens_text("right", rig.right) +
         fmt::format("distortion  k1, k2, p1, p2, k3; {}\n", words_for(study.found.k3)) +
         fmt::format(
             "baseline    {:.2f} mm; right camera at {:.2f} {:.2f} {:.2f} mm, turned by {:.3f} {:.3f} {:.3f} "
             "deg\n"
             "depth       a pixel of disparity is {:.1f} mm at {:.0f} mm\n",
             p.norm(), p.x(), p.y(), p.z(), turn.x(), turn.y(), turn.z(), pixel * kMmPerM, kAt * kMmPerM);
}

// The pair with the largest error; NaN counts as the largest.
template <class Error>
std::size_t worst_of(const PairStudy& study, const Error& error) {
  const auto size = [&](const PairResidual& p) {
    return std::isnan(error(p)) ? std::numeric_limits<double>::infinity() : error(p);
  };
  const std::vector<PairResidual>& pairs = study.found.pairs;
  const auto worst = std::max_element(pairs.begin(), pairs.end(),
                                      [&](const auto& a, const auto& b) { return size(a) < size(b); });
  return static_cast<std::size_t>(worst - pairs.begin());
}

std::string rectification_text(const PairStudy& study) {
  const StereoCalibration& found = study.found;
  const double side = study.square;
  const std::size_t rows = worst_of(study, [](const PairResidual& p) { return p.rows; });
  const std::size_t square =
      worst_of(study, [&](const PairResidual& p) { return std::abs(p.square / side - 1.0); });
  return fmt::format(
      "rectified   rows differ by {:.3f} px rms, at most {:.3f} in one pair, {}: {}within {} px\n"
      "squares     are right within {:.2f} %, by {}\n",
      found.rows, found.pairs[rows].rows, models::printable(study.pairs[rows].name),
      found.pairs[rows].rows <= kMostRows ? "" : "NOT ", kMostRows,
      100.0 * std::abs(found.pairs[square].square / side - 1.0), models::printable(study.pairs[square].name));
}

// Notes on a lens: a bad fit, and areas of the image without corners.
void say_of_lens(const char* side, const LensFit& fit, std::vector<std::string>& notes) {
  constexpr double kFarEnough = 0.65;  // share of the way to the corner
  if (fit.unlike())
    notes.push_back(fmt::format(
        "{}: corners lie {:.2f} px rms off this lens, and {:.2f} px too far {} at {:.0f} % of the way to the "
        "image's corner: "
        "it bends otherwise than k1, k2, p1, p2 and k3 can describe, as a fisheye does, or the board is not "
        "flat",
        side, fit.rms, std::abs(fit.outwards), fit.outwards > 0.0 ? "out" : "in", 100.0 * fit.ring));
  if (fit.reach < kFarEnough)
    notes.push_back(fmt::format(
        "{}: no board reaches farther than {:.0f} % of the way to the image's corner, and beyond the lens is "
        "not known; hold it into the corners, too",
        side, 100.0 * fit.reach));
}

void say_of_squares(const PairStudy& study, std::vector<std::string>& notes) {
  std::vector<std::string> off;
  for (std::size_t i = 0; i < study.pairs.size(); ++i)
    if (const double square = study.found.pairs[i].square;
        !(std::abs(square / study.square - 1.0) <= kMostSquare))
      off.push_back(fmt::format("{} ({})", study.pairs[i].name, size_of_error(square, study.square)));
  if (!off.empty())
    notes.push_back(fmt::format(
        "squares err by more than {} %, and places there as much: {}; take more pairs in that part of the "
        "image, and hold the board still",
        100.0 * kMostSquare, some_of(off)));
}

std::vector<std::string> notes_of(const PairStudy& study) {
  std::vector<std::string> notes;
  const auto say = [&](const std::string& what) { notes.push_back(what); };
  const StereoCalibration& found = study.found;
  say_of_squares(study, notes);
  if (found.k3 == K3::folds)
    say("a k3 is seen, but with it a lens would fold before the image's corner, where no board was, so that "
        "it is 0 "
        "and places at the edge are wrong; hold the board into the corners, too");
  say_of_lens("left", found.left, notes);
  say_of_lens("right", found.right, notes);
  if (!study.missed.empty())
    say(fmt::format("the board was not found in {}: their pairs are left out",
                    fmt::join(study.missed, ", ")));
  if (study.pairs.size() < 10)
    say(fmt::format("{} pairs are few: 10 to 20, with the board in all parts of both images",
                    study.pairs.size()));
  if (found.tilt < 30.0 / kDegPerRad)
    say(fmt::format(
        "the boards are tilted by no more than {:.0f} deg against each other: the focal length is "
        "known badly; tilt them by 20 to 45 deg to all sides",
        found.tilt * kDegPerRad));
  if (found.focal_deviation > 0.01)
    say(fmt::format("the focal length is known to {:.1f} % only; take pairs that are nearer and more tilted",
                    100.0 * found.focal_deviation));
  std::vector<double> errors;
  for (const PairResidual& p : found.pairs)
    errors.push_back(std::isnan(p.epipolar) ? std::numeric_limits<double>::infinity() : p.epipolar);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  for (std::size_t i = 0; i < found.pairs.size(); ++i)
    if (found.pairs[i].epipolar > std::max(kGoodEpipolar, 4.0 * errors[errors.size() / 2]))
      say(fmt::format("{} does not go with the others ({:.2f} px): leave it out, or take it again",
                      study.pairs[i].name, found.pairs[i].epipolar));
  return notes;
}

std::string notes_text(const PairStudy& study) {
  std::string out;
  for (const std::string& note : notes_of(study)) out += "note        " + models::printable(note) + "\n";
  return out;
}

Json lens_json(const Lens& lens) {
  return {{"focal_px", {lens.focal_x, lens.focal_y}},
          {"centre_px", {lens.centre_x, lens.centre_y}},
          {"distortion", lens.distortion}};
}

std::string study_text(const PairStudy& study) {
  return study.title + "\nimages      " + models::printable(study.images) + "\n" + residuals_text(study) +
         head_text(study) + rectification_text(study) + notes_text(study) +
         (study.misfit.empty()
              ? ""
              : "unfit       " + models::printable(study.misfit) + "; no rig may use this\n") +
         "left out    epipolar, rows and square are rms by a calibration without the pair; left and right "
         "with it\n";
}

std::string study_json(const PairStudy& study) {
  const StereoCalibration& found = study.found;
  Json json;
  json["title"] = study.title;
  json["images"] = study.images;
  json["width_px"] = found.rig.width;
  json["height_px"] = found.rig.height;
  json["square_mm"] = study.square * kMmPerM;
  json["left"] = lens_json(found.rig.left);
  json["right"] = lens_json(found.rig.right);
  const Vec3 p = found.rig.X_CD.p() * kMmPerM, turn = angles_xyz(found.rig.X_CD.q()) * kDegPerRad;
  json["right"]["position_mm"] = {p.x(), p.y(), p.z()};
  json["right"]["rotation_deg"] = {turn.x(), turn.y(), turn.z()};
  json["reprojection_px"] = found.rms;
  json["epipolar_px"] = found.epipolar;
  json["rows_px"] = found.rows;
  json["focal_deviation"] = found.focal_deviation;
  json["tilt_deg"] = found.tilt * kDegPerRad;
  json["pairs"] = Json::array();
  for (std::size_t i = 0; i < study.pairs.size(); ++i) {
    const PairResidual& r = found.pairs[i];
    json["pairs"].push_back({{"name", study.pairs[i].name},
                             {"left_px", r.left},
                             {"right_px", r.right},
                             {"epipolar_px", r.epipolar},
                             {"rows_px", r.rows},
                             {"square_mm", r.square * kMmPerM}});
  }
  json["not_found"] = study.missed;
  json["k3_fitted"] = found.k3 == K3::fitted;
  json["within"] = study.misfit.empty();
  json["misfit"] = study.misfit;
  json["notes"] = notes_of(study);
  return json.dump(2);
}

// ---- the command

// Reads a board size such as "9x6".
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
  if (options.picture.empty()) return;
  const fs::path picture = whole(options.picture);
  if (!options.out.empty() && whole(options.out) == picture)
    throw Error(fmt::format(
        "{}: is both --out and --picture; expected two files; choose another name for one", options.picture));
  if (images::is_image_name(options.picture) && models::lower_case(picture.extension().string()) != ".png")
    throw Error(fmt::format("{}: --picture writes a PNG; expected a name that ends in .png; choose one",
                            options.picture));
}

// Refuses a picture in the folder of images, because the next calibration would read it.
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

// An unusable head is not written to a file. Its picture shows why.
int calibrate_stereo(const StereoOptions& options) {
  refuse_names(options);
  images::PairReader reader = open_pairs(options.folder);
  const Board board = board_of(options);
  refuse_among(options.picture, reader.list());
  std::optional<models::OutFile> file, picture;  // refuse it before the work
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
