#include "app/run/press_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/counted.h"

namespace enc::app {
namespace {

// One entry for each press: speed, miss and its bound, all in the units people think in.
template <class F>
std::string each(const std::vector<trial::PressFigures>& presses, const F& figure) {
  std::string text;
  for (const trial::PressFigures& press : presses) {
    if (std::isnan(press.miss)) continue;
    text += (text.empty() ? "" : " / ") + figure(press);
  }
  return text;
}

// The force range of the presses that reached the limit, and how many did.
std::string at_limit_text(const std::vector<trial::PressFigures>& presses) {
  double low = INFINITY;
  double high = -INFINITY;
  std::size_t met = 0, reached = 0;
  for (const trial::PressFigures& press : presses) {
    if (std::isnan(press.miss)) continue;
    ++met;
    if (std::isnan(press.force_at_limit)) continue;
    ++reached;
    low = std::min(low, press.force_at_limit);
    high = std::max(high, press.force_at_limit);
  }
  if (reached == 0) return "limit not reached";
  const std::string range =
      reached == 1 ? fmt::format("{:.2f}", low) : fmt::format("{:.2f}..{:.2f}", low, high);
  return range + " N at the limit" +
         (reached < met ? fmt::format(" in {} of {}", reached, counted(met, "press")) : "");
}

// "limit 6 mm"; where the presses had several, each with its object.
std::string limit_text(const RunReport& r) {
  std::vector<std::pair<std::int32_t, double>> limits;
  for (const trial::PressFigures& press : r.measured.presses.presses())
    if (press.object >= 0 &&
        std::find(limits.begin(), limits.end(), std::pair(press.object, press.limit)) == limits.end())
      limits.emplace_back(press.object, press.limit);
  const auto millimetres = [](double limit) { return std::round(limit * 1e9) * 1e-6; };
  if (limits.empty()) return "no contact";
  if (limits.size() == 1) return fmt::format("limit {:g} mm", millimetres(limits.front().second));
  const bool one_object = std::all_of(limits.begin(), limits.end(),
                                      [&](const auto& l) { return l.first == limits.front().first; });
  std::string text = "limits";
  for (const auto& [object, limit] : limits)
    text += fmt::format(
        "{} {:g} mm{}", text == "limits" ? "" : ",", millimetres(limit),
        one_object ? ""
                   : fmt::format(" ('{}')", r.setup.scene.objects[static_cast<std::size_t>(object)].name));
  return text;
}

std::string outside_text(double outside) {
  if (std::isnan(outside)) return "tip         was never inside of an object";
  return fmt::format("tip         {} {:.1f} um",
                     outside <= 0.0 ? "inside of the undeformed object by at least"
                                    : "OUTSIDE of the undeformed object by up to",
                     std::abs(outside) * 1e6);
}

// Root mean square, m, of each axis of W that was travelled: "0.107 / 0.094 / 0.083 mm, norm 0.165 mm".
std::string axes_text(const std::array<trial::ErrorSum, 3>& sums) {
  std::string text;
  double square = 0.0;
  for (const trial::ErrorSum& sum : sums) {
    const double rmse = sum.errors().rmse;
    square += rmse * rmse;
    text += (text.empty() ? "" : " / ") +
            (sum.size() == 0 ? std::string("-") : fmt::format("{:.3f}", rmse * 1e3));
  }
  return text + (std::isnan(square) ? " mm" : fmt::format(" mm, norm {:.3f} mm", std::sqrt(square) * 1e3));
}

}  // namespace

double peak_of(const std::vector<trial::PressFigures>& presses, double trial::PressFigures::*figure) {
  double most = 0.0;
  for (const trial::PressFigures& press : presses) most = std::max(most, press.*figure);
  return most;
}

std::string press_lines(const RunReport& r) {
  if (r.scene.impedance()) return "";
  if (!r.measured.felt.truth)
    return fmt::format(
        "felt        peak {:.2f} N, {:.3f} mm deep, as the core knows them; what needs the truth is left "
        "out, because not every device is simulated\n",
        r.measured.felt.peak, 1e3 * r.measured.felt.deepest);
  const auto& presses = r.measured.presses.presses();
  const auto met = [](const trial::PressFigures& p) { return !std::isnan(p.miss); };
  if (std::none_of(presses.begin(), presses.end(), met)) return "";
  std::string text;
  text += fmt::format("force       peak {:.2f} N, {} (true); deflection peak {:.3f} mm (true), {}\n",
                      peak_of(presses, &trial::PressFigures::peak_force), at_limit_text(presses),
                      peak_of(presses, &trial::PressFigures::peak_deflection) * 1e3, limit_text(r));
  const auto newtons = [](double x) {
    return std::isnan(x) ? std::string("none") : fmt::format("{:.3f} N", x);
  };
  text += fmt::format(
      "error       press {} RMSE, release {} RMSE (true force against the response at true deflection)\n",
      newtons(r.measured.presses.rmse_press()), newtons(r.measured.presses.rmse_release()));
  text +=
      fmt::format("approach    {} mm/s\n",
                  each(presses, [](const auto& p) { return fmt::format("{:.0f}", p.approach_speed * 1e3); }));
  text += fmt::format("  miss      {} mm (true tool tip to haptic-tip at first touch)\n",
                      each(presses, [](const auto& p) { return fmt::format("{:.2f}", p.miss * 1e3); }));
  text += fmt::format(
      "  bound     {} mm{}\n",
      each(presses, [](const auto& p) { return fmt::format("{:.2f}", p.miss_bound * 1e3); }),
      std::all_of(presses.begin(), presses.end(), [](const auto& p) { return !(p.miss > p.miss_bound); })
          ? ""
          : "  EXCEEDED");
  text += fmt::format("  contacts  {}\n",
                      each(presses, [](const auto& p) { return fmt::format("{}", p.contacts); }));
  text += fmt::format("energy      {:.2f} mJ in, {:.2f} mJ out\n", r.measured.presses.energy_in() * 1e3,
                      r.measured.presses.energy_out() * 1e3);
  text += outside_text(r.measured.presses.greatest_outside());
  text += fmt::format("; pull on the tool at most {:.3f} N\n", r.measured.presses.greatest_tension());
  return text;
}

std::string travel_lines(const RunReport& r) {
  if (r.scene.travel() == nullptr) return "";
  const trial::TravelSums& sums = r.measured.travel.sums();
  if (sums.size() == 0) return "tracking    not measured: the tracker reported no tool on the way\n";
  std::array<trial::ErrorSum, 3> moving = sums.forward;
  for (std::size_t axis = 0; axis < moving.size(); ++axis) moving[axis].add(sums.back[axis]);
  return fmt::format(
             "tracking    error along each travelled axis of W, rms, x / y / z: tracked tool tip less where "
             "the machine says it is; {}\n",
             counted(sums.size(), "packet")) +
         fmt::format("  stops     {}\n", axes_text(sums.stopped)) +
         fmt::format("  moving    {}, at {:g} mm/s\n", axes_text(moving),
                     std::round(r.setup.scene.travel->speed * 1e6) * 1e-3) +
         fmt::format("  largest   {:.3f} mm, of any packet and direction\n", sums.largest * 1e3);
}

}  // namespace enc::app
