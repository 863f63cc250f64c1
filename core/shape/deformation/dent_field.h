// The one formula of the deformation, for one point, in double for the core and in float for drawing.
// Internal to dent.cpp and dent_array.cpp.
#pragma once

#include <cmath>

#include "core/shape/deformation/dent.h"

namespace enc::detail {

template <class T>
struct Shift {
  T by;          // displacement against n, m
  T gx, gy, gz;  // its gradient
};

// Displacement of a sinking ball, without the tip: by = s (1 - |c|^2 / L^2)^3.
template <class T>
inline Shift<T> sinking(const DentField<T>& f, T x, T y, T z) noexcept {
  const T cx = x - f.contact[0];
  const T cy = y - f.contact[1];
  const T cz = z - f.contact[2];
  const T inside = T(1) - (cx * cx + cy * cy + cz * cz) * f.narrow;
  const T t = inside > T(0) ? inside : T(0);
  const T part = f.sink * (t * t);
  const T slope = T(-6) * f.narrow * part;
  return {part * t, slope * cx, slope * cy, slope * cz};
}

// Finds the ball of the edge that is lowest at a place w beside n: its surface has the edge's own slope.
// Returns its place along the edge, m.
template <class T>
inline T lowest_on_edge(const DentField<T>& f, T wx, T wy, T wz) noexcept {
  const T r2 = f.radius * f.radius;
  const T t = wx * f.along[0] + wy * f.along[1] + wz * f.along[2];
  const T all = wx * wx + wy * wy + wz * wz - t * t;
  const T side2 = all > T(0) ? all : T(0);
  const T under = r2 > side2 ? r2 - side2 : T(0);
  const T ahead = f.lean * std::sqrt(under);
  const T ahead_cone = f.lean_cone * std::sqrt(side2);
  const T wanted = t - (ahead * ahead + side2 <= f.cap2 ? ahead : ahead_cone);
  const T above = wanted > f.from ? wanted : f.from;
  return above < f.to ? above : f.to;
}

// Every branch can become a selection, so the compiler vectorises the loop over arrays.
template <bool kEdge, class T>
inline Shift<T> shift(const DentField<T>& f, T x, T y, T z) noexcept {
  const T px = x - f.origin[0];
  const T py = y - f.origin[1];
  const T pz = z - f.origin[2];
  const T h = px * f.n[0] + py * f.n[1] + pz * f.n[2];
  T wx = px - h * f.n[0];
  T wy = py - h * f.n[1];
  T wz = pz - h * f.n[2];
  const Shift<T> ball = sinking(f, x, y, z);
  const T r2 = f.radius * f.radius;
  T low = T(0);
  if constexpr (kEdge) {
    const T at = lowest_on_edge(f, wx, wy, wz);
    wx -= at * f.along[0];
    wy -= at * f.along[1];
    wz -= at * f.along[2];
    low = at * f.rise;
  }
  const T w2 = wx * wx + wy * wy + wz * wz;
  const bool round = w2 <= f.cap2;
  const T root = std::sqrt(round ? r2 - w2 : w2);
  const T boundary = low + (round ? f.radius - root : f.cone + f.slope * root);
  const T steep = (round ? T(1) : f.slope) / root;
  const T v = h - ball.by - boundary;
  // u = b t^4 up to v = b, then v itself; t = (v + 3b) / 4b.
  const T per_width = T(1) / (T(4) * f.blend);  // equal for all points
  const T wide = (v + T(3) * f.blend) * per_width;
  const T positive = wide > T(0) ? wide : T(0);
  const T t = positive < T(1) ? positive : T(1);
  const T beyond = v > f.blend ? v - f.blend : T(0);
  const T share = t * t * t;  // du/dv: 1 on the tip
  const T rest = T(1) - share;
  const T side = -share * steep;
  return {ball.by + f.blend * (t * t) * (t * t) + beyond,  //
          rest * ball.gx + share * f.n[0] + side * wx,     //
          rest * ball.gy + share * f.n[1] + side * wy,     //
          rest * ball.gz + share * f.n[2] + side * wz};
}

}  // namespace enc::detail
