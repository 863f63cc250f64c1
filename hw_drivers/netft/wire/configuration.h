// What a Net F/T says of itself over HTTP: netftapi2.xml.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/frames.h"

namespace enc::netft {

inline constexpr std::size_t kMostXml = 65536;  // bytes

struct Configuration {
  std::string product;               // prodname, "Net F/T"
  std::string name;                  // cfgnam, of the active configuration
  std::string serial;                // cfgcalsn, of its calibration
  double per_newton = kUnset;        // counts, made of cfgcpf and scfgfu
  double per_newton_metre = kUnset;  // counts, made of cfgcpt and scfgtu
  std::array<double, 6> ratings{kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};  // cfgmr: N, N m
  double rate = kUnset;  // comrdtrate, of records, Hz
  bool streams = true;   // comrdte: RDT is switched on
  bool turned = false;   // cfgtfx: forces are given in other axes than the transducer's
  int filter = 0;        // setuserfilter
};

// How many newtons, or newton metres, one of the units is that the command interface names by a number;
// unset: there is none of that number.
[[nodiscard]] double force_of_code(int code) noexcept;   // 1 lbf, 2 N, 3 klbf, 4 kN, 5 kg, 6 g
[[nodiscard]] double torque_of_code(int code) noexcept;  // 1 lbf-in, 2 lbf-ft, 3 N-m, 4 N-mm, 5 kg-cm, 6 kN-m

// Empty, and `configuration` is set; else what is wrong and what was expected.
[[nodiscard]] std::string read_xml(std::string_view xml, Configuration& configuration);
// As the device would write it, in N and N m.
[[nodiscard]] std::string xml_of(const Configuration& configuration);

}  // namespace enc::netft
