#include "models/directions/directions.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "models/files.h"
#include "models/least_squares.h"
#include "models/schema/schema.h"
#include "models/schema/toml_reader.h"

namespace enc::models {
namespace {

double angle(double cosine) { return std::acos(std::clamp(cosine, 0.0, 1.0)); }

void add(std::vector<double>& sum, const std::vector<double>& part, double weight) {
  sum.resize(std::max(sum.size(), part.size()), 0.0);
  for (std::size_t i = 0; i < part.size(); ++i) sum[i] += weight * part[i];
}

constexpr Range kQuarter{0.0, 90.0};

void describe(Visitor& v, std::int64_t& format, std::vector<Direction>& directions) {
  const auto key = [](std::string_view name, std::string_view meaning, Range range) {
    return Key{name, meaning, "docs/notes/indentation.md", Confidence::derived, range, Presence::needed,
               {},   true};
  };
  v.value(key("format", "version of this format; this program reads version 1", {1.0, 1.0}), &format);
  directions.resize(v.open_list("direction", directions.size()));
  for (std::size_t i = 0; i < directions.size(); ++i) {
    Direction& d = directions[i];
    v.open_entry("direction", i, d.name);
    v.value(key("name", "name of the push", kAny), &d.name);
    v.value(key("response", "file in models/responses without .toml, fitted to these pushes", kAny),
            &d.response);
    v.value(key("location_deg", "angle between the surface normal at the touch and the vertical", kQuarter),
            &d.location);
    v.value(key("slant_deg", "angle between the push axis and that normal", kQuarter), &d.slant);
    v.close();
  }
}

}  // namespace

std::vector<Direction> read_directions(const std::string& text, const std::string& path) {
  std::int64_t format = 1;
  std::vector<Direction> directions;
  read_toml(text, path, [&](Visitor& visitor) { describe(visitor, format, directions); });
  if (directions.empty())
    throw Error(path +
                ":1:1: there is no direction; expected one [[direction]] or more; add what was measured");
  return directions;
}

std::vector<Direction> load_directions(const std::string& path) {
  constexpr std::size_t kLongest = 1U << 20U;  // bytes
  std::string why;
  const std::string text = read_file(path, kLongest, why);
  if (!why.empty())
    throw Error(path + ":1:1: cannot read these directions; expected a TOML file; restore it");
  return read_directions(text, path);
}

PressWay planned_way(const SceneSpec& scene) {
  const UserSpec& user = *scene.user;
  const Vec3 axis(std::sin(user.polar) * std::cos(user.azimuth),
                  std::sin(user.polar) * std::sin(user.azimuth), std::cos(user.polar));
  return way_of(axis, press_point(scene, user).normal.e());
}

bool presses_sphere(const SceneSpec& scene, const std::string& behaviour) {
  const std::string& name = scene.user->object;
  const auto at = std::find_if(scene.objects.begin(), scene.objects.end(),
                               [&](const ObjectSpec& o) { return name.empty() || o.name == name; });
  return at != scene.objects.end() && at->behaviour == behaviour && at->shape == ShapeKind::sphere;
}

PressWay way_of(const Vec3& axis, const Vec3& normal) {
  return {angle(std::abs(normal.z())), angle(axis.dot(normal))};
}

std::vector<double> weights(const std::vector<Direction>& directions, const PressWay& way) {
  const auto n = static_cast<Eigen::Index>(directions.size());
  Eigen::MatrixXd angles(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Direction& d = directions[static_cast<std::size_t>(i)];
    angles.col(i) << d.location, d.slant;
  }
  const double scale = std::max(1e-6, angles.cwiseAbs().maxCoeff());
  angles /= scale;
  // The sum is 1: a third row of far greater weight. The last term prefers even weights if several sets fit.
  constexpr double kSum = 1e4, kEven = 1e-6;
  const Eigen::RowVectorXd ones = Eigen::RowVectorXd::Ones(n);
  Quadratic q;
  q.gram = angles.transpose() * angles + kSum * ones.transpose() * ones;
  q.gram.diagonal().array() += kEven;
  q.moment = angles.transpose() * Eigen::Vector2d(way.location, way.slant) / scale + kSum * ones.transpose();
  const Eigen::VectorXd x =
      constrained_minimum(q, {Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n)}, 1e-12)
          .cwiseMax(0.0);
  const Eigen::VectorXd normalised = x / x.sum();
  return {normalised.data(), normalised.data() + n};
}

ResponseSpec mixed(const std::vector<ResponseSpec>& parts, const std::vector<double>& weights) {
  ResponseSpec sum;
  sum.limit = parts.front().limit;
  const bool stops =
      std::all_of(parts.begin(), parts.end(), [](const ResponseSpec& p) { return p.stops.has_value(); });
  if (stops) sum.stops = StopsSpec{{}, parts.front().stops->radii, {}};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ResponseSpec& part = parts[i];
    if (part.limit != sum.limit) throw Error("responses to be mixed end at different deflections", "limit");
    for (std::size_t k = 0; k < 4; ++k) {
      sum.press[k] += weights[i] * part.press[k];
      sum.release[k] += weights[i] * part.release[k];
    }
    if (!stops) continue;
    if (part.stops->radii != sum.stops->radii)
      throw Error("responses to be mixed have stops of different radii", "stops");
    add(sum.stops->curve, part.stops->curve, weights[i]);
    add(sum.stops->weights, part.stops->weights, weights[i]);
  }
  return sum;
}

}  // namespace enc::models
