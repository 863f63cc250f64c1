// The page of a Net F/T: its configuration, in XML over HTTP.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/frames.h"

namespace enc::netft {

// The part of HTTP/1.1 that a device's page needs: one request, one answer, and the connection ends.

inline constexpr std::size_t kMostHttp = 80'000;  // bytes of an answer, head and body

[[nodiscard]] std::string http_request(const std::string& host, const std::string& path);
[[nodiscard]] std::string http_answer(int status, std::string_view type, std::string_view body);

// An answer, as far as it has come.
class HttpAnswer {
 public:
  void take(std::string_view bytes);
  void closed();  // call this when the other side has sent everything
  [[nodiscard]] bool complete() const { return complete_ || !wrong_.empty(); }
  [[nodiscard]] const std::string& wrong() const { return wrong_; }  // empty: no fault
  [[nodiscard]] std::string_view body() const { return std::string_view(all_).substr(head_); }

 private:
  // The end of the head lies at `from` or later, or has not come yet.
  void read_head(std::size_t from);

  std::string all_, wrong_;
  std::size_t head_ = 0;                    // bytes before the body; 0: the head is not complete
  std::size_t length_ = std::string::npos;  // length of the body; npos: up to the end
  bool complete_ = false;
};

// Returns "/netftapi2.xml" for "GET /netftapi2.xml HTTP/1.1"; empty: not complete yet, or not a request.
[[nodiscard]] std::string_view requested_path(std::string_view request);

// The configuration that a Net F/T reports over HTTP: netftapi2.xml.

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

// Newtons, or newton metres, of a unit in the numbering of the command interface; unset: the number has no
// unit.
[[nodiscard]] double force_of_code(int code) noexcept;   // 1 lbf, 2 N, 3 klbf, 4 kN, 5 kg, 6 g
[[nodiscard]] double torque_of_code(int code) noexcept;  // 1 lbf-in, 2 lbf-ft, 3 N-m, 4 N-mm, 5 kg-cm, 6 kN-m

// Sets `configuration` and returns an empty text, or returns the problem and the expected content.
[[nodiscard]] std::string read_xml(std::string_view xml, Configuration& configuration);
// The XML as the device would write it, in N and N m.
[[nodiscard]] std::string xml_of(const Configuration& configuration);

}  // namespace enc::netft
