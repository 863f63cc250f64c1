#include "tests/support/vision/hand_sequences.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace enc::painted {
namespace {

constexpr std::array<const char*, kTones> kToneNames{"fair", "light", "olive", "brown", "deep"};

// Evenly spread numbers that depend on the sequence alone.
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

// So that the tip is in view of both cameras, and most of the hand on that side where there is room.
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

// The finger leans away from the camera by so much (rad), until the hand hides it; below 0 towards it.
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

// The second hand beside the first one: it points, too, is a fist, or has all fingers spread.
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

// The finger becomes one of a fist.
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
  std::vector<Sequence> mixed;  // 97 has no divisor in common with their number
  for (std::size_t i = 0; i < all.all.size(); ++i) mixed.push_back(all.all[i * 97 % all.all.size()]);
  return mixed;
}

std::vector<TipShown> tips_in(const Painter& painter, const std::vector<Hand>& hands) {
  std::vector<TipShown> tips;
  for (const Hand& hand : hands)
    if (hand.fingers == Fingers::pointing) {
      const Vec3 tip = fingertips_of(hand).front();
      tips.push_back({tip, painter.shown(hand, tip)});
    }
  return tips;
}

}  // namespace enc::painted
