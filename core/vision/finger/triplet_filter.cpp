#include "core/vision/finger/triplet_filter.h"

namespace enc {

void TripletFilter::begin(const TrackSpec& spec, Time t, const Triplet& at, const Vec3& variance) {
  const Vec3 place = at.e();
  for (int i = 0; i < 3; ++i) {
    const double speed = i < 2 ? spec.start_speed : spec.start_disparity_speed;
    axes_[static_cast<std::size_t>(i)] = {place[i], 0.0, variance[i], 0.0, speed * speed};
  }
  t_ = t;
  known_ = true;
}

void TripletFilter::predict(const TrackSpec& spec, Time t) {
  const double h = age(t, t_);
  for (std::size_t i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    const double noise = i < 2 ? spec.acceleration_noise : spec.disparity_acceleration_noise;
    const double q = noise * noise;
    axis.x += h * axis.v;
    axis.xx += h * (2.0 * axis.xv + h * axis.vv) + q * h * h * h / 3.0;
    axis.xv += h * axis.vv + q * h * h / 2.0;
    axis.vv += q * h;
  }
  t_ = t;
}

double TripletFilter::surprise(const Triplet& at, const Vec3& variance) const {
  const Vec3 off = at.e() - this->at().e();
  return off.cwiseProduct(off).cwiseQuotient(variance + this->variance()).sum();
}

void TripletFilter::correct(const Triplet& at, const Vec3& variance) {
  const Vec3 found = at.e();
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double s = axis.xx + variance[i];
    const double kx = axis.xx / s, kv = axis.xv / s;
    const double off = found[i] - axis.x;
    axis.x += kx * off;
    axis.v += kv * off;
    axis.vv -= kv * axis.xv;
    axis.xv *= 1.0 - kx;
    axis.xx *= 1.0 - kx;
  }
}

}  // namespace enc
