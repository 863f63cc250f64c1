#include "app/stability_text.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "app/built.h"
#include "app/common/words.h"

namespace enc::app {
namespace {

using trial::ObjectCertificate;

// One line for each existing class.
std::string class_lines(const std::vector<ObjectCertificate>& all, const char* before) {
  Statements said;
  for (const ObjectCertificate& one : all) said.emplace_back(trial::name_of(one), trial::class_text(one));
  std::string text;
  for (const SharedStatement& group : grouped(said))
    text += fmt::format("{}{}: {}\n", before, listed(group.names), group.what);
  return text;
}

// The smallest margin to instability.
double margin_of(const ObjectCertificate& one) {
  double least = INFINITY;
  for (const certificate::Row& row : one.certificate.rows)
    if (row.name.starts_with("exact") || row.name == "admittance" || row.name == "large_signal")
      least = std::min(least, row.margin);
  return least;
}

using Side = certificate::Row::Side;

std::string bound_text(const certificate::Row& row) {
  const auto in = [](double x) {
    return std::isnan(x) ? std::string("not known") : fmt::format("{:.4g}", 1e-3 * x);
  };
  return row.low > 0.0 || std::isnan(row.low) ? "from " + (certificate::sign_of(row.side) + in(row.low)) +
                                                    (std::isinf(row.bound) ? "" : " to " + in(row.bound))
         : std::isinf(row.bound) ? "no bound"
                                 : "to " + in(row.bound);
}

// The sign flips: a limit below the value of the row means a larger margin.
std::string margin_text(const certificate::Row& row) {
  if (!std::isfinite(row.margin)) return {};
  const Side other = row.side == Side::below ? Side::above : row.side == Side::above ? Side::below : Side::at;
  return fmt::format("{}{:.3g} x", certificate::sign_of(other), row.margin);
}

// The place of an arm's certificate, which holds for one place only.
std::string place_text(const ObjectCertificate& one) {
  if (!one.place.finite() || one.free_tip()) return {};
  const auto rounded = [](double metres) { return std::round(metres * 1e4) * 0.1 + 0.0; };  // mm, avoids -0
  return fmt::format(" at [{:.1f}, {:.1f}, {:.1f}] mm, {},", rounded(one.place.xyz[0]),
                     rounded(one.place.xyz[1]), rounded(one.place.xyz[2]),
                     one.pressed ? "where it is pressed" : "the worst place tried");
}

std::string rows_text(const ObjectCertificate& one) {
  std::string text =
      fmt::format("  bounds of {}{} N/mm, and how many times what it asks for is within them\n",
                  trial::name_of(one), place_text(one).empty() ? "," : place_text(one));
  for (const certificate::Row& row : one.certificate.rows)
    text += fmt::format("    {:<16}  {:<22} {:<9} {}{} ({})\n", row.name, bound_text(row), margin_text(row),
                        row.formula, row.applies ? "" : ", for another kind of loop: to compare", row.source);
  return text;
}

}  // namespace

const ObjectCertificate& nearest_its_bound(const std::vector<ObjectCertificate>& certificates) {
  const auto order = [](const ObjectCertificate& one) {
    return std::tuple(one.beyond()    ? 0
                      : one.unknown() ? 1
                                      : 2,
                      margin_of(one), !one.like.empty(), one.free_tip());
  };
  return *std::min_element(certificates.begin(), certificates.end(),
                           [&](const auto& a, const auto& b) { return order(a) < order(b); });
}

std::string stability_text(const models::Setup& setup, const std::vector<ObjectCertificate>& certificates) {
  if (certificates.empty()) return {};
  std::string text = "\nstability\n" + class_lines(certificates, "  ");
  for (const ObjectCertificate& one : certificates)
    if (one.beyond() || one.unknown())
      text += (one.beyond() ? "  BEYOND: " : "  NOT KNOWN: ") + trial::refusal_text(setup, one) + "\n";
  const MachineWords& words = words_of(setup.scene);
  if (words.passivity(setup.rig) == PassivityForm::controlled)
    text += fmt::format(
        "  rig.{}.passivity=controlled: energy that would come out along the normal is held back; the "
        "classes "
        "above are without that, and decide the exit code and --armed all the same\n",
        words.section);
  return text + rows_text(nearest_its_bound(certificates));
}

std::string stability_lines(const std::vector<ObjectCertificate>& certificates) {
  return class_lines(certificates, "stability   ");
}

}  // namespace enc::app
