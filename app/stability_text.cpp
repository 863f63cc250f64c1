#include "app/stability_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/said.h"

namespace enc::app {
namespace {

using trial::Certified;

// A line for each class that there is.
std::string class_lines(const std::vector<Certified>& all, const char* before) {
  Said said;
  for (const Certified& one : all) said.emplace_back(trial::name_of(one), trial::class_text(one));
  std::string text;
  for (const SaidOf& group : grouped(said))
    text += fmt::format("{}{}: {}\n", before, listed(group.names), group.what);
  return text;
}

// How near it is to what it may ask for: the least margin of what makes it unstable, or 0 beyond that.
double margin_of(const Certified& one) {
  if (one.beyond() || one.unknown()) return 0.0;
  double least = INFINITY;
  for (const certificate::Row& row : one.certificate.rows)
    if (row.name.starts_with("exact") || row.name == "admittance" || row.name == "large_signal")
      least = std::min(least, row.margin);
  return least;
}

std::string bound_text(const certificate::Row& row) {
  const auto in = [](double x) {
    return std::isnan(x) ? std::string("not known") : fmt::format("{:.4g}", 1e-3 * x);
  };
  return row.low > 0.0 || std::isnan(row.low)
             ? "from " + in(row.low) + (std::isinf(row.bound) ? "" : " to " + in(row.bound))
         : std::isinf(row.bound) ? "no bound"
                                 : "to " + in(row.bound);
}

std::string rows_text(const Certified& one) {
  std::string text = fmt::format("  bounds of {}, N/mm, and how many times what it asks for is within them\n",
                                 trial::name_of(one));
  for (const certificate::Row& row : one.certificate.rows)
    text += fmt::format("    {:<16}  {:<22} {:<9} {}{} ({})\n", row.name, bound_text(row),
                        std::isfinite(row.margin) ? fmt::format("{:.3g} x", row.margin) : "", row.formula,
                        row.applies ? "" : ", for another kind of loop: to compare", row.source);
  return text;
}

}  // namespace

std::string stability_text(const models::Setup& setup, const std::vector<Certified>& certificates) {
  if (certificates.empty()) return {};
  std::string text = "\nstability\n" + class_lines(certificates, "  ");
  for (const Certified& one : certificates)
    if (one.beyond() || one.unknown()) text += "  BEYOND: " + trial::refusal_text(setup, one) + "\n";
  const auto nearest =
      std::min_element(certificates.begin(), certificates.end(),
                       [](const auto& a, const auto& b) { return margin_of(a) < margin_of(b); });
  return text + rows_text(*nearest);
}

std::string stability_lines(const std::vector<Certified>& certificates) {
  return class_lines(certificates, "stability   ");
}

}  // namespace enc::app
