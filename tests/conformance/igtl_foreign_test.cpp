// A tracker's server and its driver against foreign counterparts: pyigtl, in a program of its own, and
// Debian's libOpenIGTLink.
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlPositionMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>

#include "tests/conformance/igtl_bench.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

namespace library = ::igtl;
using testing::HasSubstr;

const std::string kPyigtl = tests::source_dir() + "/.deps/pyigtl";
std::vector<std::string> script(const std::string& name) {
  return {"/usr/bin/python3", "-B", tests::source_dir() + "/tests/conformance/foreign/" + name, kPyigtl};
}

// As in the scripts: a quarter turn about z, then 10, 20, 30 mm. All of its numbers differ, so that their
// order counts.
const Pose<'C', 'T'> kTurned(Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5)), Vec3(0.01, 0.02, 0.03));
void expect_turned(const Pose<'C', 'T'>& X_CT) {
  EXPECT_LT((X_CT.p() - kTurned.p()).norm(), 1e-8);
  EXPECT_LT(X_CT.q().angularDistance(kTurned.q()), 1e-6);
}

struct TurnedTool final : PoseTracker {
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    if (now - last < Duration(10'000'000)) return false;
    last = now;
    newest = {{0, kTurned}, now, Health::ok};
    return true;
  }
  Time last{};
};

struct TurnedPort {
  TurnedTool tracker;
  igtl::ToolServer server{tracker, {"stylusToTracker"}, {.transport = igtl::Transport::tcp}};
  FakeServer served{server};
};

TEST(IgtlForeign, PyigtlReadsOurServer) {
  if (!std::filesystem::exists(kPyigtl)) GTEST_SKIP() << "no " << kPyigtl << ": ./check fetches it";
  const TurnedPort there;
  std::vector<std::string> words = script("pyigtl_client.py");
  words.push_back(std::to_string(there.server.port()));
  tests::PipedChild child(words);
  EXPECT_EQ(child.end(), 0);
}

TEST(IgtlForeign, OurDriverReadsPyigtlsServer) {
  if (!std::filesystem::exists(kPyigtl)) GTEST_SKIP() << "no " << kPyigtl << ": ./check fetches it";
  for (const char* version : {"1", "2"}) {
    std::vector<std::string> words = script("pyigtl_server.py");
    words.emplace_back(version);
    tests::PipedChild child(words);
    std::string line;
    std::array<char, 64> bytes{};
    while (!line.ends_with('\n')) {
      const std::size_t got = child.read(bytes, 30'000);
      ASSERT_GT(got, 0U) << "it says no port";
      line.append(bytes.data(), got);
    }
    IgtlBench bench;
    bench.table.transport = "tcp";
    bench.table.port = std::stoi(line);
    const auto driver = igtl::subscribed(bench.offer());
    EXPECT_GT(bench.watch(*driver, 400).news, 10) << version;
    expect_turned(bench.newest.value.X_CT);
    EXPECT_TRUE(driver->linked());
    EXPECT_THAT(driver->remarks().at(0), HasSubstr("0 old or twice, 0 wrong"));
    EXPECT_EQ(child.end(), 0);
  }
}

void expect_turned(const library::Matrix4x4& matrix) {
  const float expected[3][4] = {{0, -1, 0, 10}, {1, 0, 0, 20}, {0, 0, 1, 30}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_NEAR(matrix[row][column], expected[row][column], 1e-5) << row << ' ' << column;
}

// Their next message of that type, unpacked with its checksum verified; other types are skipped.
template <class Message>
typename Message::Pointer next_of(library::ClientSocket& socket, const char* type) {
  constexpr int kMostMessages = 500;
  for (int i = 0; i < kMostMessages; ++i) {
    const auto header = library::MessageHeader::New();
    header->InitPack();
    if (socket.Receive(header->GetPackPointer(), static_cast<int>(header->GetPackSize())) !=
        static_cast<int>(header->GetPackSize()))
      break;
    header->Unpack();
    const auto message = Message::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    socket.Receive(message->GetPackBodyPointer(), static_cast<int>(message->GetPackBodySize()));
    if (std::string(header->GetDeviceType()) != type) continue;
    EXPECT_NE(message->Unpack(1) & library::MessageHeader::UNPACK_BODY, 0) << type << ": its sum is wrong";
    return message;
  }
  ADD_FAILURE() << "no " << type;
  return Message::New();
}

TEST(IgtlForeign, LibOpenIGTLinkReadsOurServer) {
  const TurnedPort there;
  const auto socket = library::ClientSocket::New();
  ASSERT_EQ(socket->ConnectToServer("127.0.0.1", there.server.port()), 0);
  socket->SetReceiveTimeout(5000);
  library::Matrix4x4 matrix;
  const auto transform = next_of<library::TransformMessage>(*socket, "TRANSFORM");
  EXPECT_STREQ(transform->GetDeviceName(), "stylusToTracker");
  transform->GetMatrix(matrix);
  expect_turned(matrix);

  const auto start = library::StartTrackingDataMessage::New();
  start->SetDeviceName("judge");
  start->SetResolution(1);
  start->SetCoordinateName("Tracker");
  start->Pack();
  socket->Send(start->GetPackPointer(), static_cast<int>(start->GetPackSize()));
  EXPECT_EQ(next_of<library::RTSTrackingDataMessage>(*socket, "RTS_TDATA")->GetStatus(), 0);
  const auto data = next_of<library::TrackingDataMessage>(*socket, "TDATA");
  ASSERT_EQ(data->GetNumberOfTrackingDataElements(), 1);
  library::TrackingDataElement::Pointer element;
  data->GetTrackingDataElement(0, element);
  EXPECT_STREQ(element->GetName(), "stylusToTracker");
  EXPECT_EQ(element->GetType(), library::TrackingDataElement::TYPE_6D);
  element->GetMatrix(matrix);
  expect_turned(matrix);

  const auto stop = library::StopTrackingDataMessage::New();
  stop->Pack();
  socket->Send(stop->GetPackPointer(), static_cast<int>(stop->GetPackSize()));
  next_of<library::RTSTrackingDataMessage>(*socket, "RTS_TDATA");
  next_of<library::TransformMessage>(*socket, "TRANSFORM");

  const auto ask = library::GetStatusMessage::New();
  ask->Pack();
  socket->Send(ask->GetPackPointer(), static_cast<int>(ask->GetPackSize()));
  EXPECT_EQ(next_of<library::StatusMessage>(*socket, "STATUS")->GetCode(), library::StatusMessage::STATUS_OK);
  socket->CloseSocket();
}

template <class Message>
void send(library::Socket& socket, const Message& message, double stamp) {
  auto time = library::TimeStamp::New();
  time->SetTime(stamp);
  message->SetTimeStamp(time);
  message->Pack();
  socket.Send(message->GetPackPointer(), static_cast<int>(message->GetPackSize()));
}

// Each form of a pose, as the library packs it.
TEST(IgtlForeign, OurDriverReadsLibOpenIGTLinksServer) {
  const auto listener = library::ServerSocket::New();
  const int port = net::listen_tcp("127.0.0.1", 0).port();  // free a moment ago
  ASSERT_EQ(listener->CreateServer(port), 0);
  IgtlBench bench;
  bench.table.transport = "tcp";
  bench.table.port = port;
  library::ClientSocket::Pointer client;
  std::thread accepting([&] {
    client = listener->WaitForConnection(5000);
    const auto status = library::StatusMessage::New();
    status->SetDeviceName("Server");
    status->SetCode(library::StatusMessage::STATUS_OK);
    if (client.IsNotNull()) send(*client, status, 1.0);
  });
  const auto driver = igtl::subscribed(bench.offer());
  accepting.join();
  ASSERT_TRUE(client.IsNotNull());
  Time now{Duration(1'000'000'000)};
  bench.settle(*driver, now);
  const auto taken = [&](const char* what) {
    now += Duration(10'000'000);
    bench.newest = {};
    EXPECT_TRUE(driver->poll(now, bench.newest)) << what;
    expect_turned(bench.newest.value.X_CT);
  };
  library::Matrix4x4 matrix = {{0, -1, 0, 10}, {1, 0, 0, 20}, {0, 0, 1, 30}, {0, 0, 0, 1}};

  const auto transform = library::TransformMessage::New();
  transform->SetDeviceName("stylusToTracker");
  transform->SetMatrix(matrix);
  send(*client, transform, 1.01);
  taken("TRANSFORM");

  const auto position = library::PositionMessage::New();
  position->SetDeviceName("stylusToTracker");
  position->SetPosition(10, 20, 30);
  const auto half = static_cast<float>(std::sqrt(0.5));
  for (const int form : {library::PositionMessage::WITH_QUATERNION3, library::PositionMessage::ALL}) {
    position->SetPackType(form);
    position->SetQuaternion(0, 0, half, half);
    send(*client, position, 1.02 + 0.01 * form);
    taken("POSITION");
  }

  const auto data = library::TrackingDataMessage::New();
  data->SetDeviceName("Tracker");
  for (const char* name : {"hammerToTracker", "stylusToTracker"}) {
    auto element = library::TrackingDataElement::New();
    element->SetName(name);
    element->SetType(library::TrackingDataElement::TYPE_6D);
    element->SetMatrix(matrix);
    data->AddTrackingDataElement(element);
  }
  send(*client, data, 1.2);
  taken("TDATA");
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("4 poses"));
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("0 wrong"));
  client->CloseSocket();
}

}  // namespace
}  // namespace enc::test
