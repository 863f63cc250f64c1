// The part of HTTP/1.1 that a device's page needs: one request, one answer, and the connection ends.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace enc::netft {

inline constexpr std::size_t kMostHttp = 80'000;  // bytes of an answer, head and body

[[nodiscard]] std::string http_request(const std::string& host, const std::string& path);
[[nodiscard]] std::string http_answer(int status, std::string_view type, std::string_view body);

// An answer, as far as it has come.
class HttpAnswer {
 public:
  void take(std::string_view bytes);
  void closed();  // the other side has sent everything
  [[nodiscard]] bool complete() const { return complete_ || !wrong_.empty(); }
  [[nodiscard]] const std::string& wrong() const { return wrong_; }  // empty: no fault
  [[nodiscard]] std::string_view body() const { return std::string_view(all_).substr(head_); }

 private:
  // Its end is at `from` or later, or has not come.
  void read_head(std::size_t from);

  std::string all_, wrong_;
  std::size_t head_ = 0;                    // bytes before the body; 0: the head is not complete
  std::size_t length_ = std::string::npos;  // length of the body; npos: up to the end
  bool complete_ = false;
};

// "/netftapi2.xml" for "GET /netftapi2.xml HTTP/1.1"; empty: not complete yet, or not a request.
[[nodiscard]] std::string_view requested_path(std::string_view request);

}  // namespace enc::netft
