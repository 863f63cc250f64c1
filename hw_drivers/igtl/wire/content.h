// OpenIGTLink content of a tracked tool: its pose in one message (TRANSFORM, POSITION), the poses of several
// tools in one (TDATA), and the server's status (STATUS). Lengths in mm, single precision.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/frames.h"
#include "hw_drivers/igtl/wire/message.h"

namespace enc::igtl {

inline constexpr std::size_t kTransform = 48, kElement = 70;

// TRANSFORM: the columns of the rotation, then the position. Returns false if its size is wrong, or if it
// holds something other than finite numbers and a rotation.
[[nodiscard]] bool read_transform(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept;
[[nodiscard]] std::array<std::byte, kTransform> transform(const Pose<'C', 'T'>& X_CT) noexcept;

// POSITION: the position, then the unit quaternion x, y, z, w, or only x, y, z (w is then not negative).
// Returns false as above, and without a rotation.
[[nodiscard]] bool read_position(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept;

// TDATA: consecutive elements.
struct Element {
  Name<20> name;  // name of the tool
  Pose<'C', 'T'> X_CT;
};
// 0: no element, or not TDATA.
[[nodiscard]] std::size_t elements_of(std::span<const std::byte> content) noexcept;
// Returns false if the element is not a pose of six degrees of freedom (type 2).
[[nodiscard]] bool read_element(std::span<const std::byte> content, std::size_t index,
                                Element& element) noexcept;
[[nodiscard]] std::array<std::byte, kElement> element(std::string_view name,
                                                      const Pose<'C', 'T'>& X_CT) noexcept;
// STT_TDATA: requests at most one message in this interval, in the tracker's own frame.
[[nodiscard]] std::array<std::byte, 36> ask_for_tdata(std::int32_t resolution_ms) noexcept;

// The pose exact to the last bit, as metadata: "x y z qx qy qz qw", mm, in decimal. A TRANSFORM has a
// resolution of 30 nm at half a metre.
inline constexpr std::string_view kPoseKey = "pose";
[[nodiscard]] std::string pose_text(const Pose<'C', 'T'>& X_CT);
[[nodiscard]] bool read_pose(std::string_view text, Pose<'C', 'T'>& X_CT) noexcept;
// Returns false if the metadata mark the tool as out of view, or its pose as bad, as a PLUS server does.
[[nodiscard]] bool says_valid(std::span<const std::byte> metadata) noexcept;

// Reads a STATUS; returns false for other content.
[[nodiscard]] bool read_status(std::span<const std::byte> content, int& code) noexcept;
[[nodiscard]] std::array<std::byte, 31> status(std::uint16_t code) noexcept;  // 1: all is well

}  // namespace enc::igtl
