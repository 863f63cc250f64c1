#include "app/calibrate/images/pair_study.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/stereo_file.h"

namespace enc::app {
namespace {

// "left01.png", "cam0/01.png"
std::string name_of(const std::string& path, const std::string& folder) {
  return std::filesystem::path(path).lexically_relative(folder).string();
}

// To look for a board where there is none takes seconds an image: somebody who waits is told how far it is.
class Waiting {
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

// Images in which a board was looked for in vain.
struct Missed {
  std::string name;
  Image image;
};

// One camera's images whose names say no side would be cut in two.
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

void refuse_other_size(const std::vector<Missed>& missed, const std::string& folder, const Board& board) {
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

// Looks for the board in all pairs. Where it was not found, the pair is left out and the image is named.
class BoardSearch {
 public:
  BoardSearch(images::PairReader& reader, const std::string& folder, const Board& board)
      : reader_(reader), folder_(folder), board_(board) {}

  void find_all(PairStudy& study) {
    const std::size_t pairs = reader_.list().pairs.size();
    Waiting waiting;
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
  // Pairs without any board, after which a board of another size is looked for, and the rest looked at
  // quickly.
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
  std::vector<Missed> missed_;  // of the first pairs, while none had a board
  bool found_ = false;          // in any image
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

// One pair that is none spoils them all: without it the others fit. Where each lens alone fits badly, no pair
// is to blame.
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
    models::check_stereo(study.found.rig);  // so that what is written can be read
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, names.size())));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMost ? ", ..." : "");
}

images::PairReader open_pairs(const std::string& folder) {
  images::PairReader reader(images::list_pairs(folder, images::layout_of(folder)));
  for (const images::PairFiles& files : reader.list().pairs) {
    models::note_input(files.left);
    models::note_input(files.right);
  }
  return reader;
}

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

}  // namespace enc::app
