#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/calibrate/images/pair_study.h"
#include "app/common/axes.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;

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

// By what is worst; what is no number is worse than all.
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

// What the corners say of a lens, and where they say nothing.
void say_of_lens(const char* side, const LensFit& fit, std::vector<std::string>& notes) {
  constexpr double kFarEnough = 0.65;  // of the way to the corner
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

}  // namespace

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

}  // namespace enc::app
