#include "core/vision/hand/hand_form.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace enc {
namespace {

constexpr double kAside = 5.0;          // radii: distance examined on either side
constexpr double kWidens = 1.55;        // times the finger's width: at this width it ends in a hand
constexpr double kStep = 0.25;          // radii
constexpr std::size_t kMostSteps = 96;  // steps

struct CrossSection {
  double left = 0.0, right = 0.0;  // px of skin on either side of the middle line
  [[nodiscard]] double width() const { return left + right; }
};

class Walk {
 public:
  Walk(const Mask& skin, const Fingertip& tip, const Region& part)
      : skin_(skin),
        part_(part),
        at_{tip.column, tip.row},
        along_x_(tip.along_x),
        along_y_(tip.along_y),
        radius_(tip.outline) {}

  [[nodiscard]] const Pixel& at() const { return at_; }
  // Takes one step along the finger. False at the end of the image or of the part that counts.
  bool step() {
    at_ = {at_.column + kStep * radius_ * along_x_, at_.row + kStep * radius_ * along_y_};
    return part_.contains(x_of(at_), y_of(at_));
  }
  [[nodiscard]] CrossSection across() const {
    CrossSection seen;
    if (!on(0.0)) return seen;
    seen.left = side(-1.0);
    seen.right = side(1.0);
    return seen;
  }
  // Moves to the middle of the cross-section and turns with it: half as far, because edges are rough.
  void centre(const CrossSection& seen) {
    const double off = 0.25 * (seen.right - seen.left);
    at_ = {at_.column - off * along_y_, at_.row + off * along_x_};
    const double turn = 0.3 * off / radius_;
    const double x = along_x_ - turn * along_y_, y = along_y_ + turn * along_x_,
                 norm = std::sqrt(x * x + y * y);
    along_x_ = x / norm;
    along_y_ = y / norm;
  }

 private:
  static int x_of(const Pixel& p) { return static_cast<int>(std::lround(p.column)); }
  static int y_of(const Pixel& p) { return static_cast<int>(std::lround(p.row)); }
  [[nodiscard]] Pixel aside(double far) const {
    return {at_.column - far * along_y_, at_.row + far * along_x_};
  }
  [[nodiscard]] bool on(double far) const {
    const Pixel p = aside(far);
    return part_.contains(x_of(p), y_of(p)) && skin_.at(x_of(p), y_of(p));
  }
  [[nodiscard]] double side(double sign) const {
    const double most = kAside * radius_;
    double far = 0.0;
    while (far < most && on(sign * (far + 1.0))) far += 1.0;
    return far + 0.5;
  }

  const Mask& skin_;
  const Region& part_;
  Pixel at_;
  double along_x_, along_y_, radius_;
};

}  // namespace

Region form_region(const Fingertip& tip, double reach, const Region& image) {
  const double r = tip.outline, x = tip.column + reach * r * tip.along_x,
               y = tip.row + reach * r * tip.along_y;
  const double aside = (kAside + 1.0) * r;
  return Region{static_cast<int>(std::min(tip.column, x) - aside),
                static_cast<int>(std::min(tip.row, y) - aside),
                static_cast<int>(std::max(tip.column, x) + aside) + 1,
                static_cast<int>(std::max(tip.row, y) + aside) + 1}
      .cut(image);
}

FingerForm form_of(const Mask& skin, const Fingertip& tip, double reach) {
  FingerForm form;
  const Region part = form_region(tip, reach, skin.whole());
  Walk walk(skin, tip, part);
  std::array<double, kMostSteps> widths{};
  std::array<Pixel, kMostSteps> line{};
  std::size_t count = 0;
  double usual = 2.0 * tip.outline;
  const auto steps = std::min(kMostSteps, static_cast<std::size_t>(reach / kStep));
  for (std::size_t i = 0; i < steps; ++i) {
    if (!walk.step()) {
      form.end = skin.whole().contains(static_cast<int>(std::lround(walk.at().column)),
                                       static_cast<int>(std::lround(walk.at().row)))
                     ? form.end
                     : FormEnd::border;
      break;
    }
    const CrossSection seen = walk.across();
    if (seen.width() <= 0.0) break;
    if (seen.width() > kWidens * usual) {
      form.end = FormEnd::hand;
      continue;
    }
    if (form.end == FormEnd::hand) continue;
    line[count] = walk.at();
    widths[count++] = seen.width();
    walk.centre(seen);
    usual = 0.9 * usual + 0.1 * seen.width();
  }
  if (count == 0) return form;
  for (std::size_t i = 0; i < FingerForm::kSpots; ++i)
    form.spots[i] = line[i * (count - 1) / (FingerForm::kSpots - 1)];
  form.length = tip.outline + std::hypot(line[count - 1].column - tip.column, line[count - 1].row - tip.row);
  form.width = upper_median(std::span(widths.data(), count));
  return form;
}

PalmFinder::PalmFinder(int width, int height)
    : columns_(std::max(3, width / kGrid)),
      rows_(std::max(3, height / kGrid)),
      thick_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

// Distances with weights 3 and 4 for straight and diagonal steps, in two passes [Borgefors 1986].
void PalmFinder::measure(const Mask& skin) {
  std::fill(thick_.begin(), thick_.end(), 0);
  const auto on = [&](int column, int row) {
    return skin.whole().contains(column * kGrid, row * kGrid) && skin.at(column * kGrid, row * kGrid);
  };
  for (int row = 1; row < rows_ - 1; ++row)
    for (int column = 1; column < columns_ - 1; ++column)
      if (on(column, row))
        thick_[at(column, row)] =
            std::min({thick_[at(column - 1, row)] + 3, thick_[at(column, row - 1)] + 3,
                      thick_[at(column - 1, row - 1)] + 4, thick_[at(column + 1, row - 1)] + 4});
  for (int row = rows_ - 2; row > 0; --row)
    for (int column = columns_ - 2; column > 0; --column)
      if (int& here = thick_[at(column, row)]; here > 0)
        here = std::min({here, thick_[at(column + 1, row)] + 3, thick_[at(column, row + 1)] + 3,
                         thick_[at(column + 1, row + 1)] + 4, thick_[at(column - 1, row + 1)] + 4});
}

Pixel PalmFinder::near(const Pixel& tip, double far) const {
  constexpr double kAbout = 0.88;
  const auto off = [&](int column, int row) {
    return std::hypot(column * kGrid - tip.column, row * kGrid - tip.row);
  };
  int most = 0;
  const auto each = [&](const auto& look) {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        if (const int thick = thick_[at(column, row)]; thick > 0 && off(column, row) < far)
          look(column, row, thick);
  };
  each([&](int, int, int thick) { most = std::max(most, thick); });
  Pixel nearest;
  double least = far;
  each([&](int column, int row, int thick) {
    if (thick < kAbout * most || off(column, row) >= least) return;
    least = off(column, row);
    nearest = {static_cast<double>(column * kGrid), static_cast<double>(row * kGrid)};
  });
  return nearest;
}

}  // namespace enc
