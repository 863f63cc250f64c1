// Single-precision functions that libmujoco calls, computed by those of double.
#include <cmath>

extern "C" {

float sinf(float x) noexcept { return static_cast<float>(std::sin(static_cast<double>(x))); }
float cosf(float x) noexcept { return static_cast<float>(std::cos(static_cast<double>(x))); }
float log10f(float x) noexcept { return static_cast<float>(std::log10(static_cast<double>(x))); }
float atan2f(float y, float x) noexcept {
  return static_cast<float>(std::atan2(static_cast<double>(y), static_cast<double>(x)));
}
float powf(float x, float y) noexcept {
  return static_cast<float>(std::pow(static_cast<double>(x), static_cast<double>(y)));
}

}  // extern "C"
