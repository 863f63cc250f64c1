// The configuration that a Net F/T reports over HTTP: netftapi2.xml.
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
  std::string name;                  // cfgnam, active configuration
  std::string serial;                // cfgcalsn, its calibration
  double per_newton = kUnset;        // counts, from cfgcpf and scfgfu
  double per_newton_metre = kUnset;  // counts, from cfgcpt and scfgtu
  std::array<double, 6> ratings{kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};  // cfgmr: N, N m
  double rate = kUnset;                                                           // comrdtrate, Hz, records
  bool streams = true;  // comrdte: RDT is switched on
  bool turned = false;  // cfgtfx: the forces are in other axes than the transducer's
  int filter = 0;       // setuserfilter
};

// Newtons, or newton metres, of a unit in the numbering of the command interface; unset: no unit has that
// number.
[[nodiscard]] double force_of_code(int code) noexcept;   // 1 lbf, 2 N, 3 klbf, 4 kN, 5 kg, 6 g
[[nodiscard]] double torque_of_code(int code) noexcept;  // 1 lbf-in, 2 lbf-ft, 3 N-m, 4 N-mm, 5 kg-cm, 6 kN-m

// Sets `configuration` and returns an empty text, or returns the problem and the expected content.
[[nodiscard]] std::string read_xml(std::string_view xml, Configuration& configuration);
// The XML as the device would write it, in N and N m.
[[nodiscard]] std::string xml_of(const Configuration& configuration);

}  // namespace enc::netft
