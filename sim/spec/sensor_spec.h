// Ground truth of sensors and display: [truth.force], [truth.tracker], [truth.camera], [truth.display]. A
// part of twin_spec.h.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc::sim {

// The view of the twin's stereo head, as a rig file names it: a part of [truth.camera].
enum class Scenery : std::uint8_t {
  // Wall, desk, things on it, all far from the hue of skin.
  office,
  clutter,    // the office with more things and finer texture
  skin_hued,  // wood, cardboard, a face on a poster
};
constexpr auto words(Scenery) { return enum_words("office", "clutter", "skin_hued"); }

// Skin colours, light to dark (sim/camera/camera_scene.h).
enum class Tone : std::uint8_t { fair, light, olive, brown, dark, deep };
constexpr auto words(Tone) { return enum_words("fair", "light", "olive", "brown", "dark", "deep"); }

struct ForceTruth {
  double quantum = 0.025;           // N
  double torque_quantum = 0.00125;  // N m
  double range = 130.0;             // N
  std::int64_t oversampling = 1;    // readings averaged into a sample
  double torque_range = 10.0;       // N m
  double noise = 0.0125;            // N rms
  double torque_noise = 0.0005;     // N m rms
  double zero = 0.5;                // N rms: zero error at power-up, constant
  double drift = 0.002;             // N / sqrt(s): random walk of the zero
  double push_drift = 0.02;         // N rms: shift of the zero, drawn anew for each push of a pusher
  double drift_ahead = 0.0;         // s before the push in which the zero shifts; 0: at once
  Vec3 turned{0, 0, 0};             // sensor against the rig's X_HF, rad
};

enum class TrackerClocks : std::uint8_t {
  free,    // exposures and server ticks begin at any time, drawn by the seed
  aligned  // both begin with the loop: no sample waits if the rates are the loop's
};
constexpr auto words(TrackerClocks) { return enum_words("free", "aligned"); }

enum class Packets : std::uint8_t {
  polled,  // the server sends its newest pose at its own rate, as in the paper [VHMR 2]
  event    // each pose is sent at once
};
constexpr auto words(Packets) { return enum_words("polled", "event"); }

struct TrackerTruth {
  double rate = 120.0;      // Hz, exposures, free-running
  double latency = 0.0035;  // s, exposure to host
  Packets packets = Packets::polled;
  double server_rate = 100.0;  // Hz, polled packets
  TrackerClocks clocks = TrackerClocks::free;
  double process = 0.0092;                      // s, in the server's application, from its tick to the packet
  double udp_delay = 0.0005;                    // s, mean of the exponential part (process and network)
  Vec3 bias{0.0779e-3, 0.0659e-3, 0.1192e-3};   // m, registration error, in W
  Vec3 noise{0.0166e-3, 0.0069e-3, 0.0108e-3};  // m rms, each frame, in W
  double turn_noise = 0.0;                      // rad rms, each frame, about each axis of W
  // m rms, each frame and axis, of each marker, in addition to their common `noise` and `turn_noise`. If set,
  // the tracker recognises the tool by its markers and computes the pose from them. Unset: the tool is given.
  double marker_noise = kUnset;
  double stamp_error = 0.0;     // s: delay of the stamps after the exposure
  double loss = 0.0;            // share of packets lost
  double blackout_at = kUnset;  // s: one drop-out from here
  double blackout_for = 0.0;    // s long
};

// The stereo head of [VisHap 2], as far as it determines the measured position of a point: a rectified pair
// of pinholes. Its left camera is C: x along the image's rows, y down its columns, z into the scene. STH-MDCS
// with 7.5 mm lenses, 1280 x 960 binned to 640 x 480 (sources/tracking 7).
struct CameraTruth {
  double baseline = 0.090;             // m, from the left camera to the right one
  double focal = 721.0;                // px
  std::int64_t width = 640;            // px
  std::int64_t height = 480;           // px
  double rate = 20.0;                  // Hz, frames
  double matching = 0.20;              // px rms, each frame, disparity
  double pointing = 0.15;              // px rms, each frame, position in the left image
  double standing = 0.05;              // px rms, all three: constant while the object stands still
  double disparity_step = 1.0 / 16.0;  // px
  // Images, for a scene that uses them (sim/camera).
  Scenery scenery = Scenery::office;
  Tone skin = Tone::light;
  double hand_from = 0.6;      // s: until then the hand is out of view, while the background is learned
  double noise = 1.5;          // out of 255, rms
  double exposure = 1.0;       // factor on the light
  double stalls_at = kUnset;   // s: no frame from then on
  double back_at = kUnset;     // s: frames resume
  double swapped_at = kUnset;  // s: left and right exchanged from then on
  Vec3 moved{0, 0, 0};         // m in W: displacement from [truth.frames.W_C]
  double moved_at = 0.0;       // s: start of that displacement
  std::array<double, 5> distortion{0, 0, 0, 0, 0};   // both lenses: k1, k2, p1, p2, k3
  double ball_radius = 0.012;                        // m, ball at the tip for a registration
  std::array<double, 3> ball_rgb{0.5, 0.04, 0.115};  // linear, 0 to 1
};

struct DisplayTruth {
  double rate = 60.0;      // Hz, frames
  double latency = 0.010;  // s, frame to the surface's return at the core
};

// The hand tracker on the headset, which stands still at S (sources/hand 7).
struct HandTrackerTruth {
  double rate = 120.0;      // Hz [VHMR 2]
  double latency = 0.030;   // s, exposure to arrival
  double noise = 0.4e-3;    // m rms, each frame, axis and joint
  double turn_noise = 0.0;  // rad rms, each frame, of the wrist
  double skin = 0.008;      // m
  double loss = 0.0;        // share of frames lost
  bool there = false;       // the rig file has its table
};

}  // namespace enc::sim
