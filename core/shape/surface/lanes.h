// Eight floats side by side, as generic vectors of the compiler: two SSE registers on any x86-64, so that
// every machine computes the same bits.
#pragma once

#include <cstring>

namespace enc {

struct Lanes {
  using Four = float __attribute__((vector_size(16)));
  using Bits = int __attribute__((vector_size(16)));
  Four lo, hi;

  static Lanes all(float x) { return {Four{x, x, x, x}, Four{x, x, x, x}}; }
  // Loads and stores eight consecutive floats.
  static Lanes load(const float* p) {
    Lanes x;
    std::memcpy(&x, p, sizeof x);
    return x;
  }
  void store(float* p) const { std::memcpy(p, this, sizeof *this); }
  friend Lanes operator+(Lanes a, Lanes b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.lo * b.lo, a.hi * b.hi}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {a.lo / b.lo, a.hi / b.hi}; }
  friend Lanes min(Lanes a, Lanes b) { return {a.lo < b.lo ? a.lo : b.lo, a.hi < b.hi ? a.hi : b.hi}; }
  friend Lanes max(Lanes a, Lanes b) { return {a.lo > b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi}; }

  // One truth value for each lane.
  struct Mask {
    Bits lo, hi;
    friend Mask operator&(Mask a, Mask b) { return {a.lo & b.lo, a.hi & b.hi}; }
    // Bit i is lane i.
    [[nodiscard]] unsigned bits() const {
#ifdef __SSE2__
      return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Four>(lo)) |
                                   (__builtin_ia32_movmskps(reinterpret_cast<Four>(hi)) << 4));
#else
      unsigned set = 0;
      for (int i = 0; i < 4; ++i) set |= (lo[i] != 0 ? 1U << i : 0U) | (hi[i] != 0 ? 16U << i : 0U);
      return set;
#endif
    }
  };
  friend Mask operator<=(Lanes a, Lanes b) { return {a.lo <= b.lo, a.hi <= b.hi}; }
  // 0 in lanes where the mask is true, else `a`.
  friend Lanes unless(Mask yes, Lanes a) {
    const Four zero{};
    return {yes.lo ? zero : a.lo, yes.hi ? zero : a.hi};
  }
};

}  // namespace enc
