#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/calibration/pair_study.h"
#include "app/modules/units.h"
#include "core/rotation.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGoodEpipolar = 0.6;  // px rms

std::string residuals_text(const PairStudy& study) {
  std::size_t widest = 5;
  for (const StudiedPair& pair : study.pairs) widest = std::max(widest, pair.name.size());
  std::string out = fmt::format("{:{}}{:>11}{:>11}{:>14}{:>10}{:>13}\n", "pair", widest, "left, px",
                                "right, px", "epipolar, px", "rows, px", "square, mm");
  for (std::size_t i = 0; i < study.pairs.size(); ++i) {
    const PairResidual& p = study.found.pairs[i];
    out += fmt::format("{:{}}{:>11.3f}{:>11.3f}{:>14.3f}{:>10.3f}{:>13.3f}\n",
                       models::printable(study.pairs[i].name), widest, p.left, p.right, p.epipolar, p.rows,
                       p.square * kMm);
  }
  return out + fmt::format("{:{}}{:>22.3f}{:>14.3f}{:>10.3f}\n", "all", widest, study.found.rms,
                           study.found.epipolar, study.found.rows);
}

std::string lens_text(const char* side, const Lens& lens) {
  return fmt::format("{:12}focal {:.2f}, {:.2f} px; centre {:.2f}, {:.2f} px; distortion {:.4f}\n", side,
                     lens.focal_x, lens.focal_y, lens.centre_x, lens.centre_y,
                     fmt::join(lens.distortion, " "));
}

std::string head_text(const PairStudy& study) {
  const StereoRig& rig = study.found.rig;
  const Vec3 p = rig.X_CD.p() * kMm, turn = angles_xyz(rig.X_CD.q()) * kDeg;
  constexpr double kAt = 0.6;  // m
  const double pixel = kAt * kAt / (rig.left.focal_x * rig.X_CD.p().norm());
  return lens_text("left", rig.left) + lens_text("right", rig.right) +
         fmt::format(
             "baseline    {:.2f} mm; right camera at {:.2f} {:.2f} {:.2f} mm, turned by {:.3f} {:.3f} {:.3f} "
             "deg\n"
             "depth       a pixel of disparity is {:.1f} mm at {:.0f} mm\n",
             p.norm(), p.x(), p.y(), p.z(), turn.x(), turn.y(), turn.z(), pixel * kMm, kAt * kMm);
}

std::string rectification_text(const PairStudy& study) {
  const StereoCalibration& found = study.found;
  const auto worst = std::max_element(found.pairs.begin(), found.pairs.end(),
                                      [](const auto& a, const auto& b) { return a.rows < b.rows; });
  return fmt::format("rectified   rows differ by {:.3f} px rms, at most {:.3f} in one pair: {}\n", found.rows,
                     worst->rows,
                     worst->rows <= kGoodEpipolar ? "good" : fmt::format("NOT within {} px", kGoodEpipolar));
}

std::string notes_text(const PairStudy& study) {
  std::string out;
  const auto say = [&](const std::string& what) { out += "note        " + models::printable(what) + "\n"; };
  const StereoCalibration& found = study.found;
  if (!study.missed.empty())
    say(fmt::format("the board was not found in {}: their pairs are left out",
                    fmt::join(study.missed, ", ")));
  if (study.pairs.size() < 10)
    say(fmt::format("{} pairs are few: 10 to 20, with the board in all parts of both images",
                    study.pairs.size()));
  if (found.tilt < 30.0 / kDeg)
    say(fmt::format(
        "the boards are tilted by no more than {:.0f} deg against each other: the focal length is "
        "known badly; tilt them by 20 to 45 deg to all sides",
        found.tilt * kDeg));
  if (found.focal_deviation > 0.01)
    say(fmt::format("the focal length is known to {:.1f} % only; take pairs that are nearer and more tilted",
                    100.0 * found.focal_deviation));
  std::vector<double> errors;
  for (const PairResidual& p : found.pairs) errors.push_back(p.epipolar);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  for (std::size_t i = 0; i < found.pairs.size(); ++i)
    if (found.pairs[i].epipolar > std::max(kGoodEpipolar, 4.0 * errors[errors.size() / 2]))
      say(fmt::format("{} does not go with the others ({:.2f} px): leave it out, or take it again",
                      study.pairs[i].name, found.pairs[i].epipolar));
  return out;
}

Json lens_json(const Lens& lens) {
  return {{"focal_px", {lens.focal_x, lens.focal_y}},
          {"centre_px", {lens.centre_x, lens.centre_y}},
          {"distortion", lens.distortion}};
}

}  // namespace

std::string study_text(const PairStudy& study) {
  return study.title + "\n" + residuals_text(study) + head_text(study) + rectification_text(study) +
         notes_text(study) +
         "left out    epipolar, rows and square are rms by a calibration without the pair; left and right "
         "with it\n";
}

std::string study_json(const PairStudy& study, const Board& board) {
  const StereoCalibration& found = study.found;
  Json json;
  json["title"] = study.title;
  json["width_px"] = found.rig.width;
  json["height_px"] = found.rig.height;
  json["square_mm"] = board.square * kMm;
  json["left"] = lens_json(found.rig.left);
  json["right"] = lens_json(found.rig.right);
  const Vec3 p = found.rig.X_CD.p() * kMm, turn = angles_xyz(found.rig.X_CD.q()) * kDeg;
  json["right"]["position_mm"] = {p.x(), p.y(), p.z()};
  json["right"]["rotation_deg"] = {turn.x(), turn.y(), turn.z()};
  json["reprojection_px"] = found.rms;
  json["epipolar_px"] = found.epipolar;
  json["rows_px"] = found.rows;
  json["focal_deviation"] = found.focal_deviation;
  json["tilt_deg"] = found.tilt * kDeg;
  json["pairs"] = Json::array();
  for (std::size_t i = 0; i < study.pairs.size(); ++i) {
    const PairResidual& r = found.pairs[i];
    json["pairs"].push_back({{"name", study.pairs[i].name},
                             {"left_px", r.left},
                             {"right_px", r.right},
                             {"epipolar_px", r.epipolar},
                             {"rows_px", r.rows},
                             {"square_mm", r.square * kMm}});
  }
  json["not_found"] = study.missed;
  return json.dump(2);
}

}  // namespace enc::app
