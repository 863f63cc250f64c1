// A folder of pairs of a chessboard, looked at and calibrated.
#pragma once

#include <string>
#include <vector>

#include "core/vision/calibration/rectify.h"
#include "core/vision/calibration/stereo_calibration.h"
#include "hw_drivers/images/files/pair_list.h"

namespace enc::app {

struct StudiedPair {
  std::string name;  // of the left file, without its folder
  images::ImagePair images;
  PairCorners corners;
};
struct PairStudy {
  std::string title;                // what was calibrated with what
  std::vector<StudiedPair> pairs;   // in which the board was found, in both images
  std::vector<std::string> missed;  // images in which it was not found
  StereoCalibration found;
};

// Both throw Error in one line that begins with the folder or a file. After the first, nothing is written
// over the images.
[[nodiscard]] images::PairReader open_pairs(const std::string& folder);
[[nodiscard]] PairStudy study_pairs(images::PairReader& reader, const std::string& folder,
                                    const Board& board);

[[nodiscard]] std::string study_text(const PairStudy& study);
[[nodiscard]] std::string study_json(const PairStudy& study, const Board& board);

// The worst pair, a middling one and the best, rectified.
[[nodiscard]] Image study_picture(const PairStudy& study);

}  // namespace enc::app
