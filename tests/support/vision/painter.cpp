#include "tests/support/vision/painter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace enc::painted {
namespace {

constexpr int kTile = 16;                                // px
constexpr int kColumns = 48, kRows = 36;                 // cells of the wall's shadow grid
constexpr double kHalfWidth = 0.62, kHalfHeight = 0.46;  // m at 1 m: half the visible wall

constexpr double kSkinFrom = 5.0, kSkinTo = 28.0;  // degrees, hues of skin
constexpr double kApart = 6.0;                     // times the noise

std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27U)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 31U);
}
double chance(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<double>(mixed(static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                                   static_cast<std::uint64_t>(y) * 0xd1b54a32d192ed03ULL ^
                                   static_cast<std::uint64_t>(z) * 0x8cb92ba72f3d8dd7ULL) >>
                             11U) *
         0x1p-53;
}

// Noise that is smooth in space, 0 to 1, with detail of size 1.
double mottled(double x, double y, double z) {
  const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy),
             iz = static_cast<std::int64_t>(fz);
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double tx = smooth(x - fx), ty = smooth(y - fy), tz = smooth(z - fz);
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const int a = i & 1, b = (i >> 1) & 1, c = i >> 2;
    sum += chance(ix + a, iy + b, iz + c) * (a != 0 ? tx : 1.0 - tx) * (b != 0 ? ty : 1.0 - ty) *
           (c != 0 ? tz : 1.0 - tz);
  }
  return sum;
}
double mottled(const Vec3& at, double size) { return mottled(at.x() / size, at.y() / size, at.z() / size); }

double linear(double of_255) {
  const double v = of_255 / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
Colour linear_of(double red, double green, double blue) { return {linear(red), linear(green), linear(blue)}; }

double of_255(double light) {
  static const std::vector<double> kTable = [] {
    std::vector<double> table;
    for (int i = 0; i <= 4096; ++i) {
      const double v = i / 4096.0;
      table.push_back(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055));
    }
    return table;
  }();
  const double at = 4096.0 * std::clamp(light, 0.0, 0.99999);
  const auto i = static_cast<std::size_t>(at);
  const double t = at - static_cast<double>(i);
  return kTable[i] + t * (kTable[i + 1] - kTable[i]);
}

Colour times(const Colour& colour, double by) { return {colour[0] * by, colour[1] * by, colour[2] * by}; }

Colour office(double x, double y, std::uint64_t seed) {
  static const std::array<Colour, 6> kThings{linear_of(96, 112, 140), linear_of(150, 156, 160),
                                             linear_of(70, 110, 96),  linear_of(205, 208, 206),
                                             linear_of(52, 58, 66),   linear_of(120, 108, 150)};
  const auto s = static_cast<std::int64_t>(seed);
  const auto row = static_cast<std::int64_t>(std::floor(y / 0.16));
  const double shift = 0.2 * chance(row, 3, s);
  const auto column = static_cast<std::int64_t>(std::floor((x + shift) / 0.11));
  return kThings[static_cast<std::size_t>(6.0 * chance(column, row, s + 1))];
}

// Colour of the wall and strength of its detail.
struct Paint {
  Colour colour;
  double detail;
};
Paint paint_of(const Room& room, double x, double y) {
  switch (room.wall) {
    case WallKind::office:
      return {office(x, y, room.seed), 0.35};
    case WallKind::grey:
      return {linear_of(150, 151, 153), 0.12};
    case WallKind::beige:
      return {linear_of(224, 202, 173), 0.05};
    case WallKind::plaster:
      return {linear_of(216, 190, 175), 0.05};
    case WallKind::wood:
      break;
  }
  const double plank =
      chance(static_cast<std::int64_t>(std::floor(x / 0.12)), 5, static_cast<std::int64_t>(room.seed));
  const double grain = mottled(x / 0.004, y / 0.08, 0.0);
  return {times(linear_of(178, 132, 92), 0.75 + 0.3 * plank + 0.25 * grain), 0.15};
}

// Share of the wall's points with a free line to a wide lamp.
double free_share(const std::vector<Cone>& cones, const Vec3& at, const Vec3& lamp) {
  constexpr int kWays = 6;
  int free = 0;
  for (int i = 0; i < kWays; ++i) {
    const Vec3 way = (lamp + 0.06 * Vec3(std::cos(1.05 * i), std::sin(1.05 * i), 0.0)).normalized();
    Hit hit;
    free += std::none_of(cones.begin(), cones.end(), [&](const Cone& c) { return meets(c, at, way, hit); })
                ? 1
                : 0;
  }
  return static_cast<double>(free) / kWays;
}

// Hue in degrees; below 0 for a pixel without one.
double hue_of(const std::uint8_t* p) {
  const int most = std::max({p[0], p[1], p[2]}), least = std::min({p[0], p[1], p[2]});
  if (most - least < 12 || most < 16) return -1.0;
  const double chroma = most - least;
  if (most == p[0]) return std::fmod(60.0 * (p[1] - p[2]) / chroma + 360.0, 360.0);
  return most == p[1] ? 120.0 + 60.0 * (p[2] - p[0]) / chroma : 240.0 + 60.0 * (p[0] - p[1]) / chroma;
}

constexpr std::array<const char*, kTones> kToneNames{"fair", "light", "olive", "brown", "deep"};

// Evenly spread numbers that depend only on the sequence.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ULL + 0x2545f4914f6cdd1dULL) {}
  double between(double least, double most) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return least + (most - least) * static_cast<double>(state_ >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

struct Direction {
  const char* name;
  Vec3 along;
};
const std::array<Direction, 4>& sides() {
  static const std::array<Direction, 4> kAll{{{"from below", {0.15, -1, 0}},
                                              {"from the left", {1, -0.2, 0}},
                                              {"from the right", {-1, -0.2, 0}},
                                              {"from above", {-0.2, 1, 0}}}};
  return kAll;
}

// Places the hand so that both cameras see the tip, and most of the hand on that side if there is room.
Vec3 place(Dice& dice, const Vec3& along) {
  const double z = dice.between(0.38, 0.75);
  return {0.045 + z * (0.12 * along.x() + dice.between(-0.06, 0.06)),
          z * (0.10 * along.y() + dice.between(-0.05, 0.05)), z};
}

Hand hand(Dice& dice, const Vec3& along) {
  Hand hand;
  hand.along = (along + Vec3(0, 0, dice.between(-0.35, 0.25))).normalized();
  hand.tip = place(dice, along.normalized());
  hand.roll = dice.between(-0.7, 0.7);
  hand.size = dice.between(0.88, 1.12);
  hand.thumb = dice.between(0.0, 0.9);
  hand.bare = dice.between(0.0, 1.0) < 0.5 ? dice.between(0.0, 0.08) : 0.30;
  hand.left = dice.between(0.0, 1.0) < 0.4;
  return hand;
}

Room room(Dice& dice, WallKind wall, bool from_below, std::uint64_t seed) {
  Room room;
  room.wall = wall;
  room.depth = dice.between(0.95, 1.4);
  room.lamp =
      from_below ? Vec3(dice.between(-0.3, 0.3), 0.9, -0.35) : Vec3(dice.between(-0.5, 0.5), -0.7, -0.6);
  room.lamp_share = dice.between(0.4, 0.65);
  room.light = dice.between(0.85, 1.05);
  room.seed = seed;
  return room;
}

class Writer {
 public:
  std::vector<Sequence> all;
  Sequence& add(const std::string& name, std::size_t tone, WallKind wall, bool from_below) {
    const std::uint64_t seed = all.size() + 1;
    dice_ = Dice(seed);
    Sequence sequence;
    sequence.name = name + ", " + kToneNames[tone] + (from_below ? ", lit from below" : "");
    sequence.tone = tone;
    sequence.room = room(dice_, wall, from_below, seed);
    sequence.phase = dice_.between(0.0, 6.28);
    all.push_back(std::move(sequence));
    return all.back();
  }
  Dice& dice() { return dice_; }

 private:
  Dice dice_{0};
};

void add_sides(Writer& to, WallKind wall, const char* where) {
  for (std::size_t tone = 0; tone < kTones; ++tone)
    for (const bool below : {false, true})
      for (const Direction& side : sides()) {
        Sequence& sequence = to.add(std::string(where) + ", " + side.name, tone, wall, below);
        sequence.hands = {hand(to.dice(), side.along)};
      }
}

// The finger leans away from the camera by this angle (rad), until the hand hides it; below 0 towards it.
void add_leaning(Writer& to) {
  for (std::size_t tone = 0; tone < kTones; ++tone)
    for (const double lean : {0.6, 0.9, 1.2, 1.5, -0.6, -0.9, -1.2})
      for (const double thumb : {0.1, 0.9}) {
        Sequence& sequence =
            to.add(std::string(lean > 0.0 ? "away from the camera" : "towards the camera") + " by " +
                       std::to_string(std::lround(std::abs(lean) * 180.0 / std::numbers::pi)) + " degrees",
                   tone, WallKind::office, false);
        const double turn = to.dice().between(0.0, 6.28);
        const Vec3 aside = Vec3(std::cos(turn), -std::abs(std::sin(turn)), 0);
        Hand one = hand(to.dice(), aside);
        one.along = std::cos(lean) * aside + Vec3(0, 0, std::sin(lean));
        one.thumb = thumb;
        sequence.hands = {one};
      }
}

// The second hand is beside the first one: it points, too, is a fist, or has all fingers spread.
void add_second(Writer& to) {
  for (std::size_t tone = 0; tone < kTones; ++tone)
    for (const Fingers second : {Fingers::pointing, Fingers::fist, Fingers::open}) {
      constexpr std::array<const char*, 3> kWhat{"pointing", "fist", "open"};
      Sequence& sequence =
          to.add(std::string("two hands, the other ") + kWhat[static_cast<std::size_t>(second)], tone,
                 WallKind::office, false);
      Hand one = hand(to.dice(), {0.15, -1, 0}), other = hand(to.dice(), {-0.1, -1, 0});
      one.tip = {-0.05, 0.0, 0.55};
      other.tip = {0.13, 0.02, 0.60};
      other.left = !one.left;
      other.fingers = second;
      sequence.hands = {one, other};
    }
}

// The pointing finger folds into a fist.
void add_folding(Writer& to) {
  for (std::size_t tone = 0; tone < kTones; ++tone)
    for (const double thumb : {0.1, 0.9}) {
      Sequence& sequence = to.add("folds", tone, WallKind::office, false);
      Hand one = hand(to.dice(), sides()[tone % sides().size()].along);
      one.thumb = thumb;
      sequence.hands = {one};
      sequence.folds = true;
    }
}

}  // namespace

Colour tone(std::size_t index) {
  static const std::array<Colour, kTones> kAll{linear_of(231, 188, 168), linear_of(214, 162, 130),
                                               linear_of(182, 126, 92), linear_of(134, 86, 60),
                                               linear_of(84, 53, 40)};
  return kAll[index];
}

Painter::Painter(const StereoRig& rig, const Room& room) : rig_(rig), room_(room) {
  room_.lamp = room.lamp.normalized();
  const auto eye = [](const Lens& lens, double shift) {
    return Eye{lens.focal_x, lens.focal_y, lens.centre_x, lens.centre_y, shift, {}};
  };
  eyes_ = {eye(rig.left, 0.0), eye(rig.right, rig.X_CD.p().x())};
  for (Eye& each : eyes_)
    for (int y = 0; y < rig.height; ++y)
      for (int x = 0; x < rig.width; ++x) {
        const Vec3 way = ray(each, x, y);
        const Vec3 at = Vec3(each.shift, 0, 0) + room_.depth / way.z() * way;
        const Paint paint = paint_of(room_, at.x(), at.y());
        const double detail = 1.0 + paint.detail * (mottled(at, 0.006) + mottled(at, 0.03) - 1.0);
        const double lamp = std::max(0.0, -room_.lamp.z()) + 0.35 * (1.0 - std::abs(room_.lamp.z()));
        each.wall.push_back(times(paint.colour, room_.light * detail * (1.0 - room_.lamp_share)));
        each.wall.push_back(times(paint.colour, room_.light * detail * room_.lamp_share * lamp * 1.3));
      }
}

Vec3 Painter::ray(const Eye& eye, double x, double y) const {
  return Vec3((x - eye.centre_x) / eye.focal_x, (y - eye.centre_y) / eye.focal_y, 1.0).normalized();
}

void Painter::cast_shadow() {
  lit_.assign(std::size_t{kColumns} * kRows, 1.0);
  if (cones_.empty() || room_.shadow <= 0.0) return;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const Vec3 at(room_.depth * kHalfWidth * (2.0 * column / (kColumns - 1) - 1.0),
                    room_.depth * kHalfHeight * (2.0 * row / (kRows - 1) - 1.0), room_.depth);
      lit_[static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column)] =
          1.0 - room_.shadow * (1.0 - free_share(cones_, at, room_.lamp));
    }
}

double Painter::lit(double x, double y) const {
  const double column =
      std::clamp(0.5 * (x / (room_.depth * kHalfWidth) + 1.0) * (kColumns - 1), 0.0, kColumns - 1.001);
  const double row =
      std::clamp(0.5 * (y / (room_.depth * kHalfHeight) + 1.0) * (kRows - 1), 0.0, kRows - 1.001);
  const auto c = static_cast<std::size_t>(column), r = static_cast<std::size_t>(row);
  const double right = column - static_cast<double>(c), down = row - static_cast<double>(r);
  const double* a = lit_.data() + r * kColumns + c;
  return (a[0] * (1.0 - right) + a[1] * right) * (1.0 - down) +
         (a[kColumns] * (1.0 - right) + a[kColumns + 1] * right) * down;
}

Painter::ConeList Painter::near(const Eye& eye, const Region& tile) const {
  ConeList near;
  for (const Cone& cone : cones_) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const auto& [at, radius] : {std::pair{cone.from, cone.from_radius}, {cone.to, cone.to_radius}}) {
      const double z = std::max(0.05, at.z() - radius);
      const double x = eye.centre_x + eye.focal_x * (at.x() - eye.shift) / std::max(at.z(), 0.05);
      const double y = eye.centre_y + eye.focal_y * at.y() / std::max(at.z(), 0.05);
      const double far = 1.3 * eye.focal_x * radius / z + 2.0;
      x0 = std::min(x0, x - far), x1 = std::max(x1, x + far);
      y0 = std::min(y0, y - far), y1 = std::max(y1, y + far);
    }
    if (x0 < tile.x1 && x1 > tile.x0 && y0 < tile.y1 && y1 > tile.y0) near.push_back(&cone);
  }
  return near;
}

Painter::RayHit Painter::first(const ConeList& near, const Vec3& from, const Vec3& ray) const {
  RayHit seen;
  seen.hit.along = 1e9;
  for (const Cone* cone : near) {
    Hit hit;
    if (meets(*cone, from, ray, hit) && hit.along < seen.hit.along) seen = {cone, hit};
  }
  return seen;
}

Colour Painter::colour_of(const RayHit& seen, const Vec3& from, const Vec3& ray) const {
  const Vec3 at = from + seen.hit.along * ray;
  const Vec3& n = seen.hit.normal;
  const double lamp = std::max(0.0, (n.dot(room_.lamp) + 0.2) / 1.2);
  const double around = 0.8 - 0.2 * n.y();
  const double light = room_.light * (1.3 * room_.lamp_share * lamp + (1.0 - room_.lamp_share) * around);
  if (seen.cone->stuff == Stuff::sleeve)
    return times(linear_of(64, 84, 122), light * (0.8 + 0.4 * mottled(at - seen.cone->from, 0.003)));
  const Vec3 own = at - seen.cone->from;
  const double marks = 1.0 + 0.22 * (mottled(own, 0.0016) - 0.5) + 0.16 * (mottled(own, 0.006) - 0.5);
  Colour colour = times(skin_, light * marks);
  if (seen.cone->stuff == Stuff::nail)
    for (double& c : colour) c = 1.06 * c + 0.02 * light;
  const Vec3 half = (room_.lamp - ray).normalized();
  const double shine = 0.05 * room_.lamp_share * std::pow(std::max(0.0, n.dot(half)), 24.0);
  for (double& c : colour) c += room_.light * shine;
  return colour;
}

Colour Painter::wall_at(const Eye& eye, int x, int y, double sub_x, double sub_y) const {
  const std::size_t i =
      2 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(rig_.width) + static_cast<std::size_t>(x));
  const double at_x = eye.shift + room_.depth * (sub_x - eye.centre_x) / eye.focal_x;
  const double share = lit(at_x, room_.depth * (sub_y - eye.centre_y) / eye.focal_y);
  Colour colour = eye.wall[i];
  for (std::size_t c = 0; c < 3; ++c) colour[c] += share * eye.wall[i + 1][c];
  return colour;
}

void Painter::paint_tile(const Eye& eye, const Region& tile, std::vector<Colour>& light) const {
  const ConeList near = this->near(eye, tile);
  const Vec3 from(eye.shift, 0, 0);
  std::array<const Cone*, std::size_t{kTile + 1} * (kTile + 1)> owner{};
  const auto own = [&](int x, int y) -> const Cone*& {
    return owner[static_cast<std::size_t>(y - tile.y0) * (kTile + 1) + static_cast<std::size_t>(x - tile.x0)];
  };
  // The part in front at each pixel's corners: if all four agree, one ray through the middle suffices.
  for (int y = tile.y0; !near.empty() && y <= tile.y1; ++y)
    for (int x = tile.x0; x <= tile.x1; ++x) own(x, y) = first(near, from, ray(eye, x - 0.5, y - 0.5)).cone;
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) {
      const Cone* a = own(x, y);
      const bool one = a == own(x + 1, y) && a == own(x, y + 1) && a == own(x + 1, y + 1);
      const int sub = one ? 1 : 3;
      Colour colour{};
      for (int i = 0; i < sub * sub; ++i) {
        const double sx = x + (i % sub + 0.5) / sub - 0.5, sy = y + (i / sub + 0.5) / sub - 0.5;
        const Vec3 way = ray(eye, sx, sy);
        const RayHit seen = one && a == nullptr ? RayHit{} : first(near, from, way);
        const Colour part = seen.cone != nullptr ? colour_of(seen, from, way) : wall_at(eye, x, y, sx, sy);
        for (std::size_t c = 0; c < 3; ++c) colour[c] += part[c] / (sub * sub);
      }
      light[static_cast<std::size_t>(y) * static_cast<std::size_t>(rig_.width) +
            static_cast<std::size_t>(x)] = colour;
    }
}

void Painter::paint_eye(const Eye& eye, std::uint64_t key, Image& image) const {
  const int width = static_cast<int>(rig_.width), height = static_cast<int>(rig_.height);
  std::vector<Colour> light(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; y += kTile)
    for (int x = 0; x < width; x += kTile)
      paint_tile(eye, {x, y, std::min(x + kTile, width), std::min(y + kTile, height)}, light);
  image = Image(width, height);
  constexpr double kTwoBytes = 104.1;  // rms of the sum of two evenly spread bytes
  for (std::size_t i = 0; i < light.size(); ++i) {
    std::uint64_t bits = mixed(key * 0x9e3779b97f4a7c15ULL + i);
    for (std::size_t c = 0; c < 3; ++c, bits >>= 16U) {
      const double off = static_cast<double>(bits & 255U) + static_cast<double>((bits >> 8U) & 255U) - 255.0;
      const double value = of_255(light[i][c]) + room_.noise / kTwoBytes * off;
      image.rgb[3 * i + c] = static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
    }
  }
}

void Painter::paint(const std::vector<Hand>& hands, std::size_t tone, std::uint64_t frame, Picture& picture) {
  skin_ = painted::tone(tone);
  cones_.clear();
  for (const Hand& hand : hands) {
    const std::vector<Cone> parts = parts_of(hand);
    cones_.insert(cones_.end(), parts.begin(), parts.end());
  }
  cast_shadow();
  paint_eye(eyes_[0], 2 * (frame + 1000 * room_.seed), picture.left);
  paint_eye(eyes_[1], 2 * (frame + 1000 * room_.seed) + 1, picture.right);
  last_ = picture.left;
}

// Sends a ray to each pixel of the cap: the pixel shows the cap if the ray first meets a tip no farther than
// the cap.
Painter::Counts Painter::count_cap(std::size_t side, const Vec3& tip, double radius) const {
  const Cone cap{tip, tip + Vec3(1e-6, 0, 0), radius, radius};
  const Region image{0, 0, static_cast<int>(rig_.width), static_cast<int>(rig_.height)};
  const Eye& eye = eyes_[side];
  const Vec3 from(eye.shift, 0, 0);
  const int x = static_cast<int>(eye.centre_x + eye.focal_x * (tip.x() - eye.shift) / tip.z());
  const int y = static_cast<int>(eye.centre_y + eye.focal_y * tip.y() / tip.z());
  const int far = static_cast<int>(1.1 * eye.focal_x * radius / tip.z()) + 2;
  const Region box{x - far, y - far, x + far + 1, y + far + 1};
  const ConeList near = this->near(eye, box);
  Counts counts;
  for (int row = box.y0; row < box.y1; ++row)
    for (int column = box.x0; column < box.x1; ++column) {
      const Vec3 way = ray(eye, column, row);
      Hit hit;
      if (!meets(cap, from, way, hit)) continue;
      ++counts.all;
      const RayHit seen = first(near, from, way);
      if (!image.contains(column, row) || seen.cone == nullptr || !seen.cone->tip) continue;
      if ((seen.hit.along * way + from - tip).norm() > 2.0 * radius) continue;  // the tip of another hand
      ++counts.front;
      if (side != 0) continue;
      const std::uint8_t* p = last_.view().at(column, row);
      const double hue = hue_of(p);
      counts.coloured += hue >= kSkinFrom && hue <= kSkinTo ? 1 : 0;
      const Colour wall = wall_at(eye, column, row, column, row);
      double most = 0.0;
      for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(p[c] - of_255(wall[c])));
      counts.apart += most > kApart * room_.noise ? 1 : 0;
    }
  return counts;
}

TipVisibility Painter::shown(const Hand& hand, const Vec3& tip) const {
  const Counts left = count_cap(0, tip, cap_radius(hand)), right = count_cap(1, tip, cap_radius(hand));
  const auto share = [](int of, int all) { return all == 0 ? 0.0 : static_cast<double>(of) / all; };
  return {std::min(share(left.front, left.all), share(right.front, right.all)),
          share(left.coloured, left.front), share(left.apart, left.front)};
}

StereoRig head() { return {}; }

std::vector<Hand> hands_at(const Sequence& sequence, int frame) {
  constexpr double kPeriod = 1.6, kRate = 20.0;  // s, Hz
  const double u = 2.0 * std::numbers::pi * frame / kRate / kPeriod + sequence.phase;
  const Vec3 way =
      sequence.sway.cwiseProduct(Vec3(std::sin(u), std::sin(0.7 * u + 1.0), std::sin(0.8 * u + 2.0)));
  std::vector<Hand> hands = sequence.hands;
  double sign = 1.0;
  for (Hand& hand : hands) {
    hand.tip += sign * Vec3(way.x(), way.y(), std::abs(sign) * way.z());
    hand.along = (hand.along + 0.12 * sign * Vec3(std::sin(0.6 * u), std::sin(0.5 * u), 0)).normalized();
    if (sequence.folds) hand.fold = std::clamp((frame - 4) / 6.0, 0.0, 1.0);
    sign = -0.4;
  }
  return hands;
}

std::vector<Sequence> sequences() {
  Writer all;
  add_sides(all, WallKind::office, "office");
  for (const auto& [wall, where] : {std::pair{WallKind::beige, "beige wall"},
                                    {WallKind::plaster, "wall of the hue of skin"},
                                    {WallKind::wood, "wood"},
                                    {WallKind::grey, "grey wall"}})
    add_sides(all, wall, where);
  add_leaning(all);
  add_second(all);
  add_folding(all);
  std::vector<Sequence> mixed;  // 97 is coprime to their number
  for (std::size_t i = 0; i < all.all.size(); ++i) mixed.push_back(all.all[i * 97 % all.all.size()]);
  return mixed;
}

std::vector<VisibleTip> tips_in(const Painter& painter, const std::vector<Hand>& hands) {
  std::vector<VisibleTip> tips;
  for (const Hand& hand : hands)
    if (hand.fingers == Fingers::pointing) {
      const Vec3 tip = fingertips_of(hand).front();
      tips.push_back({tip, painter.shown(hand, tip)});
    }
  return tips;
}

}  // namespace enc::painted
