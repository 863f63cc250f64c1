#include "sim/camera/scenery.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "sim/camera/hand.h"
#include "sim/camera/stage.h"
#include "sim/truth/random.h"

namespace enc::sim {
namespace {

// Textures made in code, by seed, for the things of a scenery and the skin of a hand.
struct Texture {
  int side = 0;  // px; square
  std::vector<std::uint8_t> rgb;
  explicit Texture(int pixels)
      : side(pixels), rgb(3 * static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels)) {}
  void set(int x, int y, const Rgb& colour);
};

// Noise of several octaves on a torus, about -1 to 1.
class Clouds {
 public:
  explicit Clouds(Stream& random) : grid_(kGrid * kGrid) {
    for (float& g : grid_) g = static_cast<float>(2.0 * random.uniform() - 1.0);
  }
  // x and y in periods of the torus; `cells`: cells of the coarsest noise along each.
  [[nodiscard]] double at(double x, double y, int cells, int octaves) const {
    double sum = 0.0, weight = 1.0;
    for (int i = 0; i < octaves; ++i, cells *= 2, weight *= 0.5) sum += weight * smooth(x, y, cells, 7 * i);
    return sum;
  }

 private:
  static constexpr int kGrid = 256;
  [[nodiscard]] double smooth(double x, double y, int cells, int offset) const {
    const double gx = x * cells, gy = y * cells;
    const int ix = static_cast<int>(std::floor(gx)), iy = static_cast<int>(std::floor(gy));
    const double fx = ease(gx - ix), fy = ease(gy - iy);
    const auto corner = [&](int i, int j) {
      const int cx = (((ix + i) % cells + cells) % cells + offset) % kGrid;
      const int cy = (((iy + j) % cells + cells) % cells + offset) % kGrid;
      return static_cast<double>(grid_[static_cast<std::size_t>(cy * kGrid + cx)]);
    };
    return (1 - fy) * ((1 - fx) * corner(0, 0) + fx * corner(1, 0)) +
           fy * ((1 - fx) * corner(0, 1) + fx * corner(1, 1));
  }
  static double ease(double t) { return t * t * (3.0 - 2.0 * t); }
  std::vector<float> grid_;
};

Rgb mixed(const Rgb& a, const Rgb& b, double share) {
  const auto s = static_cast<float>(share);
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

template <class Colour>
Texture painted(int side, const Colour& colour) {
  Texture t(side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) t.set(x, y, colour((x + 0.5) / side, (y + 0.5) / side));
  return t;
}

void fill(Texture& t, double x0, double y0, double x1, double y1, const Rgb& colour) {
  const auto px = [&](double v) { return std::clamp(static_cast<int>(v * t.side), 0, t.side); };
  for (int y = px(y0); y < px(y1); ++y)
    for (int x = px(x0); x < px(x1); ++x) t.set(x, y, colour);
}

void write_lines(Stream& random, Texture& t, double x0, double y0, double x1, double y1, double line,
                 const Rgb& ink) {
  const auto lines = static_cast<int>(std::ceil((y1 - line - y0) / (1.8 * line)));
  for (int i = 0; i < lines; ++i) {
    const double y = y0 + 1.8 * line * i;
    const double end = x1 - 0.4 * random.uniform() * (x1 - x0);
    double x = x0;
    while (x < end) {
      const double word = line * (1.0 + 4.0 * random.uniform());
      fill(t, x, y, std::min(x + word, end), y + 0.8 * line, ink);
      x += word + 0.8 * line;
    }
  }
}

bool within(double x, double y, double cx, double cy, double rx, double ry) {
  return (x - cx) * (x - cx) / (rx * rx) + (y - cy) * (y - cy) / (ry * ry) < 1.0;
}

void Texture::set(int x, int y, const Rgb& colour) {
  std::uint8_t* to = rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                                       static_cast<std::size_t>(x));
  for (std::size_t c = 0; c < 3; ++c)
    to[c] = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(colour[c], 0.0F, 1.0F)));
}

// Hue in degrees, saturation and value 0 to 1.
Rgb of_hue(double hue, double saturation, double value) {
  const auto channel = [&](double n) {
    const double k = std::fmod(n + hue / 60.0, 6.0);
    return static_cast<float>(value * (1.0 - saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

// Any hue far from that of skin: 70 to 325 degrees, i.e. 20 degrees away from 345 to 50.
Rgb cool_colour(Stream& random, double saturation, double value) {
  return of_hue(70.0 + 255.0 * random.uniform(), saturation, value);
}

// The colour times a factor.
Rgb shaded(const Rgb& colour, double by) {
  const auto b = static_cast<float>(by);
  return {b * colour[0], b * colour[1], b * colour[2]};
}

Texture plaster(Stream& random, const Rgb& colour, double grain, int side = 512) {
  const Clouds clouds(random);
  return painted(side, [&](double x, double y) {
    return shaded(colour, 1.0 + 0.05 * clouds.at(x, y, 2, 3) + grain * clouds.at(y, x, 128, 2));
  });
}

Texture wood(Stream& random, const Rgb& light, const Rgb& dark) {
  const Clouds clouds(random);
  return painted(512, [&](double x, double y) {
    const double ring = 9.0 * y + 1.6 * clouds.at(x, y, 2, 3) + 0.15 * clouds.at(0.1 * x, y, 64, 2);
    const double grain = ring - std::floor(ring);
    return shaded(mixed(light, dark, grain * grain), 1.0 + 0.08 * clouds.at(0.2 * x, y, 128, 1));
  });
}

// Cloth, keys, card.
Texture weave(Stream& random, const Rgb& colour) {
  const Clouds clouds(random);
  return painted(128, [&](double x, double y) {
    const int thread = static_cast<int>(64 * x) + static_cast<int>(64 * y);
    return shaded(colour, (thread % 2 == 0 ? 1.0 : 0.82) * (1.0 + 0.12 * clouds.at(x, y, 4, 3)));
  });
}

// Lines of words.
Texture text(Stream& random, const Rgb& paper, const Rgb& ink) {
  Texture t(256);
  fill(t, 0, 0, 1, 1, paper);
  write_lines(random, t, 0.10, 0.08, 0.62, 0.13, 0.035, ink);
  write_lines(random, t, 0.10, 0.19, 0.92, 0.93, 0.018, ink);
  return t;
}

// The windows of a computer.
Texture screen(Stream& random) {
  Texture t(256);
  fill(t, 0, 0, 1, 1, {0.03F, 0.03F, 0.035F});
  fill(t, 0.03, 0.04, 0.97, 0.96, cool_colour(random, 0.6, 0.35));
  for (int i = 0; i < 3; ++i) {
    const double x = 0.07 + 0.4 * random.uniform(), y = 0.08 + 0.35 * random.uniform();
    const double wide = 0.3 + 0.15 * random.uniform(), high = 0.3 + 0.15 * random.uniform();
    fill(t, x, y, x + wide, y + high, {0.85F, 0.88F, 0.90F});
    fill(t, x, y, x + wide, y + 0.035, cool_colour(random, 0.7, 0.5));
    write_lines(random, t, x + 0.02, y + 0.06, x + wide - 0.02, y + high - 0.01, 0.016, {0.1F, 0.12F, 0.15F});
  }
  return t;
}

// A picture with colours from green to blue only: from afar colours mix, and yellow with purple would give
// the hue of skin.
Texture patches(Stream& random, double saturation) {
  const auto colour = [&](double share, double value) {
    return of_hue(90.0 + 160.0 * random.uniform(), share, value);
  };
  Texture t(256);
  fill(t, 0, 0, 1, 1, colour(0.5 * saturation, 0.8));
  for (int i = 0; i < 60; ++i) {
    const double x = random.uniform(), y = random.uniform();
    const double wide = 0.02 + 0.2 * random.uniform(), high = 0.02 + 0.2 * random.uniform();
    const double value = 0.15 + 0.7 * random.uniform();
    fill(t, x, y, x + wide, y + high, colour(saturation * random.uniform(), value));
  }
  return t;
}

// A poster of a face.
Texture face(Stream& random) {
  const Clouds clouds(random);
  const Rgb complexion = of_hue(14.0 + 8.0 * random.uniform(), 0.55, 0.62);
  const Rgb wall = of_hue(30.0, 0.35, 0.75);
  return painted(256, [&](double x, double y) -> Rgb {
    const double shade = 1.0 + 0.10 * clouds.at(x, y, 3, 2);
    if (within(x, y, 0.40, 0.45, 0.045, 0.022) || within(x, y, 0.60, 0.45, 0.045, 0.022))
      return {0.06F, 0.04F, 0.03F};
    if (within(x, y, 0.50, 0.67, 0.085, 0.025)) return {0.45F, 0.12F, 0.10F};
    if (within(x, y, 0.50, 0.50, 0.22, 0.31))
      return shaded(complexion, shade * (1.15 - 0.5 * std::abs(x - 0.45)));
    if (within(x, y, 0.50, 0.42, 0.27, 0.36)) return {0.10F, 0.06F, 0.03F};
    if (within(x, y, 0.50, 1.00, 0.42, 0.22)) return shaded({0.16F, 0.22F, 0.42F}, shade);
    if (within(x, y, 0.50, 0.80, 0.09, 0.16)) return shaded(complexion, 0.85 * shade);
    return shaded(wall, shade);
  });
}

// Factors on the colour of skin: blotches, creases, pores. The amount of blood differs from place to place,
// so red varies less than green and blue.
Texture skin(Stream& random) {
  const Clouds clouds(random);
  return painted(128, [&](double x, double y) -> Rgb {
    const double blotch = clouds.at(x, y, 4, 3), fine = clouds.at(y, x, 48, 2);
    const double lightness = 0.93 + 0.035 * blotch + 0.03 * fine, redness = 0.030 * clouds.at(y, x, 6, 2);
    return {static_cast<float>(lightness + redness), static_cast<float>(lightness - redness),
            static_cast<float>(lightness - 1.3 * redness)};
  });
}

// A room: x to the right, y away from the camera, z up. The camera looks down by a few degrees.
class Room {
 public:
  Room(Scenery kind, std::uint64_t seed) : random_(seed, "scenery"), kind_(kind), spec_(mj_makeSpec()) {
    if (!spec_) throw Error("not enough memory for a scenery", {}, ErrorKind::device);
    mjsBody* world = mjs_findBody(spec_.get(), "world");
    body_ = mjs_addBody(world, nullptr);
    const double down = 0.28 + 0.08 * random_.uniform();  // rad
    // Room's x, y, z in C.
    Mat3 axes;
    axes.col(0) = Vec3(1, 0, 0);
    axes.col(1) = Vec3(0, -std::sin(down), std::cos(down));
    axes.col(2) = Vec3(0, -std::cos(down), -std::sin(down));
    const Quat q(axes);
    const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
    std::copy_n(wxyz, 4, body_->quat);
    desk_ = -0.72 - 0.06 * random_.uniform();
    wall_ = 2.05 + 0.25 * random_.uniform();
  }

  SpecPtr spec() && { return std::move(spec_); }
  void furnish();
  void template_of_hand();

 private:
  Rgb colour(double saturation, double value) {
    if (kind_ == Scenery::skin_hued) return of_hue(12.0 + 26.0 * random_.uniform(), saturation, value);
    return cool_colour(random_, saturation, value);
  }
  [[nodiscard]] double between(double low, double high) { return low + (high - low) * random_.uniform(); }

  std::string material(const Texture& texture, bool cube, double repeat = 1.0);
  mjsGeom* thing(mjtGeom type, const Vec3& at, const Vec3& half, const std::string& material);
  void turn(mjsGeom* geom, double angle);  // about the vertical
  void to_viewer(mjsGeom* geom);

  void walls();
  void monitor(double x, double y);
  void books(double x, double y, int count);
  void papers(int count);
  void cables(int count);
  void small_things(int count);
  void on_wall();
  void boxes(int count);

  Stream random_;
  Scenery kind_;
  SpecPtr spec_;
  mjsBody* body_ = nullptr;
  double desk_ = 0, wall_ = 0;  // m
  int materials_ = 0;
};

std::string Room::material(const Texture& texture, bool cube, double repeat) {
  const std::string name = "m" + std::to_string(materials_++);
  mjsTexture* t = mjs_addTexture(spec_.get(), nullptr);
  mjs_setName(t->element, name.c_str());
  t->type = cube ? mjTEXTURE_CUBE : mjTEXTURE_2D;
  t->width = texture.side;
  t->height = cube ? 6 * texture.side : texture.side;
  t->nchannel = 3;
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < (cube ? 6 : 1); ++i)
    pixels.insert(pixels.end(), texture.rgb.begin(), texture.rgb.end());
  mjs_setBuffer(t->data, pixels.data(), static_cast<int>(pixels.size()));
  mjsMaterial* m = mjs_addMaterial(spec_.get(), nullptr);
  mjs_setName(m->element, name.c_str());
  mjs_setInStringVec(m->textures, mjTEXROLE_RGB, name.c_str());
  m->texrepeat[0] = m->texrepeat[1] = static_cast<float>(repeat);
  m->specular = 0.0F;
  m->shininess = 0.0F;
  m->reflectance = 0.0F;
  return name;
}

mjsGeom* Room::thing(mjtGeom type, const Vec3& at, const Vec3& half, const std::string& material) {
  mjsGeom* geom = mjs_addGeom(body_, nullptr);
  geom->type = type;
  std::copy_n(at.data(), 3, geom->pos);
  std::copy_n(half.data(), 3, geom->size);
  geom->contype = geom->conaffinity = 0;
  geom->mass = 0;
  mjs_setString(geom->material, material.c_str());
  return geom;
}

void Room::turn(mjsGeom* geom, double angle) {
  geom->quat[0] = std::cos(0.5 * angle);
  geom->quat[3] = std::sin(0.5 * angle);
}

// A 2D texture lies on the geom's own x and y: here x to the right, y up, z to the camera.
void Room::to_viewer(mjsGeom* geom) {
  geom->quat[0] = std::numbers::sqrt2 / 2;
  geom->quat[1] = std::numbers::sqrt2 / 2;
}

void Room::walls() {
  const bool warm = kind_ == Scenery::skin_hued;
  const Rgb paint = warm ? of_hue(28.0 + 8.0 * random_.uniform(), 0.38, 0.78)
                         : cool_colour(random_, 0.10 + 0.08 * random_.uniform(), 0.72);
  to_viewer(thing(mjGEOM_BOX, {0, wall_ + 0.05, 0.2}, {2.2, 1.6, 0.05},
                  material(plaster(random_, paint, 0.03), false)));
  const Texture top = warm ? wood(random_, of_hue(26, 0.60, 0.58), of_hue(20, 0.72, 0.30))
                           : plaster(random_, cool_colour(random_, 0.14, between(0.35, 0.62)), 0.04);
  thing(mjGEOM_BOX, {0, 0.5 * (0.75 + wall_), desk_ - 0.02}, {2.2, 0.5 * (wall_ - 0.75), 0.02},
        material(top, false));
}

void Room::monitor(double x, double y) {
  const std::string frame = material(plaster(random_, {0.05F, 0.05F, 0.055F}, 0.02, 64), true);
  const double half_wide = between(0.22, 0.28), half_high = 0.6 * half_wide,
               middle = desk_ + 0.10 + half_high;
  const double turned = between(-0.25, 0.25);
  turn(thing(mjGEOM_BOX, {x, y, middle}, {half_wide + 0.012, 0.015, half_high + 0.012}, frame), turned);
  mjsGeom* glass = thing(mjGEOM_BOX, {x + 0.014 * std::sin(turned), y - 0.014 * std::cos(turned), middle},
                         {half_wide, half_high, 0.003}, material(screen(random_), false));
  const Quat q = Quat(Eigen::AngleAxisd(turned, Vec3::UnitZ())) *
                 Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(wxyz, 4, glass->quat);
  thing(mjGEOM_BOX, {x, y + 0.02, desk_ + 0.07}, {0.03, 0.01, 0.07}, frame);
  thing(mjGEOM_CYLINDER, {x, y, desk_ + 0.006}, {0.10, 0.006, 0}, frame);
  mjsGeom* keys = thing(mjGEOM_BOX, {x + between(-0.05, 0.05), y - 0.28, desk_ + 0.010}, {0.21, 0.065, 0.010},
                        material(weave(random_, {0.12F, 0.12F, 0.13F}), true));
  turn(keys, between(-0.15, 0.15));
}

void Room::books(double x, double y, int count) {
  for (int i = 0; i < count; ++i) {
    const double half_thick = between(0.010, 0.026), half_high = between(0.09, 0.135);
    x += half_thick + 0.0015;
    const Rgb cover = colour(between(0.35, 0.85), between(0.15, 0.6));
    turn(thing(mjGEOM_BOX, {x, y, desk_ + half_high}, {half_thick, 0.085, half_high},
               material(text(random_, cover, shaded({0.9F, 0.9F, 0.88F}, between(0.1, 1.0))), true)),
         between(-0.02, 0.02));
    x += half_thick;
  }
}

void Room::papers(int count) {
  for (int i = 0; i < count; ++i) {
    const Rgb paper = kind_ == Scenery::skin_hued ? of_hue(32, 0.30, 0.82) : Rgb{0.84F, 0.85F, 0.86F};
    turn(thing(mjGEOM_BOX, {between(-0.75, 0.75), between(1.15, wall_ - 0.35), desk_ + 0.001 + 0.0007 * i},
               {0.105, 0.148, 0.0006}, material(text(random_, paper, {0.08F, 0.08F, 0.09F}), false)),
         between(-0.9, 0.9));
  }
}

void Room::cables(int count) {
  const std::string black = material(weave(random_, {0.06F, 0.06F, 0.065F}), true);
  for (int i = 0; i < count; ++i) {
    Vec3 at(between(-0.7, 0.7), wall_ - 0.08, desk_ + 0.004);
    double heading = between(-2.6, -0.6);
    for (int j = 0; j < 7; ++j) {
      const Vec3 to = at + 0.09 * Vec3(std::cos(heading), std::sin(heading), 0);
      mjsGeom* piece = thing(mjGEOM_CAPSULE, {0, 0, 0}, {0.0035, 0, 0}, black);
      std::copy_n(at.data(), 3, piece->fromto);
      std::copy_n(to.data(), 3, piece->fromto + 3);
      at = to;
      heading += between(-0.6, 0.6);
    }
  }
}

void Room::small_things(int count) {
  for (int i = 0; i < count; ++i) {
    const Vec3 at(between(-0.8, 0.8), between(1.15, wall_ - 0.2), desk_);
    const std::string look = material(patches(random_, between(0.2, 0.9)), true);
    const int kind = static_cast<int>(4.0 * random_.uniform());
    const double size = between(0.02, 0.05);
    if (kind == 0)
      thing(mjGEOM_CYLINDER, at + Vec3(0, 0, size), {0.8 * size, size, 0},
            material(plaster(random_, colour(between(0.3, 0.9), between(0.2, 0.7)), 0.02, 64), true));
    else if (kind == 1)
      thing(mjGEOM_ELLIPSOID, at + Vec3(0, 0, 0.4 * size), {0.6 * size, size, 0.4 * size},
            material(plaster(random_, {0.10F, 0.10F, 0.11F}, 0.02, 64), true));
    else
      turn(thing(mjGEOM_BOX, at + Vec3(0, 0, 0.5 * size), {1.5 * size, size, 0.5 * size}, look),
           between(-1.5, 1.5));
  }
}

void Room::on_wall() {
  const bool warm = kind_ == Scenery::skin_hued;
  const double y = wall_ - 0.004;
  const double x = between(0.25, 0.6) * (random_.uniform() < 0.5 ? -1 : 1);
  to_viewer(thing(mjGEOM_BOX, {x, y, desk_ + between(0.50, 0.60)}, {0.19, 0.25, 0.003},
                  material(warm ? face(random_) : patches(random_, 0.5), false)));
  to_viewer(
      thing(mjGEOM_BOX, {-x, y, desk_ + between(0.45, 0.55)}, {0.35, 0.22, 0.003},
            material(text(random_, warm ? of_hue(34, 0.3, 0.8) : Rgb{0.80F, 0.82F, 0.84F}, colour(0.7, 0.3)),
                     false)));
}

void Room::boxes(int count) {
  for (int i = 0; i < count; ++i) {
    const Vec3 half(between(0.03, 0.12), between(0.03, 0.10), between(0.02, 0.12));
    const Vec3 at(between(-0.9, 0.9), between(1.2, wall_ - 0.1), desk_ + half.z());
    const Rgb hue = colour(between(0.3, 0.65), between(0.25, 0.7));
    const double kind = random_.uniform();
    turn(thing(mjGEOM_BOX, at, half,
               material(kind < 0.4                    ? weave(random_, hue)
                        : kind < 0.7                  ? text(random_, hue, shaded(hue, 0.35))
                        : kind_ == Scenery::skin_hued ? wood(random_, hue, shaded(hue, 0.5))
                                                      : patches(random_, 0.9),
                        true)),
         between(-1.5, 1.5));
  }
}

void Room::furnish() {
  walls();
  on_wall();
  const double side = random_.uniform() < 0.5 ? -1.0 : 1.0;
  monitor(side * between(0.12, 0.30), wall_ - 0.35);
  books(-side * between(0.25, 0.5) - 0.2, wall_ - 0.12, 7 + static_cast<int>(4 * random_.uniform()));
  papers(kind_ == Scenery::clutter ? 8 : 4);
  cables(kind_ == Scenery::clutter ? 6 : 2);
  small_things(kind_ == Scenery::clutter ? 16 : 5);
  if (kind_ != Scenery::office) boxes(kind_ == Scenery::clutter ? 24 : 9);
}

// Templates behind the camera; a HandDrawing copies them.
void Room::template_of_hand() {
  const auto hidden = [&](const char* name, const std::string& look, const HandMesh& shape) {
    mjsMesh* mesh = mjs_addMesh(spec_.get(), nullptr);
    mjs_setName(mesh->element, name);
    mjs_setFloat(mesh->uservert, shape.vertices.data(), static_cast<int>(shape.vertices.size()));
    mjs_setFloat(mesh->usernormal, shape.normals.data(), static_cast<int>(shape.normals.size()));
    mjs_setInt(mesh->userface, shape.faces.data(), static_cast<int>(shape.faces.size()));
    mjs_setInt(mesh->userfacenormal, shape.faces.data(), static_cast<int>(shape.faces.size()));
    mesh->inertia = mjMESH_INERTIA_SHELL;
    mjs_asMaterial(mjs_findElement(spec_.get(), mjOBJ_MATERIAL, look.c_str()))->texuniform = true;
    mjsGeom* geom = thing(mjGEOM_MESH, {0, -5, 0}, {0, 0, 0}, look);
    mjs_setString(geom->meshname, name);
    mjs_setName(geom->element, name);
  };
  const std::string bare = material(skin(random_), true);
  hidden(kSkinGeom, bare, bare_hand());
  hidden(kTubeGeom, bare, unit_tube());
  hidden(kSleeveGeom, material(weave(random_, {0.95F, 0.95F, 0.95F}), true), sleeve_mesh());
}

}  // namespace

ModelPtr scenery_model(const StageSpec& stage) {
  Room room(stage.scenery, stage.seed);
  room.furnish();
  room.template_of_hand();
  const SpecPtr spec = std::move(room).spec();
  spec->visual.quality.offsamples = stage.finish.samples;
  spec->visual.quality.shadowsize = 2048;
  spec->visual.map.shadowclip = 2.0F;
  spec->visual.quality.numslices = 36;
  spec->visual.quality.numstacks = 18;
  spec->visual.map.znear = 0.05F;
  spec->visual.map.zfar = 6.0F;
  spec->stat.extent = 1.0;
  ModelPtr model(mj_compile(spec.get(), nullptr));
  if (!model) throw Error(std::string("MuJoCo does not compile the scenery: ") + mjs_getError(spec.get()));
  return model;
}

}  // namespace enc::sim
