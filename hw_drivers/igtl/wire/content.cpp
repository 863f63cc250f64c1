#include "hw_drivers/igtl/wire/content.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "hw_drivers/net/big_endian.h"

namespace enc::igtl {
namespace {

using net::put;
using net::take;

// Rounding of single precision and of the sender's arithmetic.
constexpr double kRounding = 1e-5;
constexpr std::size_t kType = 20, kMatrix = 22;  // offsets in an element
constexpr std::byte kSixDegrees{2};

double single(std::span<const std::byte> content, std::size_t index) noexcept {
  return std::bit_cast<float>(take<std::uint32_t>(content, 4 * index));
}

}  // namespace

bool read_transform(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept {
  if (content.size() != kTransform) return false;
  std::array<double, 12> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = single(content, i);
    if (!std::isfinite(numbers[i])) return false;
  }
  const Eigen::Matrix3d turn = Eigen::Map<const Eigen::Matrix3d>(numbers.data());
  if (!(turn.transpose() * turn).isIdentity(kRounding) || !(turn.determinant() > 0.0)) return false;
  X_CT = Pose<'C', 'T'>(Quat(turn).normalized(), 1e-3 * Vec3(numbers[9], numbers[10], numbers[11]));
  return true;
}

std::array<std::byte, kTransform> transform(const Pose<'C', 'T'>& X_CT) noexcept {
  std::array<double, 12> numbers{};
  Eigen::Map<Eigen::Matrix3d>(numbers.data()) = X_CT.q().toRotationMatrix();
  Eigen::Map<Vec3>(numbers.data() + 9) = 1e3 * X_CT.p();
  std::array<std::byte, kTransform> content{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    put(content, 4 * i, std::bit_cast<std::uint32_t>(static_cast<float>(numbers[i])));
  return content;
}

bool read_position(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept {
  constexpr std::size_t kWhole = 28, kThree = 24;
  if (content.size() != kWhole && content.size() != kThree) return false;
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < content.size() / 4; ++i) {
    numbers[i] = single(content, i);
    if (!std::isfinite(numbers[i])) return false;
  }
  const Vec3 xyz(numbers[3], numbers[4], numbers[5]);
  if (content.size() == kThree) numbers[6] = std::sqrt(std::max(0.0, 1.0 - xyz.squaredNorm()));
  const Quat q(numbers[6], xyz.x(), xyz.y(), xyz.z());
  if (!(std::abs(q.norm() - 1.0) < kRounding)) return false;
  X_CT = Pose<'C', 'T'>(q.normalized(), 1e-3 * Vec3(numbers[0], numbers[1], numbers[2]));
  return true;
}

std::size_t elements_of(std::span<const std::byte> content) noexcept {
  return content.size() % kElement == 0 ? content.size() / kElement : 0;
}

bool read_element(std::span<const std::byte> content, std::size_t index, Element& element) noexcept {
  const std::span<const std::byte> bytes = content.subspan(kElement * index, kElement);
  element.name = take_name<20>(bytes, 0);
  return bytes[kType] == kSixDegrees && read_transform(bytes.subspan(kMatrix), element.X_CT);
}

std::array<std::byte, kElement> element(std::string_view name, const Pose<'C', 'T'>& X_CT) noexcept {
  std::array<std::byte, kElement> content{};
  put_name<20>(content, 0, name);
  content[kType] = kSixDegrees;
  const auto matrix = transform(X_CT);
  std::copy(matrix.begin(), matrix.end(), content.begin() + kMatrix);
  return content;
}

std::array<std::byte, 36> ask_for_tdata(std::int32_t resolution_ms) noexcept {
  std::array<std::byte, 36> content{};
  put(content, 0, resolution_ms);
  return content;
}

std::string pose_text(const Pose<'C', 'T'>& X_CT) {
  const auto& q = X_CT.xyzw;
  const Vec3 p = 1e3 * X_CT.p();
  return fmt::format("{} {} {} {} {} {} {}", p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]);
}

bool read_pose(std::string_view text, Pose<'C', 'T'>& X_CT) noexcept {
  std::array<double, 7> numbers{};
  for (double& number : numbers) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || !std::isfinite(number)) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  const Quat q(numbers[6], numbers[3], numbers[4], numbers[5]);
  constexpr double kUnit = 1e-9;
  if (!text.empty() || !(std::abs(q.norm() - 1.0) < kUnit)) return false;
  X_CT = Pose<'C', 'T'>(q, 1e-3 * Vec3(numbers[0], numbers[1], numbers[2]));
  return true;
}

bool says_valid(std::span<const std::byte> metadata) noexcept {
  const std::string_view state = value_of(metadata, "TransformStatus"),
                         good = value_of(metadata, "TransformValid");
  return (state.empty() || state == "OK") && good != "0" && good != "false" && good != "FALSE";
}

bool read_status(std::span<const std::byte> content, int& code) noexcept {
  if (content.size() < 30) return false;
  code = take<std::uint16_t>(content, 0);
  return true;
}

std::array<std::byte, 31> status(std::uint16_t code) noexcept {
  std::array<std::byte, 31> content{};
  put(content, 0, code);
  return content;
}

}  // namespace enc::igtl
