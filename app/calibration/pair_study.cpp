#include "app/calibration/pair_study.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "models/files.h"

namespace enc::app {
namespace {

std::string name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, names.size())));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMost ? ", ..." : "");
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

// Where the board was not found, the pair is left out and the image is named.
void find_boards(images::PairReader& reader, const Board& board, PairStudy& study) {
  Waiting waiting;
  for (std::size_t i = 0; i < reader.list().pairs.size(); ++i) {
    waiting.tell(i, reader.list().pairs.size(), study.pairs.size());
    const images::PairFiles& files = reader.list().pairs[i];
    StudiedPair pair;
    pair.name = name_of(files.left);
    reader.read(i, pair.images);
    std::optional<Corners> left = find_corners(pair.images.left.view(), board);
    std::optional<Corners> right = find_corners(pair.images.right.view(), board);
    const bool halves = reader.list().layout == images::Layout::side_by_side;
    if (!left) study.missed.push_back(name_of(files.left) + (halves ? " (left)" : ""));
    if (!right) study.missed.push_back(name_of(files.right) + (halves ? " (right)" : ""));
    if (!left || !right) continue;
    pair.corners = in_one_order(std::move(*left), std::move(*right));
    study.pairs.push_back(std::move(pair));
  }
}

void refuse_too_few(const PairStudy& study, const std::string& folder, const Board& board) {
  if (study.pairs.size() >= kFewestBoards) return;
  throw Error(fmt::format(
      "{}: a board of {} x {} inner corners was found in {} pair{}; expected at least {}; {}see to --corners "
      "and "
      "that the whole board is seen",
      folder, board.columns, board.rows, study.pairs.size(), study.pairs.size() == 1 ? "" : "s",
      kFewestBoards,
      study.missed.empty() ? "take more pairs, " : fmt::format("none in {}; ", some_of(study.missed))));
}

// One pair that is none spoils them all: without it the others fit.
void refuse_unlike(const PairStudy& study, const std::string& folder) {
  if (study.found.rms <= kLargestRms) return;
  const std::vector<PairResidual>& pairs = study.found.pairs;
  const auto suspect = std::min_element(pairs.begin(), pairs.end(),
                                        [](const auto& a, const auto& b) { return a.rms < b.rms; });
  throw Error(
      fmt::format("{}: the pairs do not go together: {:.1f} px rms are left over, {:.1f} px without {}; "
                  "expected the same "
                  "board, head and moment in both images of a pair; leave it out or take it again",
                  folder, study.found.rms, suspect->rms,
                  study.pairs[static_cast<std::size_t>(suspect - pairs.begin())].name));
}

}  // namespace

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
  find_boards(reader, board, study);
  refuse_too_few(study, folder, board);
  std::vector<PairCorners> corners;
  for (const StudiedPair& pair : study.pairs) corners.push_back(pair.corners);
  try {
    study.found = calibrate_stereo(corners, board, list.size.width, list.size.height);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", folder, e.what()));
  }
  refuse_unlike(study, folder);
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
