#include "sim/camera/sensor.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "sim/truth/random.h"

namespace enc::sim {
namespace {

constexpr std::size_t kTable = 1U << 18U;

double rms_of_rounded(const std::vector<float>& normal, double scale) {
  double sum = 0.0;
  for (const float n : normal) {
    const double whole = std::round(scale * static_cast<double>(n));
    sum += whole * whole;
  }
  return std::sqrt(sum / static_cast<double>(normal.size()));
}

// Of the normal numbers before rounding: found by halving, because rounding adds noise of its own.
double scale_for(const std::vector<float>& normal, double rms) {
  double low = 0.0, high = rms + 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (rms_of_rounded(normal, middle) < rms ? low : high) = middle;
  }
  return high;
}

}  // namespace

SensorNoise::SensorNoise(double rms, std::uint64_t seed) : seed_(seed) {
  if (!(rms >= 0.0 && rms <= 30.0))
    throw Error("the noise of an image sensor is 0 to 30 of 255", "truth.camera.noise_of_255");
  if (rms == 0.0) return;
  Stream stream(seed, "sensor");
  std::vector<float> normal(kTable);
  for (float& n : normal) n = static_cast<float>(stream.normal());
  const double scale = scale_for(normal, rms);
  table_.reserve(kTable);
  for (const float n : normal)
    table_.push_back(
        static_cast<std::int8_t>(std::clamp(std::round(scale * static_cast<double>(n)), -127.0, 127.0)));
}

// Each row takes a stretch of the table that begins anywhere.
void SensorNoise::add(Image& image, std::uint64_t frame, std::uint64_t eye) const {
  if (table_.empty()) return;
  Stream starts(seed_ ^ (2 * frame + eye + 1) * 0x9e3779b97f4a7c15ULL, "rows");
  const std::size_t row = std::min(3 * static_cast<std::size_t>(image.width), kTable);
  for (int y = 0; y < image.height; ++y) {
    std::uint8_t* pixel = image.at(0, y);
    const std::int8_t* noise = table_.data() + starts.bits() % (kTable - row + 1);
    for (std::size_t i = 0; i < row; ++i) {
      const int sum = pixel[i] + noise[i];
      pixel[i] = static_cast<std::uint8_t>(std::clamp(sum, 0, 255));
    }
  }
}

}  // namespace enc::sim
