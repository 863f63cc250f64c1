// A folder of pairs of a chessboard, looked at and calibrated.
#pragma once

#include <string>
#include <vector>

#include "hw_drivers/images/files/pair_list.h"
#include "models/identify/stereo/rectify.h"
#include "models/identify/stereo/stereo_calibration.h"

namespace enc::app {

struct StudiedPair {
  std::string name;  // of the left file, from the folder on
  images::ImagePair images;
  PairCorners corners;
};
struct PairStudy {
  std::string title;                // what was calibrated with what
  double square = kUnset;           // m, side, as it was said
  std::string images;               // how the folder was read
  std::vector<StudiedPair> pairs;   // in which the board was found, in both images
  std::vector<std::string> missed;  // images in which it was not found
  StereoCalibration found;
  std::string misfit;  // why no rig may use what was found; empty: it may
};
inline constexpr double kMostRows = 0.6;      // px rms that rows of one pair may differ by
inline constexpr double kMostSquare = 0.005;  // share by which squares may err without a note

// Both throw Error in one line that begins with the folder or a file. After the first, nothing is written
// over the images.
[[nodiscard]] images::PairReader open_pairs(const std::string& folder);
[[nodiscard]] PairStudy study_pairs(images::PairReader& reader, const std::string& folder,
                                    const Board& board);

[[nodiscard]] std::string study_text(const PairStudy& study);
[[nodiscard]] std::string study_json(const PairStudy& study);

// At most six, by commas.
[[nodiscard]] std::string some_of(const std::vector<std::string>& names);

// The worst pair, a middling one and the best, rectified.
[[nodiscard]] Image study_picture(const PairStudy& study);

}  // namespace enc::app
