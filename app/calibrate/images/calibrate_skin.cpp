// `encounter calibrate skin FOLDER`: the colour of skin from images of hands and their masks [VisHap 2.1.1].
// It also reports how well hue alone separates a hand from the rest of these images.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/calibrate/images/commands.h"
#include "app/common/words.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/base/words.h"
#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/skin.h"
#include "hw_drivers/images/files/pair_list.h"
#include "models/files.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;
using segmentation::HueRule;

struct HandFiles {
  std::string image, mask;
};

// Pixels of the hand or of the rest.
struct HueCounts {
  std::array<std::int64_t, segmentation::kHues> hue{};
  std::int64_t grey = 0, dark = 0;  // pixels without hue: chroma, or brightest channel, below HueRule
  std::int64_t all = 0;
};
struct SkinStudy {
  std::size_t images = 0;
  SkinModel model;
  HueCounts hand, rest;
  std::vector<std::string> unlike;  // masks with mostly other hues than the model's
};

constexpr int kWhite = 128;                         // 0 to 255: at least this mean of the channels is hand
constexpr int kFirstGrey = 64, kLastGrey = 191;     // other values in between: the mask is a picture
constexpr double kMostGrey = 0.05;                  // share of a mask's pixels: edges blurred by JPEG
constexpr double kLeastSpread = 0.01 / kDegPerRad;  // rad
constexpr double kWideSpread = 20.0 / kDegPerRad;   // rad; skin of all tones together has less than 8 deg
constexpr double kManyWithout = 0.1;                // share of the hand's pixels
constexpr std::array<double, 5> kSigmas{1.5, 2.0, 2.5, 3.0, 3.5};

std::map<std::string, std::string> by_stem(const std::string& folder) {
  std::map<std::string, std::string> found;
  for (const std::string& path : images::images_in(folder)) {
    const auto [other, is_new] = found.emplace(std::filesystem::path(path).stem().string(), path);
    if (!is_new)
      throw Error(fmt::format("{}: {} is the same image by its name; expected one of them; remove the other",
                              path, other->second));
  }
  return found;
}

void refuse_empty(bool empty, const std::string& folder) {
  if (empty)
    throw Error(
        fmt::format("{}: has no images; expected PNG or JPEG files; see docs/guide/camera.md", folder));
}

// White pixels are hand.
void read_mask(const std::string& path, Image& image, Mask& mask) {
  images::read_image(path, image);
  if (mask.width != image.width || mask.height != image.height) mask = Mask(image.width, image.height);
  std::int64_t grey = 0, hand = 0;
  for (std::size_t i = 0; i < mask.on.size(); ++i) {
    const std::uint8_t* p = image.rgb.data() + 3 * i;
    const int mean = (p[0] + p[1] + p[2]) / 3;
    grey += mean >= kFirstGrey && mean <= kLastGrey ? 1 : 0;
    hand += mean >= kWhite ? 1 : 0;
    mask.on[i] = mean >= kWhite ? 255 : 0;
  }
  const auto all = static_cast<std::int64_t>(mask.on.size());
  const char* const wanted = "expected white where the hand is and black elsewhere";
  if (static_cast<double>(grey) > kMostGrey * static_cast<double>(all))
    throw Error(
        fmt::format("{}: is no mask: {:.0f} % of its pixels are neither black nor white; {}; see to its "
                    "name",
                    path, 1e2 * static_cast<double>(grey) / static_cast<double>(all), wanted));
  if (hand == 0)
    throw Error(
        fmt::format("{}: has no hand: no pixel is white, {} or more of 255; {}; draw it or take the "
                    "image away",
                    path, kWhite, wanted));
  if (hand == all)
    throw Error(fmt::format("{}: is all hand: every pixel is white; {}; draw it anew", path, wanted));
}

void count(const Image& image, const Mask& mask, SkinStudy& study) {
  const HueRule rule;
  for (std::size_t i = 0; i < mask.on.size(); ++i) {
    const std::uint8_t* p = image.rgb.data() + 3 * i;
    HueCounts& to = mask.on[i] != 0 ? study.hand : study.rest;
    const int hue = segmentation::hue_of(p[0], p[1], p[2], rule);
    ++to.all;
    if (hue != segmentation::kNoHue)
      ++to.hue[static_cast<std::size_t>(hue)];
    else
      ++(std::max(p[0], std::max(p[1], p[2])) < rule.least_value ? to.dark : to.grey);
  }
}

// Share of the pixels whose hue is within this many spreads of the mean.
double taken(const SkinStudy& study, const HueCounts& of, double sigmas) {
  const segmentation::Arc arc = segmentation::skin_arc(study.model, sigmas);
  std::int64_t sum = 0;
  for (int hue = 0; hue < segmentation::kHues; ++hue)
    if (arc.has(hue)) sum += of.hue[static_cast<std::size_t>(hue)];
  return static_cast<double>(sum) / static_cast<double>(of.all);
}

// Throws an Error that names the image.
SkinModel model_of(const SkinLearner& learner, const std::string& image) {
  if (learner.pixels() < 2)
    throw Error(
        fmt::format("{}: the hand in it has no hue: the image is grey, or the hand too dark; expected "
                    "a colour image of a lit hand; take it again",
                    image));
  try {
    return learner.model();
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}; see to its mask", image, e.what()));
  }
}

std::int64_t learned(const SkinStudy& study) { return study.hand.all - study.hand.grey - study.hand.dark; }

double rounded(double angle) { return std::round(angle * kDegPerRad * 1e3) / 1e3; }

std::string roc_text(const SkinStudy& study) {
  std::string out = fmt::format("{:12}{:>16}{:>16}\n", "skin_sigmas", "of the hand, %", "of the rest, %");
  for (const double sigmas : kSigmas)
    out += fmt::format("{:<12}{:>16.2f}{:>16.2f}{}\n", sigmas, 1e2 * taken(study, study.hand, sigmas),
                       1e2 * taken(study, study.rest, sigmas),
                       sigmas == SegmentationSpec{}.skin ? "   default" : "");
  return out;
}

std::string notes_text(const SkinStudy& study) {
  std::string out;
  const auto say = [&](const std::string& what) { out += "note        " + models::printable(what) + "\n"; };
  if (!study.unlike.empty())
    say(fmt::format("most of the hand is of another hue in {}: see to the mask, and to the light",
                    fmt::join(study.unlike, ", ")));
  if (study.model.spread > kWideSpread)
    say(fmt::format("a spread of {:.0f} deg is more than skin has: see to the masks",
                    study.model.spread * kDegPerRad));
  const double without = 1.0 - static_cast<double>(learned(study)) / static_cast<double>(study.hand.all);
  if (without > kManyWithout)
    say(fmt::format(
        "{:.0f} % of the hand has no hue and will hardly be found as skin: give it more light, or "
        "expose longer",
        1e2 * without));
  return out;
}

// list_hands() and study_skin() throw Error in one line that begins with a folder or a file. Errors are: a
// mask or an image without its partner, or of another size; a mask that is a picture, or shows no hand or
// only a hand; a hand without any hue. After list_hands(), no output can overwrite the files.
std::vector<HandFiles> list_hands(const std::string& images, const std::string& masks) {
  const std::vector<std::string> paths = images::images_in(images);
  refuse_empty(paths.empty(), images);
  std::map<std::string, std::string> partners = by_stem(masks);
  refuse_empty(partners.empty(), masks);
  (void)by_stem(images);  // checks that no name occurs twice
  std::vector<HandFiles> files;
  for (const std::string& path : paths) {
    const auto mask = partners.find(std::filesystem::path(path).stem().string());
    if (mask == partners.end())
      throw Error(
          fmt::format("{}: has no mask in {}; expected an image of the same name there; draw it or take "
                      "this one away",
                      path, masks));
    files.push_back({path, mask->second});
    models::note_input(path);
    models::note_input(mask->second);
    partners.erase(mask);
  }
  if (!partners.empty())
    throw Error(
        fmt::format("{}: is a mask without its image in {}; expected one of the same name; add it or "
                    "take the mask away",
                    partners.begin()->second, images));
  for (const HandFiles& each : files) {
    const ImageSize image = images::image_size(each.image), mask = images::image_size(each.mask);
    if (image != mask)
      throw Error(fmt::format("{}: is {} x {} px; expected {} x {} as its image {}; draw it anew", each.mask,
                              mask.width, mask.height, image.width, image.height, each.image));
  }
  return files;
}

SkinStudy study_skin(const std::vector<HandFiles>& files) {
  SkinStudy study;
  study.images = files.size();
  SkinLearner learner;
  std::vector<double> means;  // mean of each image
  Image image, drawn;
  Mask mask;
  for (const HandFiles& each : files) {
    images::read_image(each.image, image);
    read_mask(each.mask, drawn, mask);
    SkinLearner alone;
    alone.add(image.view(), mask);
    means.push_back(model_of(alone, each.image).hue);
    learner.add(image.view(), mask);
    count(image, mask, study);
  }
  study.model = model_of(learner, files.front().image);
  if (study.model.spread < kLeastSpread)
    throw Error(
        fmt::format("{}: all hands have one hue, {:.2f} deg, without any spread; expected images of a "
                    "camera; take others",
                    files.front().image, study.model.hue * kDegPerRad));
  for (std::size_t i = 0; i < files.size(); ++i)
    if (std::abs(std::remainder(means[i] - study.model.hue, 2.0 * std::numbers::pi)) >
        SegmentationSpec{}.skin * study.model.spread)
      study.unlike.push_back(std::filesystem::path(files[i].image).filename().string());
  return study;
}

std::string skin_text(const SkinStudy& study) {
  const HueRule rule;
  return fmt::format(
             "{}; {} of {} px are hand\n"
             "left out    {} px of the hand that have no hue: {} grey (chroma below {} of 255), {} dark "
             "(brightest channel below {})\n"
             "skin        hue {:.3f} deg, spread {:.3f} deg, of {} px\n",
             counted(study.images, "image"), study.hand.all, study.hand.all + study.rest.all,
             study.hand.grey + study.hand.dark, study.hand.grey, rule.least_chroma, study.hand.dark,
             rule.least_value, study.model.hue * kDegPerRad, study.model.spread * kDegPerRad,
             learned(study)) +
         roc_text(study) + notes_text(study) +
         fmt::format(
             "set         rig.vision.skin_hue_deg = {:g}\nset         rig.vision.skin_spread_deg = {:g}\n",
             rounded(study.model.hue), rounded(study.model.spread));
}

std::string skin_json(const SkinStudy& study) {
  Json json;
  json["images"] = study.images;
  json["skin_hue_deg"] = rounded(study.model.hue);
  json["skin_spread_deg"] = rounded(study.model.spread);
  json["pixels"] = {{"hand", study.hand.all},
                    {"rest", study.rest.all},
                    {"learned", learned(study)},
                    {"grey", study.hand.grey},
                    {"dark", study.hand.dark}};
  json["skin_sigmas"] = SegmentationSpec{}.skin;
  json["roc"] = Json::array();
  for (const double sigmas : kSigmas)
    json["roc"].push_back({{"skin_sigmas", sigmas},
                           {"of_hand", taken(study, study.hand, sigmas)},
                           {"of_rest", taken(study, study.rest, sigmas)}});
  json["unlike"] = study.unlike;
  return json.dump(2);
}

// The lines for a rig's table [vision].
std::string skin_toml(const SkinStudy& study) {
  return fmt::format(
      "# Of a rig's file: skin in {}, {} px.\n"
      "[vision]\n"
      "skin_hue_deg = {:g}\n"
      "skin_spread_deg = {:g}\n",
      counted(study.images, "image"), learned(study), rounded(study.model.hue), rounded(study.model.spread));
}

}  // namespace

int calibrate_skin(const SkinOptions& options) {
  const std::vector<HandFiles> files = list_hands(options.folder, options.masks);
  std::optional<models::OutFile> file;  // refused before the work
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  const SkinStudy study = study_skin(files);
  if (file) {
    file->write(
        made_by(fmt::format("skin {} --masks {}", shell_word(options.folder), shell_word(options.masks))) +
        skin_toml(study));
    file->keep();
  }
  fmt::print("{}{}", options.json ? skin_json(study) : skin_text(study), options.json ? "\n" : "");
  return 0;
}

}  // namespace enc::app
