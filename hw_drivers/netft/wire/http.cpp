#include "hw_drivers/netft/wire/http.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

namespace enc::netft {
namespace {

constexpr std::string_view kEnd = "\r\n\r\n";

bool same_letters(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return small(x) == small(y); });
}

bool whole(std::string_view text, std::size_t& value) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty();
}

}  // namespace

std::string http_request(const std::string& host, const std::string& path) {
  return fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\nAccept: */*\r\nConnection: close\r\n\r\n", path, host);
}

std::string http_answer(int status, std::string_view type, std::string_view body) {
  return fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}", status,
      status == 200 ? "OK" : "Not Found", type, body.size(), body);
}

void HttpAnswer::take(std::string_view bytes) {
  if (complete()) return;
  if (bytes.size() > kMostHttp - all_.size()) {
    wrong_ = fmt::format("answered with more than {} bytes", kMostHttp);
    return;
  }
  // What was looked through is not looked through again, or small pieces cost the square of their sum.
  const std::size_t from = all_.size() - std::min(all_.size(), kEnd.size() - 1);
  all_.append(bytes);
  if (head_ == 0) read_head(from);
  if (head_ != 0 && length_ != std::string::npos && all_.size() - head_ >= length_) {
    all_.resize(head_ + length_);
    complete_ = wrong_.empty();
  }
}

void HttpAnswer::closed() {
  if (complete()) return;
  if (head_ == 0 || length_ != std::string::npos)
    wrong_ = fmt::format("ended its answer after {} bytes", all_.size());
  complete_ = wrong_.empty();
}

void HttpAnswer::read_head(std::size_t from) {
  const std::size_t end = all_.find(kEnd, from);
  if (end == std::string::npos) return;
  head_ = end + kEnd.size();
  std::string_view lines = std::string_view(all_).substr(0, end + 2);
  const std::string_view first = lines.substr(0, lines.find("\r\n"));
  std::size_t status = 0;
  if (!first.starts_with("HTTP/1.") || first.size() < 12 || !whole(first.substr(9, 3), status)) {
    wrong_ = "does not speak HTTP";
    return;
  }
  if (status != 200) {
    wrong_ = fmt::format("answered with HTTP status {}, expected 200", status);
    return;
  }
  for (lines.remove_prefix(first.size() + 2); !lines.empty();) {
    const std::string_view line = lines.substr(0, lines.find("\r\n"));
    lines.remove_prefix(std::min(line.size() + 2, lines.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string_view value = line.substr(colon + 1);
    if (same_letters(line.substr(0, colon), "content-length") && !whole(value, length_))
      wrong_ = "answered with a Content-Length that is no number";
    if (same_letters(line.substr(0, colon), "transfer-encoding"))
      wrong_ = "answers in pieces (Transfer-Encoding)";
  }
}

std::string_view requested_path(std::string_view request) {
  if (request.find(kEnd) == std::string_view::npos || !request.starts_with("GET ")) return {};
  request.remove_prefix(4);
  return request.substr(0, std::min(request.find(' '), request.find("\r\n")));
}

}  // namespace enc::netft
