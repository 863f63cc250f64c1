// What a Net F/T says of itself over HTTP: netftapi2.xml.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/frames.h"

namespace enc::netft {

inline constexpr std::size_t kMostXml = 65536;  // bytes

struct Configuration {
  std::string product;               // prodname, "Net F/T"
  std::string name;                  // cfgnam, of the active configuration
  double per_newton = kUnset;        // counts, made of cfgcpf and scfgfu
  double per_newton_metre = kUnset;  // counts, made of cfgcpt and scfgtu
  std::array<double, 6> ratings{kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};  // cfgmr: N, N m
  double rate = kUnset;  // comrdtrate, of records, Hz
  bool streams = true;   // comrdte: RDT is switched on
  int filter = 0;        // setuserfilter
};

// Empty, and `configuration` is set; else what is wrong and what was expected.
[[nodiscard]] std::string read_xml(std::string_view xml, Configuration& configuration);
// As the device would write it, in N and N m.
[[nodiscard]] std::string xml_of(const Configuration& configuration);

}  // namespace enc::netft
