// OpenIGTLink byte by byte, compared with the output of Debian's libOpenIGTLink.
#include "hw_drivers/igtl/wire/message.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/igtl/drive/held_tool.h"
#include "hw_drivers/igtl/wire/content.h"
#include "hw_drivers/net/big_endian.h"
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
  ASSERT_EQ(read(bytes, message), MessageFault::nothing);
  EXPECT_EQ(message.type.view(), "TRANSFORM");
  EXPECT_EQ(message.device.view(), "ToolToTracker");
  EXPECT_EQ(message.stamp_ns, 1'500'000'000);  // 0x7fffffff of 2^32 is half a second to a quarter of a ns
  EXPECT_FALSE(message.numbered);
  Pose<'C', 'T'> X_CT;
  ASSERT_TRUE(read_transform(message.content, X_CT));
  EXPECT_LT((X_CT.p() - Vec3(0.001, 0.002, 0.003)).norm(), 1e-15);
  EXPECT_LT(X_CT.q().angularDistance(Quat::Identity()), 1e-15);
  ASSERT_EQ(read(from_hex(kStatusV1), message), MessageFault::nothing);
  EXPECT_EQ(message.type.view(), "STATUS");
  EXPECT_FALSE(read_transform(message.content, X_CT));
}

// Columns of the matrix, one after another, then the place in mm, as in OpenIGTLink's protocol (TRANSFORM:
// R11 R21 R31 R12 R22 R32 R13 R23 R33 TX TY TZ).
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

// The written body equals that of libOpenIGTLink, behind an extended header.
TEST(IgtlMessage, WritesTheSameContent) {
  const std::vector<std::byte> theirs = from_hex(kTransformV1);
  const auto content = transform(Pose<'C', 'T'>::shift(0.001, 0.002, 0.003));
  EXPECT_TRUE(std::equal(content.begin(), content.end(), theirs.begin() + kHeader));
  const OutgoingMessage ours("TRANSFORM", "ToolToTracker", 1'500'000'000, 0x01020304, content);
  ASSERT_EQ(ours.bytes().size(), kHeader + kExtendedHeader + kTransform + 2);
  const std::vector<std::byte> extended = from_hex("000c00020000000001020304");
  EXPECT_TRUE(std::equal(extended.begin(), extended.end(), ours.bytes().begin() + kHeader));
  EXPECT_TRUE(std::equal(theirs.begin() + 2, theirs.begin() + 38, ours.bytes().begin() + 2));
}

// Header and body equal those of libOpenIGTLink, except for its rounding of half a second.
TEST(IgtlMessage, WritesVersionOneToTheByte) {
  std::vector<std::byte> theirs = from_hex(kTransformV1);
  const OutgoingMessage ours("TRANSFORM", "ToolToTracker", 1'500'000'000,
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
    const OutgoingMessage written("TRANSFORM", "stylusToTracker", stamp, number, transform(X_CT));
    ASSERT_EQ(read(written.bytes(), message), MessageFault::nothing);
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
  const OutgoingMessage written("TRANSFORM", "stylusToTracker", 17, 4, transform({}));
  const OutgoingMessage good("TRANSFORM", "stylusToTracker", 17, 4,
                             transform(Pose<'C', 'T'>::shift(0, 0, 1)));
  const std::vector<std::byte> bytes(good.bytes().begin(), good.bytes().end());
  Message message;
  ASSERT_EQ(read(bytes, message), MessageFault::nothing);
  for (std::size_t bit = 8 * kHeader; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::byte> spoilt = bytes;
    spoilt[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_EQ(read(spoilt, message), MessageFault::checksum) << bit;
  }
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_EQ(read(std::span(bytes).first(length), message),
              length < kHeader ? MessageFault::cut : MessageFault::size);
  std::vector<std::byte> later = bytes;
  later[1] = std::byte{3};
  EXPECT_EQ(read(later, message), MessageFault::version);
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

// A number beyond the largest 32 bits of seconds is no plausible time; nothing overflows.
TEST(IgtlMessage, MetadataIsLeftAlone) {
  const OutgoingMessage plain("TRANSFORM", "stylusToTracker", 17, 4,
                              transform(Pose<'C', 'T'>::shift(0, 0, 1)));
  std::vector<std::byte> bytes(plain.bytes().begin(), plain.bytes().end());
  const std::string metadata = "a metadata body";
  for (const char c : metadata) bytes.push_back(static_cast<std::byte>(c));
  bytes[kHeader + 7] = static_cast<std::byte>(metadata.size());
  bytes[49] = static_cast<std::byte>(bytes.size() - kHeader);
  const std::uint64_t crc = crc64(std::span(bytes).subspan(kHeader));
  for (std::size_t i = 0; i < 8; ++i) bytes[50 + i] = static_cast<std::byte>(crc >> (56 - 8 * i));
  Message message;
  ASSERT_EQ(read(bytes, message), MessageFault::nothing);
  EXPECT_EQ(message.content.size(), kTransform);
}

// Messages about tools, byte by byte, compared with the output of Debian's libOpenIGTLink.

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
  ASSERT_EQ(read(bytes, message), MessageFault::nothing);
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

// PLUS sends "TransformValid" and "TransformStatus" of each pose.
TEST(IgtlContent, AServerSaysWhereATransformIsNotValid) {
  const auto says = [](const char* key, const char* value) {
    const OutgoingMessage written("TRANSFORM", "stylusToTracker", 1, 1,
                                  transform({Pose<'C', 'T'>::shift(0, 0, 1)}), key, value);
    Message message;
    EXPECT_EQ(read(written.bytes(), message), MessageFault::nothing);
    return says_valid(message.metadata);
  };
  EXPECT_TRUE(says_valid({}));
  EXPECT_TRUE(says("TransformStatus", "OK"));
  EXPECT_FALSE(says("TransformStatus", "TOOL_OUT_OF_VIEW"));
  EXPECT_TRUE(says("TransformValid", "1"));
  EXPECT_FALSE(says("TransformValid", "0"));
  EXPECT_FALSE(says("TransformValid", "false"));
}

// Messages of a stream that arrives in any pieces.

using Bytes = std::vector<std::byte>;

Bytes bytes_of(const OutgoingMessage& message) { return {message.bytes().begin(), message.bytes().end()}; }
Bytes pose(std::int64_t stamp_ns) {
  return bytes_of({"TRANSFORM", "stylusToTracker", stamp_ns, transform(Pose<'C', 'T'>::shift(0, 0, 1))});
}
// A message with a body of this length, of zeros.
Bytes picture(std::uint64_t body) {
  Bytes bytes = bytes_of({"IMAGE", "ultrasound", 7, {}});
  net::put(std::span(bytes), 42, body);
  bytes.resize(kHeader + static_cast<std::size_t>(body));
  return bytes;
}
Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The stamps of the messages, if `bytes` come in pieces of at most this many.
std::vector<std::int64_t> stamps(Stream& stream, std::span<const std::byte> bytes, std::size_t most,
                                 std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::int64_t> all;
  while (!bytes.empty() && !stream.lost()) {
    const std::span<std::byte> room = stream.room();
    EXPECT_FALSE(room.empty());
    const std::size_t piece =
        std::min({bytes.size(), room.size(), 1 + static_cast<std::size_t>(random() % most)});
    std::copy_n(bytes.begin(), piece, room.begin());
    stream.came(piece);
    bytes = bytes.subspan(piece);
    for (auto next = stream.next(); !next.empty(); next = stream.next()) {
      Message message;
      EXPECT_EQ(read(next, message), MessageFault::nothing);
      all.push_back(message.stamp_ns);
    }
  }
  return all;
}

TEST(IgtlStream, GivesEachMessageOnceInWhateverPiecesItComes) {
  Bytes bytes;
  std::vector<std::int64_t> expected;
  for (std::int64_t i = 1; i <= 2000; ++i) {
    bytes = std::move(bytes) + pose(i);
    expected.push_back(i);
  }
  ASSERT_GT(bytes.size(), 3 * Stream::kMost) << "it goes round";
  for (const std::size_t most : {1U, 7U, 106U, 5000U, 200000U}) {
    Stream stream;
    EXPECT_EQ(stamps(stream, bytes, most, most), expected) << most;
    EXPECT_FALSE(stream.lost());
  }
}

TEST(IgtlStream, PassesOverWhatIsTooLong) {
  Stream stream;
  const Bytes bytes =
      pose(1) + picture(3 * Stream::kMost) + pose(2) + picture(Stream::kMost - kHeader + 1) + pose(3);
  EXPECT_EQ(stamps(stream, bytes, 3000, 1), (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(stream.skipped(), 2);
  Stream longest;
  Bytes fits = picture(Stream::kMost - kHeader);
  net::put(std::span(fits), 50, crc64(std::span(fits).subspan(kHeader)));
  EXPECT_EQ(stamps(longest, pose(1) + fits + pose(2), 40000, 2), (std::vector<std::int64_t>{1, 7, 2}));
}

TEST(IgtlStream, WhatIsNoHeaderEndsIt) {
  for (const auto& [at, byte] : {std::pair{0, 0x30}, {2, 0x00}, {4, 0x0a}, {5, 0x80}}) {
    Bytes wrong = pose(2);
    wrong[static_cast<std::size_t>(at)] = static_cast<std::byte>(byte);
    Stream stream;
    EXPECT_EQ(stamps(stream, pose(1) + wrong + pose(3), 500, 3), (std::vector<std::int64_t>{1})) << at;
    EXPECT_TRUE(stream.lost()) << at;
    stream.begin();
    EXPECT_EQ(stamps(stream, pose(4), 50, 4), (std::vector<std::int64_t>{4})) << "another one";
  }
}

// Several tools in view: the one in the person's hand counts, and no other.

struct Frames {
  explicit Frames(double rate = 100.0) : frame(std::llround(1e9 / rate)) {}
  // A frame: the places of the tools, and the one in the hand, -1: none. In the frame of a change both are,
  // and the later one stays.
  int see(const std::vector<std::pair<std::size_t, Vec3>>& tools) {
    ++count;
    int which = -1;
    for (const auto& [tool, place] : tools)
      if (hand.is(tool, count * frame, place)) which = static_cast<int>(tool);
    return which;
  }
  HeldToolFinder hand{2};
  std::int64_t frame, count = 0;  // ns
};
Vec3 moving(int frame) { return {0.1 * std::sin(0.05 * frame), 0, 1}; }
const Vec3 kTable(0.3, 0.2, 1.2);

TEST(IgtlInHand, OfOneInViewItIsThatOneFromItsFirstFrame) {
  Frames frames;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frames.see({{0, moving(i)}}), 0);
  frames.count += 50;  // none in view for half a second
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frames.see({{1, moving(i)}}), 1) << i;
}

// The order of the two in a message, the frame rate and a hidden hand make no difference.
TEST(IgtlInHand, WhatLiesOnTheTableDoesNotTakeItsPlace) {
  for (const double rate : {20.0, 30.0, 60.0, 100.0, 335.0})
    for (const bool table_first : {false, true}) {
      Frames frames(rate);
      for (int i = 0; i < 10; ++i) EXPECT_EQ(frames.see({{0, moving(0)}, {1, kTable}}), 0);
      for (int i = 1; i < 500; ++i) {
        const std::pair hand(std::size_t{0}, moving(i)), table(std::size_t{1}, kTable);
        if (i % 100 < static_cast<int>(0.15 * rate))
          EXPECT_EQ(frames.see({table}), -1) << "hidden for 150 ms at " << rate << " Hz, frame " << i;
        else
          EXPECT_EQ(table_first ? frames.see({table, hand}) : frames.see({hand, table}), 0)
              << rate << ' ' << i;
      }
    }
}

TEST(IgtlInHand, WhatIsPickedUpTakesThePlaceOfWhatWasLaidDown) {
  Frames frames;
  for (int i = 0; i < 100; ++i) frames.see({{0, moving(i)}, {1, kTable}});
  const Vec3 down = moving(100);
  for (int i = 0; i < 300; ++i)
    EXPECT_EQ(frames.see({{0, down}, {1, kTable}}), 0) << "nobody moves any: " << i;
  int first = -1;
  for (int i = 0; i < 100; ++i)
    if (frames.see({{0, down}, {1, Vec3(kTable + Vec3(0, 0, 0.99e-3 * i))}}) == 1 && first < 0) first = i;
  EXPECT_EQ(first, 51) << "its first 50 mm";
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frames.see({{0, down}, {1, kTable}}), 1);
}

// A hand presses with one tool and holds still; somebody knocks at the table on which the second tool lies.
TEST(IgtlInHand, WhatIsPushedOnTheTableIsNotPickedUp) {
  Frames frames;
  for (int i = 0; i < 100; ++i) frames.see({{0, moving(i)}, {1, kTable}});
  const Vec3 pressing = moving(100);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 pushed = kTable + Vec3(0.02 * std::sin(0.01 * i), 0, 0);
    EXPECT_EQ(frames.see({{0, pressing}, {1, pushed}}), 0) << i;
  }
}

TEST(IgtlInHand, OfTwoThatMoveTheFirstStays) {
  Frames frames;
  for (int i = 0; i < 500; ++i) EXPECT_EQ(frames.see({{0, moving(i)}, {1, Vec3(kTable + moving(i))}}), 0);
}

TEST(IgtlInHand, WhatLiesThereIsNotTakenWhenTheOtherIsGone) {
  Frames frames;
  for (int i = 0; i < 50; ++i) frames.see({{0, moving(i)}, {1, kTable}});
  for (int i = 0; i < 300; ++i) EXPECT_EQ(frames.see({{1, kTable}}), -1) << "nobody moves it: " << i;
  EXPECT_EQ(frames.see({{0, moving(50)}, {1, kTable}}), 0) << "there it is again";
  for (int i = 0; i < 11; ++i) frames.see({{1, kTable}});
  EXPECT_EQ(frames.see({{1, Vec3(kTable + Vec3(0, 0, 6e-3))}}), 1) << "that one is moved";
}

TEST(IgtlInHand, AnotherClockBeginsAnew) {
  Frames frames;
  for (int i = 0; i < 50; ++i) frames.see({{0, moving(i)}});
  frames.count = -1'000'000;
  frames.hand.forget();
  for (int i = 0; i < 20; ++i) frames.see({{1, Vec3(kTable + Vec3(0, 0, 1e-3 * i))}});
  EXPECT_EQ(frames.see({{1, kTable}}), 1);
  frames.hand.forget();
  EXPECT_EQ(frames.see({{0, moving(0)}, {1, kTable}}), 1) << "the one in the hand stays it";
}

}  // namespace
}  // namespace enc::igtl
