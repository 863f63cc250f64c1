#include "core/vision/segmentation/segmenter.h"

#include <cmath>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/spec/vision_check.h"
#include "core/vision/segmentation/change.h"
#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/kernels/majority.h"
#include "core/vision/segmentation/tiles.h"

namespace enc {
namespace {

namespace s = segmentation;

std::string size(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

void within(int value, int least, int most, const char* what) {
  if (value < least || value > most)
    throw Error(std::string(what) + " is " + std::to_string(value) + "; expected " + std::to_string(least) +
                " to " + std::to_string(most));
}

void at_least_zero(double value, const char* what) {
  if (!(value >= 0.0) || !std::isfinite(value))
    throw Error(std::string("the threshold of ") + what + " is below 0 or no number");
}

void check_all(const SegmentationSpec& spec, int width, int height) {
  within(width, 1, 1 << 14, "the width of images");
  within(height, 1, 1 << 14, "the height of images");
  check(spec);
}

}  // namespace

struct Segmenter::Parts {
  SegmentationSpec spec;
  s::Grid grid;
  const s::Kernels& kernels = s::kernels();
  s::Cut cut{};
  std::optional<s::Background> background;  // while it is being learned
  std::optional<s::Tiles> tiles;            // afterwards one of these two
  std::optional<s::Change> change;
  s::Majority median;
  Mask candidates;
  double unrest = 0.0;

  Parts(const SegmentationSpec& given, int width, int height)
      : spec(given),
        grid{width, height, given.tile},
        background(grid),
        median(kernels, given.median, width),
        candidates(width, height) {
    judge();
  }

  void judge() { cut = s::cut_of(s::skin_arc(spec.model, spec.skin), spec.hue); }
  void fits(int width, int height, const char* what) const {
    if (width != grid.width || height != grid.height)
      throw Error(std::string(what) + " has " + size(width, height) + "; expected " +
                  size(grid.width, grid.height));
  }
  void make_model() {
    const Image mean = background->mean();
    const std::vector<double> noise = background->noise();
    unrest = s::unrest(noise);
    if (spec.method == SegmentationMethod::ours) {
      change.emplace(kernels, grid, mean, noise);
    } else {
      tiles.emplace(kernels, grid, spec.bins);
      tiles->learn(mean, cut);
    }
    background.reset();
  }
};

Segmenter::Segmenter(const SegmentationSpec& spec, int width, int height) {
  check_all(spec, width, height);
  parts_ = std::make_unique<Parts>(spec, width, height);
}
Segmenter::~Segmenter() = default;
Segmenter::Segmenter(Segmenter&&) noexcept = default;
Segmenter& Segmenter::operator=(Segmenter&&) noexcept = default;

bool Segmenter::learn(const ImageView& frame) {
  parts_->fits(frame.width, frame.height, "a frame of the background");
  if (learned()) return true;
  parts_->background->add(frame);
  if (parts_->background->frames() < parts_->spec.background_frames) return false;
  parts_->make_model();
  return true;
}

bool Segmenter::learned() const { return !parts_->background; }

double Segmenter::unrest() const { return parts_->unrest; }

void Segmenter::thresholds(double foreground, double skin) {
  at_least_zero(foreground, "foreground");
  at_least_zero(skin, "skin");
  parts_->spec.match = parts_->spec.change = foreground;
  parts_->spec.skin = skin;
  parts_->judge();
}

Region Segmenter::on_grid(const Region& wanted) const { return parts_->grid.touched(wanted); }

Region Segmenter::segment(const ImageView& frame, const Region& wanted, Mask& skin) {
  Parts& p = *parts_;
  if (!learned())
    throw Error("the background is not learned: " + std::to_string(p.background->frames()) + " of " +
                std::to_string(p.spec.background_frames) + " frames");
  p.fits(frame.width, frame.height, "the frame");
  p.fits(skin.width, skin.height, "the mask");
  const Region region = on_grid(wanted);
  if (region.empty()) return region;
  // The median reads beyond the region, so the candidates there must be right, too.
  const Region wide = p.grid.touched(region, p.median.margin());
  if (p.tiles) p.tiles->candidates(frame, wide, p.spec.match, p.cut, p.candidates);
  if (p.change) p.change->candidates(frame, wide, p.spec.change, p.cut, p.candidates);
  p.median.filter(p.candidates, region, skin);
  return region;
}

}  // namespace enc
