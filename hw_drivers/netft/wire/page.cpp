#include "hw_drivers/netft/wire/page.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace enc::netft {

// ---- HTTP

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
  // Search only the new bytes for the end of the head. Repeated searches would cost the square of the length.
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

// ---- the configuration

namespace {

constexpr double kPound = 4.4482216152605, kKilogram = 9.80665, kInch = 0.0254,
                 kFoot = 0.3048;  // N, m; exact

using Unit = std::pair<std::string_view, double>;
constexpr std::array<Unit, 6> kForces{{{"N", 1.0},
                                       {"lbf", kPound},
                                       {"klbf", 1e3 * kPound},
                                       {"kN", 1e3},
                                       {"kgf", kKilogram},
                                       {"gf", 1e-3 * kKilogram}}};
constexpr std::array<Unit, 10> kTorques{{{"N-m", 1.0},
                                         {"Nm", 1.0},
                                         {"N-mm", 1e-3},
                                         {"Nmm", 1e-3},
                                         {"lbf-in", kPound* kInch},
                                         {"lbf-ft", kPound* kFoot},
                                         {"kgf-cm", 1e-2 * kKilogram},
                                         {"kgf-m", kKilogram},
                                         {"kN-m", 1e3},
                                         {"kNm", 1e3}}};

template <std::size_t kCount>
double unit_of(std::string_view name, const std::array<Unit, kCount>& units) {
  const auto* found =
      std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.first == name; });
  return found == units.end() ? kUnset : found->second;
}

double number(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? value : kUnset;
}

struct Page {
  pugi::xml_node root;
  std::string wrong{};  // first problem

  // Text of a tag that must occur once. If it occurs twice, neither value can be trusted.
  std::optional<std::string> text(const char* tag, bool needed) {
    const pugi::xml_node first = root.child(tag);
    if (first && first.next_sibling(tag)) say(fmt::format("has two <{}>", tag));
    if (!first && needed) say(fmt::format("has no <{}>", tag));
    if (!first) return {};
    return first.text().get();
  }
  double positive(const char* tag) {
    const std::optional<std::string> said = text(tag, true);
    const double value = said ? number(*said) : kUnset;
    if (said && !(value > 1e-9 && value < 1e15))
      say(fmt::format("says <{}> '{:.40}', expected a positive number", tag, *said));
    return value;
  }
  void say(const std::string& words) {
    if (wrong.empty()) wrong = words;
  }
};

// Reads three forces and three torques, in the units of the page.
void read_ratings(std::string_view rest, double newtons, double newton_metres, Configuration& read) {
  for (std::size_t i = 0; i < read.ratings.size(); ++i) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    read.ratings[i] = number(rest.substr(0, end)) * (i < 3 ? newtons : newton_metres);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

}  // namespace

double force_of_code(int code) noexcept {
  constexpr std::array<double, 6> kUnits{kPound, 1.0, 1e3 * kPound, 1e3, kKilogram, 1e-3 * kKilogram};
  return code >= 1 && code <= 6 ? kUnits[static_cast<std::size_t>(code - 1)] : kUnset;
}

double torque_of_code(int code) noexcept {
  constexpr std::array<double, 6> kUnits{kPound * kInch, kPound * kFoot, 1.0, 1e-3, 1e-2 * kKilogram, 1e3};
  return code >= 1 && code <= 6 ? kUnits[static_cast<std::size_t>(code - 1)] : kUnset;
}

std::string read_xml(std::string_view xml, Configuration& configuration) {
  if (xml.size() > kMostXml) return fmt::format("is longer than {} bytes", kMostXml);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size(), pugi::parse_default);
  if (!parsed) return fmt::format("is no XML: {} at byte {}", parsed.description(), parsed.offset);
  Page page{document.document_element()};
  Configuration read;
  read.product = page.text("prodname", true).value_or("");
  read.name = page.text("cfgnam", false).value_or("");
  read.serial = page.text("cfgcalsn", false).value_or("");
  const double counts_force = page.positive("cfgcpf"), counts_torque = page.positive("cfgcpt");
  const std::string force = page.text("scfgfu", true).value_or(""),
                    torque = page.text("scfgtu", true).value_or("");
  const double newtons = unit_of(force, kForces), newton_metres = unit_of(torque, kTorques);
  if (std::isnan(newtons))
    page.say(fmt::format("says force unit '{:.40}', expected N, lbf, klbf, kN, kgf or gf", force));
  if (std::isnan(newton_metres))
    page.say(fmt::format(
        "says torque unit '{:.40}', expected N-m, N-mm, lbf-in, lbf-ft, kgf-cm, kgf-m or kN-m", torque));
  read.per_newton = counts_force / newtons;
  read.per_newton_metre = counts_torque / newton_metres;
  if (const auto ratings = page.text("cfgmr", false)) read_ratings(*ratings, newtons, newton_metres, read);
  if (const auto rate = page.text("comrdtrate", false)) read.rate = number(*rate);
  if (const auto streams = page.text("comrdte", false))
    read.streams = *streams == "Enabled" || number(*streams) == 1.0;
  if (const auto filter = page.text("setuserfilter", false)) {
    const double index = number(*filter);
    read.filter = index >= 0.0 && index < 100.0 ? static_cast<int>(index) : -1;
  }
  if (const auto transform = page.text("cfgtfx", false))
    read.turned = transform->find_first_of("123456789") != std::string::npos;
  if (page.wrong.empty()) configuration = read;
  return page.wrong;
}

std::string xml_of(const Configuration& of) {
  std::string ratings;
  for (const double rating : of.ratings) ratings += fmt::format("{}{:g}", ratings.empty() ? "" : ";", rating);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\r\n<netft><prodname>{}</prodname><setcfgsel>0</setcfgsel>"
      "<cfgnam>{}</cfgnam><cfgcalsn>{}</cfgcalsn><cfgfu>2</cfgfu><scfgfu>N</scfgfu><cfgtu>3</"
      "cfgtu><scfgtu>N-m</scfgtu>"
      "<cfgcpf>{:.0f}</cfgcpf><cfgcpt>{:.0f}</cfgcpt><cfgmr>{}</cfgmr><comrdte>{}</comrdte>"
      "<comrdtrate>{:.0f}</comrdtrate><setuserfilter>{}</setuserfilter></netft>\r\n",
      of.product, of.name, of.serial, of.per_newton, of.per_newton_metre, ratings,
      of.streams ? "Enabled" : "Disabled", of.rate, of.filter);
}

}  // namespace enc::netft
