// What messages say of tools, byte by byte: against what Debian's libOpenIGTLink wrote.
#include "hw_drivers/igtl/wire/content.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/net/big_endian.h"
#include "tests/unit/hw_drivers/hex.h"

namespace enc::igtl {
namespace {

using tests::from_hex;

// Tracker, one element: Tool, of type 2, at 1, 2, 3 mm; stamped 1.5 s.
const std::string kTdata =
    "0001544441544100000000000000547261636b657200000000000000000000000000000000017fffffff0000000000000046b4b5"
    "de"
    "107992d644546f6f6c0000000000000000000000000000000002003f8000000000000000000000000000003f8000000000000000"
    "0000"
    "00000000003f8000003f8000004000000040400000";
const std::string kStartTdata =
    "00015354545f54444154410000005444617461436c69656e740000000000000000000000000000000000000000000000002456bd"
    "d698"
    "192668360000000a547261636b657200000000000000000000000000000000000000000000000000";

std::vector<std::byte> singles(const std::vector<double>& numbers) {
  std::vector<std::byte> bytes(4 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    net::put(std::span(bytes), 4 * i, std::bit_cast<std::uint32_t>(static_cast<float>(numbers[i])));
  return bytes;
}

TEST(IgtlContent, ElementsOfTdataAreThoseOfLibOpenIGTLink) {
  const std::vector<std::byte> bytes = from_hex(kTdata);
  ASSERT_EQ(bytes.size(), 128U);
  Message message;
  ASSERT_EQ(read(bytes, message), Wrong::nothing);
  ASSERT_EQ(elements_of(message.content), 1U);
  Element element;
  ASSERT_TRUE(read_element(message.content, 0, element));
  EXPECT_EQ(element.name.view(), "Tool");
  EXPECT_LT((element.X_CT.p() - Vec3(0.001, 0.002, 0.003)).norm(), 1e-15);
  const auto ours = igtl::element("Tool", Pose<'C', 'T'>::shift(0.001, 0.002, 0.003));
  EXPECT_TRUE(std::equal(ours.begin(), ours.end(), message.content.begin(), message.content.end()));
}

TEST(IgtlContent, OnlyWholeElementsOfSixDegreesArePoses) {
  auto ours = element("Tool", Pose<'C', 'T'>::shift(0, 0, 1));
  Element read;
  EXPECT_TRUE(read_element(ours, 0, read));
  for (const int type : {1, 3, 4}) {
    ours[20] = static_cast<std::byte>(type);
    EXPECT_FALSE(read_element(ours, 0, read)) << type;
  }
  EXPECT_EQ(elements_of(std::span(ours).first(69)), 0U);
  EXPECT_EQ(elements_of({}), 0U);
}

TEST(IgtlContent, AsksForTdataAsLibOpenIGTLinkDoes) {
  std::vector<std::byte> theirs = from_hex(kStartTdata);
  const auto ours = ask_for_tdata(10);
  ASSERT_EQ(theirs.size(), kHeader + ours.size());
  std::fill(theirs.begin() + kHeader + 4, theirs.begin() + kHeader + 11,
            std::byte{0});  // "Tracker": ours names no frame
  EXPECT_TRUE(std::equal(ours.begin(), ours.end(), theirs.begin() + kHeader));
}

TEST(IgtlContent, APositionTurnsByAQuaternionWithOrWithoutItsLastNumber) {
  const double half = std::sqrt(0.5);
  Pose<'C', 'T'> X_CT;
  ASSERT_TRUE(read_position(singles({10, 20, 30, 0, 0, half, half}), X_CT));
  EXPECT_LT((X_CT.p() - Vec3(0.01, 0.02, 0.03)).norm(), 1e-9);
  EXPECT_LT((X_CT.q() * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-7) << "a quarter turn about z";
  Pose<'C', 'T'> three;
  ASSERT_TRUE(read_position(singles({10, 20, 30, 0, 0, half}), three));
  EXPECT_LT(three.q().angularDistance(X_CT.q()), 1e-6);
  EXPECT_FALSE(read_position(singles({10, 20, 30}), X_CT)) << "says nothing of the rotation";
  EXPECT_FALSE(read_position(singles({10, 20, 30, 0, 0, half, 1}), X_CT)) << "no unit quaternion";
  EXPECT_FALSE(read_position(singles({10, 20, NAN, 0, 0, half, half}), X_CT));
  EXPECT_FALSE(read_position(singles({10, 20, 30, 0, 0, NAN}), X_CT));
}

// As PLUS has it: "TransformValid" and "TransformStatus" of each pose.
TEST(IgtlContent, AServerSaysWhereATransformIsNotValid) {
  const auto says = [](const char* key, const char* value) {
    const Written written("TRANSFORM", "stylusToTracker", 1, 1, transform({Pose<'C', 'T'>::shift(0, 0, 1)}),
                          key, value);
    Message message;
    EXPECT_EQ(read(written.bytes(), message), Wrong::nothing);
    return says_valid(message.metadata);
  };
  EXPECT_TRUE(says_valid({}));
  EXPECT_TRUE(says("TransformStatus", "OK"));
  EXPECT_FALSE(says("TransformStatus", "TOOL_OUT_OF_VIEW"));
  EXPECT_TRUE(says("TransformValid", "1"));
  EXPECT_FALSE(says("TransformValid", "0"));
  EXPECT_FALSE(says("TransformValid", "false"));
}

}  // namespace
}  // namespace enc::igtl
