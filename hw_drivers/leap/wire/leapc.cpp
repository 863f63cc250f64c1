#include "hw_drivers/leap/wire/leapc.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace enc::leap::leapc {

Functions::Functions(const arm::Library& library) {
  library.find("LeapCreateConnection", create);
  library.find("LeapOpenConnection", open);
  library.find("LeapPollConnection", poll);
  library.find("LeapCloseConnection", close);
  library.find("LeapDestroyConnection", destroy);
  library.find("LeapGetNow", now);
  library.find("LeapSetTrackingMode", set_mode);  // since version 5
  library.find("LeapOpenDevice", open_device);
  library.find("LeapGetDeviceInfo", device_info);
  library.find("LeapCloseDevice", close_device);
}

std::string words_of(Result result) {
  static constexpr std::array<std::pair<Result, const char*>, 11> kNames{
      {{0x00000000, "Success"},
       {0xE2010000, "UnknownError"},
       {0xE2010001, "InvalidArgument"},
       {0xE2010002, "InsufficientResources"},
       {0xE2010003, "InsufficientBuffer"},
       {0xE2010004, "Timeout"},
       {0xE2010005, "NotConnected"},
       {0xE2010006, "HandshakeIncomplete"},
       {0xE2010007, "BufferSizeOverflow"},
       {0xE2010008, "ProtocolError"},
       {0xE201000A, "UnexpectedClosed"}}};
  const auto* const found =
      std::find_if(kNames.begin(), kNames.end(), [result](const auto& one) { return one.first == result; });
  if (found == kNames.end()) return fmt::format("error {:#010x}", result);
  return fmt::format("eLeapRS_{} ({:#010x})", found->second, result);
}

}  // namespace enc::leap::leapc
