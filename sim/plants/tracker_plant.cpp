#include "sim/plants/tracker_plant.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/track/markers.h"

namespace enc::sim {

StereoPoints::StereoPoints(const CameraTruth& truth, std::uint64_t seed)
    : truth_(truth), frames_(seed, "camera.frames"), places_(seed, "camera.places") {
  move();
}

std::optional<StereoPixel> StereoPoints::project(const Point<'C'>& point) const {
  const double z = point.e().z();
  if (!point.finite() || !(z > 0.0)) return std::nullopt;
  const double last_column = static_cast<double>(truth_.width - 1);
  const double last_row = static_cast<double>(truth_.height - 1);
  const StereoPixel pixel{0.5 * last_column + truth_.focal * point.e().x() / z,
                          0.5 * last_row + truth_.focal * point.e().y() / z,
                          truth_.focal * truth_.baseline / z};
  // The right camera stands to the right, so the scene is shifted to the left in its image.
  const bool seen = pixel.column - pixel.disparity >= 0.0 && pixel.column <= last_column &&
                    pixel.row >= 0.0 && pixel.row <= last_row;
  return seen ? std::optional(pixel) : std::nullopt;
}

Point<'C'> StereoPoints::triangulate(const StereoPixel& pixel) const {
  if (!(pixel.disparity > 0.0)) return {};
  const double z = truth_.focal * truth_.baseline / pixel.disparity;
  const double each = z / truth_.focal;  // m per pixel there
  return {(pixel.column - 0.5 * static_cast<double>(truth_.width - 1)) * each,
          (pixel.row - 0.5 * static_cast<double>(truth_.height - 1)) * each, z};
}

Vec<'C'> StereoPoints::scatter(const Point<'C'>& point) const {
  const double z = point.e().z();
  // A uniform step has a variance of a twelfth of its square; wider noise makes it independent.
  const double disparity = std::hypot(truth_.matching, truth_.disparity_step / std::sqrt(12.0));
  const double depth = z * z / (truth_.focal * truth_.baseline) * disparity;
  const double aside = z / truth_.focal * truth_.pointing;
  return {std::hypot(aside, point.e().x() / z * depth), std::hypot(aside, point.e().y() / z * depth), depth};
}

void StereoPoints::move() { standing_ = truth_.standing * places_.normal3(); }

std::optional<Point<'C'>> StereoPoints::see(const Point<'C'>& point) {
  std::optional<StereoPixel> pixel = project(point);
  if (!pixel) return std::nullopt;
  const Vec3 noise = frames_.normal3();
  pixel->column += standing_.x() + truth_.pointing * noise.x();
  pixel->row += standing_.y() + truth_.pointing * noise.y();
  pixel->disparity += standing_.z() + truth_.matching * noise.z();
  const double step = truth_.disparity_step;
  if (step > 0.0) pixel->disparity = std::round(pixel->disparity / step) * step;
  const Point<'C'> seen = triangulate(*pixel);
  return seen.finite() ? std::optional(seen) : std::nullopt;
}

namespace {

Pose<'W', 'T'> between(const Pose<'W', 'T'>& a, const Pose<'W', 'T'>& b, double share) {
  return {a.q().slerp(share, b.q()), Vec3(a.p() + share * (b.p() - a.p()))};
}

template <std::size_t N>
void put(std::array<TrackerPlant::Packet, N>& line, const Measurement<TrackedTool>& sample, Time due) {
  // A full line loses its oldest packet, as a socket buffer would.
  auto* slot = std::min_element(line.begin(), line.end(), [](const auto& a, const auto& b) {
    return a.waiting != b.waiting ? !a.waiting : a.due < b.due;
  });
  *slot = {sample, due, true};
}

}  // namespace

TrackerPlant::TrackerPlant(const TrackerTruth& truth, const Pose<'W', 'C'>& X_WC, std::uint64_t seed,
                           std::vector<std::vector<Vec3>> markers)
    : truth_(truth), X_CW_(X_WC.inverse()), markers_(std::move(markers)) {
  if (truth.latency * truth.rate > 60.0)
    throw Error("at most 60 frames can be on their way at once", "truth.tracker.latency");
  state_.noise = Stream(seed, "tracker");
  if (truth.process * truth.server_rate > 60.0)
    throw Error("at most 60 packets can be on their way at once", "truth.tracker.process");
  const double phase = truth.clocks == TrackerClocks::free ? 1.0 : 0.0;
  state_.exposure = {truth.rate, 0, from_seconds(phase * state_.noise.uniform() / truth.rate)};
  state_.server = {truth.server_rate, 0, from_seconds(phase * state_.noise.uniform() / truth.server_rate)};
}

// The tracker's measurement of the markers of one tool.
TrackedTool TrackerPlant::by_markers(std::int32_t tool, const Pose<'W', 'T'>& X_WT) {
  const std::vector<Vec3>& markers = markers_.at(static_cast<std::size_t>(tool));
  std::array<Vec3, kMostMarkers> seen;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const Vec3 noise = truth_.marker_noise * state_.noise.normal3();
    const Point<'W'> at(Vec3((X_WT * Point<'T'>(markers[i])).e() + noise));
    seen[i] = (X_CW_ * at).e();
  }
  const RecognisedTool found = recognise(std::span(seen).first(markers.size()), markers_);
  return {found.tool, found.X_CT};
}

void TrackerPlant::expose(Time at, std::int32_t tool, const Pose<'W', 'T'>& X_WT) {
  const double t = seconds(at.time_since_epoch());
  const bool blind = t >= truth_.blackout_at && t < truth_.blackout_at + truth_.blackout_for;
  const Vec3 error = truth_.bias + truth_.noise.cwiseProduct(state_.noise.normal3());
  if (blind || tool < 0)
    return;  // the tool is out of view: a hand covers the markers, or the user holds no
             // tool
  Quat turned(X_WT.q());
  if (truth_.turn_noise > 0.0)  // otherwise no number is drawn, so that other noise keeps its values
    turned = rotation_xyz(truth_.turn_noise * state_.noise.normal3()) * turned;
  const Pose<'W', 'T'> shifted(turned, Vec3(X_WT.p() + error));
  const bool has_markers =
      static_cast<std::size_t>(tool) < markers_.size() &&
      markers_[static_cast<std::size_t>(tool)].size() >= kFewestMarkers;  // a finger has no markers
  const TrackedTool seen = has_markers && !std::isnan(truth_.marker_noise)
                               ? by_markers(tool, shifted)
                               : TrackedTool{tool, X_CW_ * shifted};
  if (seen.tool < 0) return;
  put(state_.exposed, {seen, at + from_seconds(truth_.stamp_error), Health::ok},
      at + from_seconds(truth_.latency));
}

void TrackerPlant::transmit(const Measurement<TrackedTool>& sample, Time at) {
  const double delay =
      truth_.process + (truth_.udp_delay > 0.0 ? state_.noise.exponential(truth_.udp_delay) : 0.0);
  const bool lost = state_.noise.uniform() < truth_.loss;
  if (lost)
    ++state_.dropped;
  else
    put(state_.on_wire, sample, at + from_seconds(delay));
}

// The server's newest pose, unless it was sent before.
void TrackerPlant::poll_exposed(Time now) {
  for (Packet& packet : state_.exposed) {
    if (!packet.waiting || packet.due > now) continue;
    packet.waiting = false;
    if (state_.at_server.health == Health::absent || packet.sample.t > state_.at_server.t)
      state_.at_server = packet.sample;
  }
  if (state_.at_server.health != Health::ok || state_.at_server.t <= state_.sent) return;
  state_.sent = state_.at_server.t;
  transmit(state_.at_server, now);
}

void TrackerPlant::send_ready(Time now) {
  for (Packet& packet : state_.exposed) {
    if (!packet.waiting || packet.due > now) continue;
    packet.waiting = false;
    transmit(packet.sample, packet.due);
  }
}

void TrackerPlant::deliver(Time now) {
  for (Packet& packet : state_.on_wire) {
    if (!packet.waiting || packet.due > now) continue;
    packet.waiting = false;
    if (state_.arrived.health == Health::absent || packet.sample.t > state_.arrived.t) {
      state_.arrived = packet.sample;
      state_.news = true;
    }
  }
}

void TrackerPlant::advance(Time t, std::int32_t tool, const Pose<'W', 'T'>& X_WT) {
  const bool first = !state_.before.valid() || tool != state_.tool_before;
  for (Time at = state_.exposure.next(); state_.exposure.due(t); at = state_.exposure.next()) {
    const double span = seconds(t - state_.before_t);
    const double share =
        first || span <= 0.0 ? 1.0 : std::clamp(seconds(at - state_.before_t) / span, 0.0, 1.0);
    expose(at, tool, first ? X_WT : between(state_.before, X_WT, share));
  }
  if (truth_.packets == Packets::event) send_ready(t);
  for (Time at = state_.server.next(); state_.server.due(t); at = state_.server.next())
    if (truth_.packets == Packets::polled) poll_exposed(at);
  deliver(t);
  state_.before = X_WT;
  state_.tool_before = tool;
  state_.before_t = t;
}

bool TrackerPlant::poll(Measurement<TrackedTool>& newest) noexcept {
  if (!state_.news) return false;
  newest = state_.arrived;
  state_.news = false;
  return true;
}

TrackerTruth with_tool_known(TrackerTruth truth, std::span<const Vec3> markers, const Vec3& tip) {
  if (!std::isnan(truth.marker_noise) && markers.size() >= kFewestMarkers) {
    const Vec3 squares = truth.marker_noise * truth.marker_noise * point_covariance(markers, tip).diagonal();
    truth.noise = (truth.noise.cwiseAbs2() + squares).cwiseSqrt();
  }
  truth.marker_noise = kUnset;
  return truth;
}

}  // namespace enc::sim
