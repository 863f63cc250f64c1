#include "trial/sweep/design.h"

#include <array>
#include <bit>

#include <Random123/philox.h>

namespace enc::trial {
namespace {

constexpr unsigned kBits = 32;

constexpr unsigned kDoubleBits = 53;  // of a double's fraction
std::uint64_t shortened(std::uint64_t bits) { return bits >> (64 - kDoubleBits); }

// Primitive polynomials and initial direction numbers, from the second axis on [Joe and Kuo 2008, file
// new-joe-kuo-6.21201].
struct Directions {
  unsigned degree, coefficients;
  std::array<std::uint32_t, 7> first;
};
constexpr std::array<Directions, kMostSobolAxes - 1> kDirections{{{1, 0, {1}},
                                                                  {2, 1, {1, 3}},
                                                                  {3, 1, {1, 3, 1}},
                                                                  {3, 2, {1, 1, 1}},
                                                                  {4, 1, {1, 1, 3, 3}},
                                                                  {4, 4, {1, 3, 5, 13}},
                                                                  {5, 2, {1, 1, 5, 5, 17}},
                                                                  {5, 4, {1, 1, 5, 5, 5}},
                                                                  {5, 7, {1, 1, 7, 11, 19}},
                                                                  {5, 11, {1, 1, 5, 1, 1}},
                                                                  {5, 13, {1, 1, 1, 3, 11}},
                                                                  {5, 14, {1, 3, 5, 5, 31}},
                                                                  {6, 1, {1, 3, 3, 9, 7, 49}},
                                                                  {6, 13, {1, 1, 1, 15, 21, 21}},
                                                                  {6, 16, {1, 3, 1, 13, 27, 49}},
                                                                  {6, 19, {1, 1, 1, 15, 7, 5}},
                                                                  {6, 22, {1, 3, 1, 15, 13, 25}},
                                                                  {6, 25, {1, 1, 5, 5, 19, 61}},
                                                                  {7, 1, {1, 3, 7, 11, 23, 15, 103}},
                                                                  {7, 4, {1, 3, 7, 13, 13, 15, 69}}}};

using Vectors = std::array<std::uint32_t, kBits>;

Vectors vectors_of(std::size_t axis) {
  Vectors v{};
  if (axis == 0) {
    for (unsigned i = 0; i < kBits; ++i) v.at(i) = 1U << (kBits - 1 - i);
    return v;
  }
  const Directions& d = kDirections.at(axis - 1);
  for (unsigned i = 0; i < kBits; ++i) {
    if (i < d.degree) {
      v.at(i) = d.first.at(i) << (kBits - 1 - i);
      continue;
    }
    v.at(i) = v.at(i - d.degree) ^ (v.at(i - d.degree) >> d.degree);
    for (unsigned k = 1; k < d.degree; ++k)
      if ((d.coefficients >> (d.degree - 1 - k) & 1U) != 0) v.at(i) ^= v.at(i - k);
  }
  return v;
}

}  // namespace

std::uint64_t counter_bits(std::uint64_t key, std::uint64_t number, std::uint32_t axis,
                           CounterStream stream) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> kBits); };
  const r123::Philox4x32::ctr_type counter{
      {low(number), high(number), axis, static_cast<std::uint32_t>(stream)}};
  const r123::Philox4x32::key_type words{{low(key), high(key)}};
  const r123::Philox4x32::ctr_type random = r123::Philox4x32()(counter, words);
  return static_cast<std::uint64_t>(random[1]) << kBits | random[0];
}

std::uint32_t sobol(std::size_t axis, std::uint32_t point) {
  static const std::array<Vectors, kMostSobolAxes> kVectors = [] {
    std::array<Vectors, kMostSobolAxes> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all.at(i) = vectors_of(i);
    return all;
  }();
  std::uint32_t x = 0;
  for (std::uint32_t gray = point ^ (point >> 1U); gray != 0; gray &= gray - 1)
    x ^= kVectors.at(axis).at(static_cast<std::size_t>(std::countr_zero(gray)));
  return x;
}

Design::Design(const SweepSpec& spec) : spec_(spec), hash_(text_hash(design_text(spec))) {}

double Design::share(std::size_t axis, std::int64_t point) const {
  const auto n = static_cast<std::uint64_t>(point);
  const auto a = static_cast<std::uint32_t>(axis);
  if (spec_.design == DesignKind::random)
    return static_cast<double>(shortened(counter_bits(hash_, n, a, CounterStream::points))) * 0x1p-53;
  // A random shift keeps the spread of the sequence, and moves its first point away from the corner.
  const auto shift = static_cast<std::uint32_t>(counter_bits(hash_, 0, a, CounterStream::shifts));
  return (static_cast<double>(sobol(axis, static_cast<std::uint32_t>(n)) ^ shift) + 0.5) * 0x1p-32;
}

std::vector<std::string> Design::values(std::int64_t point) const {
  std::vector<std::string> all(spec_.axes.size());
  for (std::size_t i = all.size(); i-- > 0;) {
    const Axis& axis = spec_.axes[i];
    if (spec_.design != DesignKind::grid) {
      all[i] = axis.at(share(i, point));
      continue;
    }
    // The last axis changes fastest.
    const std::int64_t size =
        axis.levels.empty() ? axis.steps : static_cast<std::int64_t>(axis.levels.size());
    const std::int64_t level = point % size;
    point /= size;
    all[i] = axis.levels.empty() ? axis.at(static_cast<double>(level) / static_cast<double>(axis.steps - 1))
                                 : axis.levels[static_cast<std::size_t>(level)];
  }
  return all;
}

std::uint64_t Design::seed(std::int64_t run) const {
  return shortened(counter_bits(hash_, static_cast<std::uint64_t>(run), 0, CounterStream::seeds));
}

}  // namespace enc::trial
