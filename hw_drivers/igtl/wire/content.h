// What messages of OpenIGTLink say of a tracked tool: its pose in one message (TRANSFORM, POSITION), those of
// several in one (TDATA), and how the server fares (STATUS). Lengths in mm, single precision.
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

// TRANSFORM: the columns of the rotation, then the place. False where it is not of that size, holds what is
// no number, or turns by what is no rotation.
[[nodiscard]] bool read_transform(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept;
[[nodiscard]] std::array<std::byte, kTransform> transform(const Pose<'C', 'T'>& X_CT) noexcept;

// POSITION: the place, then the unit quaternion x, y, z, w, or x, y, z alone (w is not negative then). False
// as above, and where it says nothing of the rotation.
[[nodiscard]] bool read_position(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept;

// TDATA: one element after the other.
struct Element {
  Name<20> name;  // of the tool
  Pose<'C', 'T'> X_CT;
};
[[nodiscard]] std::size_t elements_of(std::span<const std::byte> content) noexcept;  // 0: none, or no TDATA
// False where it has no pose of six degrees of freedom (type 2).
[[nodiscard]] bool read_element(std::span<const std::byte> content, std::size_t index,
                                Element& element) noexcept;
[[nodiscard]] std::array<std::byte, kElement> element(std::string_view name,
                                                      const Pose<'C', 'T'>& X_CT) noexcept;
// STT_TDATA: no oftener than this, in the tracker's own frame.
[[nodiscard]] std::array<std::byte, 36> ask_for_tdata(std::int32_t resolution_ms) noexcept;

// The same pose to the last bit, as metadata: "x y z qx qy qz qw", mm, in decimal. A TRANSFORM is 30 nm
// coarse at half a metre.
inline constexpr std::string_view kPoseKey = "pose";
[[nodiscard]] std::string pose_text(const Pose<'C', 'T'>& X_CT);
[[nodiscard]] bool read_pose(std::string_view text, Pose<'C', 'T'>& X_CT) noexcept;
// False where the metadata say that the tool is out of view, or its pose no good, as a PLUS server says it.
[[nodiscard]] bool says_valid(std::span<const std::byte> metadata) noexcept;

// STATUS.
[[nodiscard]] bool read_status(std::span<const std::byte> content, int& code) noexcept;  // false: it is none
[[nodiscard]] std::array<std::byte, 31> status(std::uint16_t code) noexcept;             // 1: all is well

}  // namespace enc::igtl
