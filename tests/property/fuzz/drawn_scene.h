// Scenes drawn at random, of both machines, with rigs that go with them.
#pragma once

#include <random>
#include <string>

#include "core/control/scene/scene.h"

namespace enc::test {

struct Random {
  std::mt19937_64 engine;
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  Vec3 vec(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  bool once_in(unsigned n) { return engine() % n == 0; }
  std::size_t of(std::size_t n) { return static_cast<std::size_t>(engine() % n); }
};

struct Drawn {
  std::string what;
  Scene scene;
};
[[nodiscard]] Drawn draw_scene(std::uint64_t seed, Random& random);

}  // namespace enc::test
