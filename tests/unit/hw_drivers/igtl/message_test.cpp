// OpenIGTLink byte by byte: against what Debian's libOpenIGTLink wrote.
#include "hw_drivers/igtl/wire/message.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/igtl/wire/content.h"
#include "tests/unit/hw_drivers/hex.h"

namespace enc::igtl {
namespace {

using tests::from_hex;

// ToolToTracker at 1, 2, 3 mm, stamped 1.5 s; header of version 1.
const std::string kTransformV1 =
    "00015452414e53464f524d000000546f6f6c546f547261636b657200000000000000000000017fffffff0000000000000030acf6"
    "8624880f705e3f8000000000000000000000000000003f8000000000000000000000000000003f8000003f800000400000004040"
    "0000";
const std::string kStatusV1 =
    "00015354415455530000000000004465760000000000000000000000000000000000000000017fffffff000000000000002d68f7"
    "241c44f05562000100000000000000804f4b210000000000000000000000000000000000546869732069732061207465737400";

Pose<'C', 'T'> some_pose(std::mt19937_64& random) {
  std::normal_distribution<double> any;
  const Quat q = Quat(any(random), any(random), any(random), any(random)).normalized();
  return {q, Vec3(any(random), any(random), any(random))};
}

TEST(IgtlMessage, TheChecksumIsTheStandards) {
  const std::string nine = "123456789";
  EXPECT_EQ(crc64(std::as_bytes(std::span(nine))), 0x6c40df5f0b497347ULL);
  EXPECT_EQ(crc64({}), 0ULL);
}

TEST(IgtlMessage, ReadsWhatLibOpenIGTLinkWrote) {
  const std::vector<std::byte> bytes = from_hex(kTransformV1);
  ASSERT_EQ(bytes.size(), 106U);
  Message message;
  ASSERT_EQ(read(bytes, message), Wrong::nothing);
  EXPECT_EQ(message.type.view(), "TRANSFORM");
  EXPECT_EQ(message.device.view(), "ToolToTracker");
  EXPECT_EQ(message.stamp_ns, 1'500'000'000);  // 0x7fffffff of 2^32 is half a second to a quarter of a ns
  EXPECT_FALSE(message.numbered);
  Pose<'C', 'T'> X_CT;
  ASSERT_TRUE(read_transform(message.content, X_CT));
  EXPECT_LT((X_CT.p() - Vec3(0.001, 0.002, 0.003)).norm(), 1e-15);
  EXPECT_LT(X_CT.q().angularDistance(Quat::Identity()), 1e-15);
  ASSERT_EQ(read(from_hex(kStatusV1), message), Wrong::nothing);
  EXPECT_EQ(message.type.view(), "STATUS");
  EXPECT_FALSE(read_transform(message.content, X_CT));
}

// Columns of the matrix, one after another, then the place in mm, as OpenIGTLink's protocol has them
// (TRANSFORM: R11 R21 R31 R12 R22 R32 R13 R23 R33 TX TY TZ).
TEST(IgtlMessage, AMatrixIsWrittenColumnByColumn) {
  const std::vector<std::byte> body = from_hex(
      "000000003f80000000000000"
      "bf8000000000000000000000"
      "00000000000000003f800000"
      "4120000041a0000041f00000");
  Pose<'C', 'T'> X_CT;
  ASSERT_TRUE(read_transform(body, X_CT));
  EXPECT_LT((X_CT.q() * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-7) << "a quarter turn about z";
  EXPECT_LT((X_CT.q() * Vec3(0, 0, 1) - Vec3(0, 0, 1)).norm(), 1e-7);
  EXPECT_LT((X_CT.p() - Vec3(0.010, 0.020, 0.030)).norm(), 1e-9);
  const auto written =
      transform(Pose<'C', 'T'>(Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5)), Vec3(0.01, 0.02, 0.03)));
  Pose<'C', 'T'> again;
  ASSERT_TRUE(read_transform(written, again));
  EXPECT_EQ(std::to_integer<int>(written[4]), 0x3f) << "R21 = 1 comes second";
  EXPECT_EQ(std::to_integer<int>(written[12]), 0xbf) << "R12 = -1 comes fourth";
}

// The body that is written is the one that libOpenIGTLink writes, behind an extended header.
TEST(IgtlMessage, WritesTheSameContent) {
  const std::vector<std::byte> theirs = from_hex(kTransformV1);
  const auto content = transform(Pose<'C', 'T'>::shift(0.001, 0.002, 0.003));
  EXPECT_TRUE(std::equal(content.begin(), content.end(), theirs.begin() + kHeader));
  const Written ours("TRANSFORM", "ToolToTracker", 1'500'000'000, 0x01020304, content);
  ASSERT_EQ(ours.bytes().size(), kHeader + kExtendedHeader + kTransform + 2);
  const std::vector<std::byte> extended = from_hex("000c00020000000001020304");
  EXPECT_TRUE(std::equal(extended.begin(), extended.end(), ours.bytes().begin() + kHeader));
  EXPECT_TRUE(std::equal(theirs.begin() + 2, theirs.begin() + 38, ours.bytes().begin() + 2));
}

// Whole: header and body are those that libOpenIGTLink writes, but for its rounding of half a second.
TEST(IgtlMessage, WritesVersionOneToTheByte) {
  std::vector<std::byte> theirs = from_hex(kTransformV1);
  const Written ours("TRANSFORM", "ToolToTracker", 1'500'000'000,
                     transform(Pose<'C', 'T'>::shift(0.001, 0.002, 0.003)));
  const std::vector<std::byte> half = from_hex("80000000");
  std::copy(half.begin(), half.end(), theirs.begin() + 38);
  ASSERT_EQ(ours.bytes().size(), theirs.size());
  EXPECT_TRUE(std::equal(theirs.begin(), theirs.end(), ours.bytes().begin()));
}

TEST(IgtlMessage, WhatIsWrittenIsReadAgain) {
  std::mt19937_64 random(20261126);
  for (int i = 0; i < 1000; ++i) {
    const Pose<'C', 'T'> X_CT = some_pose(random);
    const auto stamp = static_cast<std::int64_t>(random() % 4'000'000'000'000'000'000ULL);
    const auto number = static_cast<std::uint32_t>(random());
    Message message;
    const Written written("TRANSFORM", "stylusToTracker", stamp, number, transform(X_CT));
    ASSERT_EQ(read(written.bytes(), message), Wrong::nothing);
    EXPECT_EQ(message.stamp_ns, stamp) << "of " << i;
    EXPECT_TRUE(message.numbered);
    EXPECT_EQ(message.number, number);
    Pose<'C', 'T'> back;
    ASSERT_TRUE(read_transform(message.content, back));
    EXPECT_LT((back.p() - X_CT.p()).norm(), 1e-7 * (1 + X_CT.p().norm()));
    EXPECT_LT(back.q().angularDistance(X_CT.q()), 1e-6);
  }
}

TEST(IgtlMessage, OneBitThatIsWrongIsSeen) {
  const Written written("TRANSFORM", "stylusToTracker", 17, 4, transform({}));
  const Written good("TRANSFORM", "stylusToTracker", 17, 4, transform(Pose<'C', 'T'>::shift(0, 0, 1)));
  const std::vector<std::byte> bytes(good.bytes().begin(), good.bytes().end());
  Message message;
  ASSERT_EQ(read(bytes, message), Wrong::nothing);
  for (std::size_t bit = 8 * kHeader; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::byte> spoilt = bytes;
    spoilt[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_EQ(read(spoilt, message), Wrong::checksum) << bit;
  }
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_EQ(read(std::span(bytes).first(length), message), length < kHeader ? Wrong::cut : Wrong::size);
  std::vector<std::byte> later = bytes;
  later[1] = std::byte{3};
  EXPECT_EQ(read(later, message), Wrong::version);
}

TEST(IgtlMessage, WhatIsNoRotationIsNoPose) {
  Pose<'C', 'T'> X_CT;
  auto content = transform(Pose<'C', 'T'>::shift(0, 0, 1));
  EXPECT_TRUE(read_transform(content, X_CT));
  content[0] = std::byte{0x40};  // the first number is 2
  EXPECT_FALSE(read_transform(content, X_CT));
  content[0] = std::byte{0xbf};  // a mirror
  EXPECT_FALSE(read_transform(content, X_CT));
  content[0] = std::byte{0x7f};
  content[1] = std::byte{0xc0};  // none
  EXPECT_FALSE(read_transform(content, X_CT));
}

// A number behind the largest 32 bits of seconds is not a time that anybody means; nothing overflows.
TEST(IgtlMessage, MetadataIsLeftAlone) {
  const Written plain("TRANSFORM", "stylusToTracker", 17, 4, transform(Pose<'C', 'T'>::shift(0, 0, 1)));
  std::vector<std::byte> bytes(plain.bytes().begin(), plain.bytes().end());
  const std::string metadata = "a metadata body";
  for (const char c : metadata) bytes.push_back(static_cast<std::byte>(c));
  bytes[kHeader + 7] = static_cast<std::byte>(metadata.size());
  bytes[49] = static_cast<std::byte>(bytes.size() - kHeader);
  const std::uint64_t crc = crc64(std::span(bytes).subspan(kHeader));
  for (std::size_t i = 0; i < 8; ++i) bytes[50 + i] = static_cast<std::byte>(crc >> (56 - 8 * i));
  Message message;
  ASSERT_EQ(read(bytes, message), Wrong::nothing);
  EXPECT_EQ(message.content.size(), kTransform);
}

}  // namespace
}  // namespace enc::igtl
