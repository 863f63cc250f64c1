#include "core/vision/segmentation/kernels/hue.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace enc::segmentation {

Arc skin_arc(const SkinModel& model, double spreads) {
  constexpr double kStep = 2.0 * std::numbers::pi / kHues;
  const double half = spreads * model.spread;
  if (half >= std::numbers::pi) return {0, kHues};
  const auto first = static_cast<int>(std::ceil((model.hue - half) / kStep - 0.5));
  const auto last = static_cast<int>(std::floor((model.hue + half) / kStep - 0.5));
  return {((first % kHues) + kHues) % kHues, std::clamp(last - first + 1, 0, kHues)};
}

Cut cut_of(const Arc& arc, const HueRule& rule) {
  Cut cut{};
  cut.least_chroma = std::max<std::uint8_t>(1, rule.least_chroma);
  cut.least_value = rule.least_value;
  Arc part = arc;
  if (arc.count > kHues / 2) {
    part = {(arc.first + arc.count) % kHues, kHues - arc.count};
    cut.opposite = 255;
  }
  std::fill(std::begin(cut.sextant), std::end(cut.sextant), std::uint8_t{Cut::never});
  if (part.count == 0) return cut;
  // A border at the first hue of a sextant is share 256 of the previous sextant: a pixel there may count as
  // in either.
  const int from = (part.first + kHues - 1) % kHues;
  const int to = from + part.count;
  for (int sextant = from / kSextant; sextant <= to / kSextant; ++sextant) cut.sextant[sextant % 6] = 0;
  cut.sextant[from / kSextant] |= Cut::past_from;
  cut.sextant[to / kSextant % 6] |= Cut::before_to;
  cut.from = static_cast<std::uint16_t>(from % kSextant + 1);
  cut.to = static_cast<std::uint16_t>(to % kSextant + 1);
  return cut;
}

bool in_cut(int hue, const Cut& cut) {
  if (hue == kNoHue) return false;
  const int share = hue % kSextant;
  const auto asks = [&](int sextant, int of) {
    const std::uint8_t what = cut.sextant[sextant];
    return (what & Cut::never) == 0 && ((what & Cut::past_from) == 0 || of >= cut.from) &&
           ((what & Cut::before_to) == 0 || of < cut.to);
  };
  // The first hue of a sextant is also the last of the previous one, where a border of 256 lies.
  const int sextant = hue / kSextant;
  const bool in = share > 0 ? asks(sextant, share) : asks((sextant + 5) % 6, kSextant);
  return in != (cut.opposite != 0);
}

}  // namespace enc::segmentation
