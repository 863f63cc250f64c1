// A folder of chessboard pairs: evaluation and calibration.
#pragma once

#include <string>
#include <vector>

#include "hw_drivers/images/files/pair_list.h"
#include "models/identify/stereo/rectify.h"
#include "models/identify/stereo/stereo_calibration.h"

namespace enc::app {

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

// Both throw Error in one line that begins with the folder or a file. After the first, no output can
// overwrite the images.
[[nodiscard]] images::PairReader open_pairs(const std::string& folder);
[[nodiscard]] PairStudy study_pairs(images::PairReader& reader, const std::string& folder,
                                    const Board& board);

[[nodiscard]] std::string study_text(const PairStudy& study);
[[nodiscard]] std::string study_json(const PairStudy& study);

// Lists at most six names, separated by commas.
[[nodiscard]] std::string some_of(const std::vector<std::string>& names);

// The worst pair, a median one and the best, rectified.
[[nodiscard]] Image study_picture(const PairStudy& study);

}  // namespace enc::app
