#include "models/identify/tracker/latency_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "models/identify/block_fit.h"
#include "models/identify/tracker/tracker_log.h"
#include "models/order_statistics.h"

namespace enc::models {
namespace {

// ---- Checks that the machine carries the tool: compares the motions of a log's tool and tip, one axis at a
// time.

constexpr double kBlock = 0.25;  // s: errors farther apart than this are independent

// Arrival times of the packets (or their stamps), their assumed age, and the ones not counted.
struct SeenAt {
  const std::vector<double>& times;  // s
  double age;                        // s
  const std::vector<bool>& left_out;
};

struct ToolMotion {
  double wander = 0.0;  // m: largest minus smallest median of a block
  double noise = 0.0;   // m, rms, from one packet to the next
  double scale = 1.0;   // slope of the tool's position over the tip's
  // Part of the tool's motion that the tip does not explain. It includes outliers, so that a log with only
  // outliers does not look good.
  double unexplained = 0.0;
};

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0, square = 0.0, product = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) mean_x += x[k] / n, mean_y += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    square += (x[k] - mean_x) * (x[k] - mean_x);
    product += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return product / square;
}

ToolMotion tool_motion(const TrackerLog& log, const TipPath& path, const SeenAt& seen, Eigen::Index axis) {
  std::vector<double> tools, left, steps, good_tips, good_tools;
  std::vector<std::vector<double>> blocks;
  for (std::size_t k = 0; k < seen.times.size(); ++k) {
    const double t = seen.times[k] - seen.age;
    if (!path.knows(t)) continue;
    const double tool = log.packets[k].tool(axis), tip = path.position(t)(axis);
    if (!tools.empty()) steps.push_back(std::abs(tool - tools.back()));
    tools.push_back(tool);
    left.push_back(tool - tip);
    const auto block = static_cast<std::size_t>((t - log.time.front()) / kBlock);
    if (block >= blocks.size()) blocks.resize(block + 1);
    blocks[block].push_back(tool);
    if (!seen.left_out[k]) good_tips.push_back(tip), good_tools.push_back(tool);
  }
  // A block that lost most of its packets gives no reliable median.
  std::size_t full = 0;
  for (const std::vector<double>& block : blocks) full = std::max(full, block.size());
  double low = INFINITY, high = -INFINITY;
  for (const std::vector<double>& block : blocks) {
    if (block.empty() || 3 * block.size() < full) continue;
    low = std::min(low, median(block));
    high = std::max(high, median(block));
  }
  return {std::max(0.0, high - low), 1.4826 / std::sqrt(2.0) * median(steps), slope(good_tips, good_tools),
          spread(left) / spread(tools)};
}

constexpr double kEarliest = -0.1, kLatest = 0.6;  // s: range of ages searched
constexpr double kStill = 1e-3;                    // m/s, and m of travel: less counts as no motion
constexpr double kFewestPackets = 10;              // packets for anything
constexpr double kOutlier = 6.0;                   // standard deviations

using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;
enum Column : Eigen::Index { kRest, kMoving, kAge, kStep };

// One packet as seen by an axis.
struct PacketObservation {
  double error, speed;  // m: tool minus tip at the assumed age; m/s of the tip then
  std::size_t block;
  double t;
};
using Axis = std::vector<PacketObservation>;

struct LatencySolution {
  Vec4 x = Vec4::Zero();
  std::array<bool, 4> used{};
  std::array<Blocks, 4> blocks;
  double information = 0.0;  // about the age, 1/s^2
  [[nodiscard]] Interval interval(Column c) const {
    return used[static_cast<std::size_t>(c)] ? blocks[static_cast<std::size_t>(c)].around(x(c)) : Interval{};
  }
};

class Fit {
 public:
  explicit Fit(const TrackerLog& log) : log_(log), path_(log) {
    Vec3 low = log.tip.front(), high = low;
    for (const Vec3& p : log.tip) low = low.cwiseMin(p), high = high.cwiseMax(p);
    travel_ = high - low;
  }

  // Places the packets at `times` (arrival or stamp) and runs the whole fit.
  LatencyFit run(const std::vector<double>& times) {
    times_ = &times;
    left_out_.assign(times.size(), false);
    age_ = travel_.maxCoeff() > kStill ? nearest_age() : 0.0;
    scatter_ = 5e-3;
    constexpr double kSettled = 1e-7;  // s
    for (int round = 0; round < 12; ++round) {
      look();
      weigh();
      const double change = common().value;
      if (round > 3 && std::abs(change) < kSettled) break;
      if (round > 0 && round < 4) drop_outliers();
      age_ += change;
    }
    return result();
  }

 private:
  // Least sum of absolute errors over a coarse grid: it needs no start, and outliers do no harm. Any age
  // explains the few packets at the end of a short log, so half of them must be known.
  double nearest_age() const {
    constexpr double kGrid = 4e-3;  // s
    const std::size_t stride = std::max<std::size_t>(1, log_.packets.size() / 600);
    constexpr auto kAges = static_cast<std::size_t>((kLatest - kEarliest) / kGrid);
    std::array<double, kAges + 1> known{}, size{};
    for (std::size_t i = 0; i <= kAges; ++i) {
      const double age = kEarliest + static_cast<double>(i) * kGrid;
      std::array<std::vector<double>, 3> errors;
      for (std::size_t k = 0; k < times_->size(); k += stride) {
        const double t = (*times_)[k] - age;
        if (!path_.knows(t)) continue;
        const Vec3 e = log_.packets[k].tool - path_.position(t);
        for (std::size_t a = 0; a < 3; ++a) errors[a].push_back(e(static_cast<Eigen::Index>(a)));
      }
      known[i] = static_cast<double>(errors[0].size());
      for (const auto& axis : errors)
        for (const double middle = median(axis); const double e : axis)
          size[i] += std::abs(e - middle) / known[i];
    }
    const double enough = std::max(kFewestPackets, 0.5 * *std::max_element(known.begin(), known.end()));
    double best = 0.0, least = INFINITY;
    for (std::size_t i = 0; i <= kAges; ++i)
      if (known[i] >= enough && size[i] < least)
        least = size[i], best = kEarliest + static_cast<double>(i) * kGrid;
    return best;
  }

  void look() {
    for (Axis& axis : axes_) axis.clear();
    index_.clear();
    const double start = log_.time.front();
    for (std::size_t k = 0; k < times_->size(); ++k) {
      const double t = (*times_)[k] - age_;
      if (left_out_[k] || !path_.knows(t)) continue;
      const Vec3 error = log_.packets[k].tool - path_.position(t);
      const Vec3 speed = path_.velocity(t);
      const auto block = static_cast<std::size_t>((t - start) / kBlock);
      for (Eigen::Index a = 0; a < 3; ++a)
        axes_[static_cast<std::size_t>(a)].push_back({error(a), speed(a), block, t});
      index_.push_back(k);
    }
    blocks_ = static_cast<std::size_t>((log_.time.back() - start) / kBlock) + 1;
    for (std::size_t a = 0; a < 3; ++a) describe(a);
  }

  // Determines whether an axis moves, from which speed on, and in which directions.
  void describe(std::size_t a) {
    std::vector<double> speeds;
    for (const PacketObservation& s : axes_[a])
      if (std::abs(s.speed) > kStill) speeds.push_back(std::abs(s.speed));
    fastest_[a] = speeds.empty() ? 0.0 : percentile(speeds, 0.95);  // one jump of a reading is no motion
    limit_[a] = std::max(kStill, 0.1 * fastest_[a]);
    std::size_t ahead = 0, back = 0;
    for (const PacketObservation& s : axes_[a]) ahead += s.speed > limit_[a], back += s.speed < -limit_[a];
    moving_[a] = ahead + back;
    backwards_[a] = std::min(ahead, back);
    moved_[a] = travel_(static_cast<Eigen::Index>(a)) > kStill && moving_[a] >= kFewestPackets;
    both_[a] = moved_[a] && backwards_[a] >= kFewestPackets;
  }

  [[nodiscard]] bool moves(std::size_t a, const PacketObservation& s) const {
    return moved_[a] && std::abs(s.speed) > limit_[a];
  }
  [[nodiscard]] double variance(std::size_t a, const PacketObservation& s) const {
    return noise_[a] * noise_[a] + std::pow(s.speed * scatter_, 2);
  }
  [[nodiscard]] Vec4 row(std::size_t a, const PacketObservation& s, bool with_step) const {
    Vec4 x = Vec4::Zero();
    const bool moving = moves(a, s);
    x(moving && both_[a] ? kMoving : kRest) = 1.0;
    if (moved_[a]) x(kAge) = -s.speed;
    if (with_step && moving) x(kStep) = s.speed > 0.0 ? -1.0 : 1.0;
    return x;
  }

  [[nodiscard]] LatencySolution solve(std::size_t a, bool with_step) const {
    Mat4 gram = Mat4::Zero();
    Vec4 moment = Vec4::Zero();
    for (const PacketObservation& s : axes_[a]) {
      const Vec4 x = row(a, s, with_step);
      gram += x * x.transpose() / variance(a, s);
      moment += x * s.error / variance(a, s);
    }
    LatencySolution out;
    for (Eigen::Index c = 0; c < 4; ++c) {
      out.used[static_cast<std::size_t>(c)] = gram(c, c) > 0.0;
      if (!(gram(c, c) > 0.0)) gram(c, c) = 1.0;
    }
    out.information = out.used[kAge] ? gram(kAge, kAge) : 0.0;
    // Scales the columns to one size, because m and s do not mix well.
    const Vec4 size = gram.diagonal().cwiseSqrt();
    const Mat4 scaled = size.cwiseInverse().asDiagonal() * gram * size.cwiseInverse().asDiagonal();
    const Mat4 covariance =
        size.cwiseInverse().asDiagonal() * scaled.inverse() * size.cwiseInverse().asDiagonal();
    out.x = covariance * moment;
    for (Blocks& b : out.blocks) b.influence.assign(blocks_, 0.0), b.weight.assign(blocks_, 0.0);
    for (const PacketObservation& s : axes_[a]) {
      const Vec4 x = row(a, s, with_step);
      const Vec4 influence = covariance * x * ((s.error - x.dot(out.x)) / variance(a, s));
      for (Eigen::Index c = 0; c < 4; ++c) {
        Blocks& b = out.blocks[static_cast<std::size_t>(c)];
        b.influence[s.block] += influence(c);
        b.weight[s.block] += std::pow(covariance.row(c).dot(x), 2) / variance(a, s);
      }
    }
    return out;
  }

  // Noise at rest and scatter of the age, from the residuals.
  void weigh() {
    double top = 0.0, bottom = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (noise_[a] <= 0.0) noise_[a] = rough_noise(a);
      solved_[a] = solve(a, false);
      double sum = 0.0, count = 0.0;
      for (const PacketObservation& s : axes_[a]) {
        if (std::abs(s.speed) > kStill) continue;
        sum += std::pow(s.error - row(a, s, false).dot(solved_[a].x), 2);
        ++count;
      }
      rest_[a] = static_cast<std::size_t>(count);
      if (count >= kFewestPackets) noise_[a] = std::max(1e-7, std::sqrt(sum / (count - 1.0)));
      if (moved_[a]) add_scatter(a, top, bottom);
    }
    if (bottom > 0.0) scatter_ = std::sqrt(std::max(0.0, top / bottom));
  }
  void add_scatter(std::size_t a, double& top, double& bottom) const {
    for (const PacketObservation& s : axes_[a]) {
      if (!moves(a, s)) continue;
      const double u = s.speed * s.speed, w = u / std::pow(variance(a, s), 2);
      const double left = s.error - row(a, s, false).dot(solved_[a].x);
      top += w * (left * left - noise_[a] * noise_[a]);
      bottom += w * u;
    }
  }
  double rough_noise(std::size_t a) const {
    std::vector<double> errors;
    for (const PacketObservation& s : axes_[a])
      if (std::abs(s.speed) <= kStill) errors.push_back(s.error);
    const double middle = median(errors);
    for (double& e : errors) e = std::abs(e - middle);
    return std::max(1e-6, 1.4826 * median(errors));
  }

  void drop_outliers() {
    for (std::size_t i = 0; i < index_.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        const PacketObservation& s = axes_[a][i];
        const double left = s.error - row(a, s, false).dot(solved_[a].x);
        if (std::abs(left) > kOutlier * std::sqrt(variance(a, s)) + 5e-6) left_out_[index_[i]] = true;
      }
  }

  // All axes together, weighted by their information, relative to the assumed age.
  [[nodiscard]] Interval common() const {
    double information = 0.0, sum = 0.0;
    Blocks all{std::vector<double>(blocks_, 0.0), std::vector<double>(blocks_, 0.0)};
    for (const LatencySolution& s : solved_) information += s.information;
    if (!(information > 0.0)) return {0.0, kUnset};
    for (const LatencySolution& s : solved_) {
      const double share = s.information / information;
      sum += share * s.x(kAge);
      for (std::size_t b = 0; b < blocks_; ++b) {
        all.influence[b] += share * s.blocks[kAge].influence[b];
        all.weight[b] += share * share * s.blocks[kAge].weight[b];
      }
    }
    return all.around(sum);
  }

  [[nodiscard]] bool agree(double shared) const {
    constexpr std::array<double, 3> kChance{0.0, 3.841, 5.991};  // chi-squared, 95 %, by freedom
    double sum = 0.0;
    std::size_t count = 0;
    for (const LatencySolution& s : solved_) {
      if (!s.used[kAge]) continue;
      sum += std::pow(s.x(kAge) - shared, 2) / s.blocks[kAge].variance();
      ++count;
    }
    return count < 2 || sum <= kChance[count - 1];
  }

  [[nodiscard]] Interval scatter() const {
    double top = 0.0, bottom = 0.0;
    Blocks all{std::vector<double>(blocks_, 0.0), std::vector<double>(blocks_, 0.0)};
    for (std::size_t a = 0; a < 3; ++a)
      if (moved_[a]) add_scatter(a, top, bottom);
    if (!(bottom > 0.0)) return {};
    const double square = std::max(0.0, top / bottom);
    for (std::size_t a = 0; a < 3; ++a)
      for (const PacketObservation& s : axes_[a]) {
        if (!moves(a, s)) continue;
        const double u = s.speed * s.speed, w = u / std::pow(variance(a, s), 2);
        const double left = s.error - row(a, s, false).dot(solved_[a].x);
        all.influence[s.block] += w * (left * left - noise_[a] * noise_[a] - u * square) / bottom;
        all.weight[s.block] += w * u;
      }
    const Interval i = all.around(square);
    return {std::sqrt(square), i.half / (2.0 * std::max(std::sqrt(square), std::sqrt(i.half) / 2.0))};
  }

  // Means of the stops; they differ if the bias depends on the position.
  void stops(std::size_t a, AxisLatency& axis) const {
    constexpr double kLongEnough = 0.3;  // s
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < axes_[a].size();) {
      double sum = 0.0;
      std::size_t j = i;
      while (j < axes_[a].size() && std::abs(axes_[a][j].speed) <= kStill &&
             (j == i || axes_[a][j].t - axes_[a][j - 1].t < kLongEnough))
        sum += axes_[a][j++].error;
      if (j > i && axes_[a][j - 1].t - axes_[a][i].t >= kLongEnough) {
        low = std::min(low, sum / static_cast<double>(j - i));
        high = std::max(high, sum / static_cast<double>(j - i));
        ++axis.stops;
      }
      i = std::max(j, i + 1);
    }
    if (axis.stops > 1) axis.places = high - low;
  }

  [[nodiscard]] AxisLatency axis(std::size_t a) const {
    AxisLatency out;
    const LatencySolution& s = solved_[a];
    out.latency = s.interval(kAge);
    out.latency.value += age_;
    out.bias = rest_[a] >= kFewestPackets || both_[a]
                   ? s.interval(rest_[a] >= kFewestPackets ? kRest : kMoving)
                   : Interval{};
    if (rest_[a] >= kFewestPackets) out.noise = noise_[a];
    out.travel = travel_(static_cast<Eigen::Index>(a));
    out.fastest = fastest_[a];
    out.moving = moved_[a] ? moving_[a] : 0;
    out.backwards = backwards_[a];
    out.one_way = moved_[a] && !both_[a];
    out.at_rest = rest_[a];
    stops(a, out);
    const ToolMotion tool =
        tool_motion(log_, path_, {*times_, age_, left_out_}, static_cast<Eigen::Index>(a));
    out.wander = tool.wander;
    out.adrift = !moved_[a] && tool.wander > std::max(kStill, 6.0 * tool.noise);
    if (out.adrift) out.bias = {}, out.noise = kUnset;
    if (moved_[a]) out.scale = tool.scale, out.unexplained = tool.unexplained;
    if (both_[a] && rest_[a] >= kFewestPackets) {
      Blocks change = s.blocks[kMoving];
      for (std::size_t b = 0; b < blocks_; ++b) {
        change.influence[b] -= s.blocks[kRest].influence[b];
        change.weight[b] += s.blocks[kRest].weight[b];
      }
      out.change = change.around(s.x(kMoving) - s.x(kRest));
    }
    if (speeds_differ(a)) out.step = solve(a, true).interval(kStep);
    return out;
  }

  // Only motion at several speeds separates a lag that does not grow with speed from latency.
  [[nodiscard]] bool speeds_differ(std::size_t a) const {
    if (!moved_[a]) return false;
    double slow = 0.0, fast = 0.0;
    for (const PacketObservation& s : axes_[a]) {
      if (!moves(a, s)) continue;
      if (std::abs(s.speed) > 0.85 * fastest_[a]) ++fast;
      if (std::abs(s.speed) > 0.2 * fastest_[a] && std::abs(s.speed) < 0.6 * fastest_[a]) ++slow;
    }
    return fast >= kFewestPackets && slow >= 0.2 * fast;
  }

  [[nodiscard]] LatencyFit result() const {
    LatencyFit out;
    for (std::size_t a = 0; a < 3; ++a) out.axes[a] = axis(a);
    const Interval shared = common();
    const bool moved = moved_[0] || moved_[1] || moved_[2];
    for (const AxisLatency& x : out.axes) out.carried = out.carried && (moved || !x.adrift);
    if (moved) {
      out.latency = {age_ + shared.value, shared.half};
      out.scatter = scatter();
      out.axes_agree = agree(shared.value);
      out.in_range = out.latency.value > kEarliest && out.latency.value < kLatest;
      for (std::size_t a = 0; a < 3; ++a)
        out.unexplained = std::fmax(out.unexplained, out.axes[a].unexplained);
    }
    out.packets = index_.size();
    out.outliers = static_cast<std::size_t>(std::count(left_out_.begin(), left_out_.end(), true));
    return out;
  }

  const TrackerLog& log_;
  TipPath path_;
  const std::vector<double>* times_ = nullptr;
  Vec3 travel_;
  double age_ = 0.0, scatter_ = 0.0;
  std::vector<bool> left_out_;
  std::vector<std::size_t> index_;  // packet of each entry of an axis
  std::array<Axis, 3> axes_;
  std::array<LatencySolution, 3> solved_;
  std::size_t blocks_ = 0;
  std::array<double, 3> noise_{}, fastest_{}, limit_{};
  std::array<std::size_t, 3> moving_{}, backwards_{}, rest_{};
  std::array<bool, 3> moved_{}, both_{};
};

// Repeats the fit with each packet at its stamp: the result is the stamps' error.
void compare_stamps(const TrackerLog& log, LatencyFit& fit) {
  std::vector<double> stamps, ages;
  for (const TrackerPacket& packet : log.packets) {
    if (std::isnan(packet.stamp)) return;
    stamps.push_back(packet.stamp);
    ages.push_back(packet.time - packet.stamp);
  }
  double mean = 0.0, square = 0.0;
  for (const double age : ages) mean += age / static_cast<double>(ages.size());
  for (const double age : ages) square += std::pow(age - mean, 2) / static_cast<double>(ages.size());
  fit.stamp_age = {mean, 2.0 * std::sqrt(square)};
  if (mean < kEarliest || mean > kLatest || !fit.latency.known()) return;
  fit.stamp_error = Fit(log).run(stamps).latency;
}

}  // namespace

LatencyFit fit_latency(const TrackerLog& log) {
  std::vector<double> times;
  times.reserve(log.packets.size());
  for (const TrackerPacket& packet : log.packets) times.push_back(packet.time);
  LatencyFit fit = Fit(log).run(times);
  compare_stamps(log, fit);
  return fit;
}

}  // namespace enc::models
