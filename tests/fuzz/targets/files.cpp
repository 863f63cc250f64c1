// Scenes and the files that they name, calibrations, records, tables and folders of frames: an accepted file
// has a valid result.
#include "tests/support/files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/record/record.h"
#include "models/directions/directions.h"
#include "models/identify/camera/register.h"
#include "models/identify/response/loop_csv.h"
#include "models/identify/tip/pivot_log.h"
#include "models/identify/tracker/tracker_log.h"
#include "models/mesh_files/mesh_file.h"
#include "models/setup/calibration_files.h"
#include "models/setup/driver_table.h"
#include "models/setup/scene_file.h"
#include "tests/fuzz/machine/fuzzing.h"
#include "tests/fuzz/targets/seeds.h"
#include "tests/support/scenes.h"
#include "trial/assemble/assemble.h"
#include "trial/camera/kept_frames.h"

namespace enc::fuzz {
namespace {

namespace fs = std::filesystem;
using models::Setup;

// ---- Scene, rig, behaviours, response, directions, --set: read and checked as for a run; an accepted setup
// is written and read again.

const Folder& model_folder() {
  static const ModelsFolder kFolder;
  return kFolder;
}

// Checks that prepare() accepts the setup, and that its text reads back to itself.
bool sane(const Setup& setup) {
  static_cast<void>(trial::prepare_setup(setup));
  const std::string text = models::resolved(setup);
  std::string again;
  try {
    again = models::resolved(models::parse_resolved(text, "resolved"));
  } catch (const Error& e) {
    throw InvariantError(fmt::format("what is written of it is refused: {}", e.what()));
  }
  expect(again == text, "what is written of it is read as another");
  return true;
}

Target scene() {
  Target target;
  for (const char* name : {"tennis_ball", "wall", "keypad", "session", "rig_A", "rig_identify", "tracking",
                           "two_objects", "reaching", "synchrony", "camera/wall"})
    target.seeds.push_back(file_text(fmt::format("models/scenes/{}.toml", name)));
  target.seeds.push_back(mesh_scene());
  target.seeds.push_back(file_text("tests/golden/tennis_ball.resolved.toml"));
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    return sane(models::load(model_folder().write("scenes/fuzz.toml", input), ""));
  };
  target.inputs = 700;
  return target;
}

Target rig() {
  Target target;
  target.seeds = file_texts("models/rigs", ".toml");
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    const std::string path = model_folder().write("rigs/fuzz.toml", input);
    static_cast<void>(models::load_rig_setup(path));
    const bool arm = input.find("\n[arm]") != std::string::npos;
    return sane(
        models::load(model_folder().path(arm ? "scenes/wall.toml" : "scenes/tennis_ball.toml"), path));
  };
  target.inputs = 500;
  return target;
}

Target behaviours() {
  Target target;
  target.seeds = {file_text("models/behaviours.toml")};
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    static const ModelsFolder kOwn;
    kOwn.write("behaviours.toml", input);
    const test::Variable models("ENCOUNTER_MODELS", kOwn.path(""));
    return sane(models::load(kOwn.path("scenes/two_objects.toml"), ""));
  };
  target.inputs = 500;
  return target;
}

Target response() {
  Target target;
  target.seeds = file_texts("models/responses", ".toml");
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    static const ModelsFolder kOwn;
    const ResponseSpec read = models::load_response(kOwn.write("responses/tennis_ball.toml", input));
    const std::string text = models::response_text(read, "fuzz");
    kOwn.write("responses/again.toml", text);
    expect(models::response_text(models::load_response(kOwn.path("responses/again.toml")), "fuzz") == text,
           "what is written of it is read as another");
    const test::Variable models("ENCOUNTER_MODELS", kOwn.path(""));
    return sane(models::load(kOwn.path("scenes/tennis_ball.toml"), ""));
  };
  target.inputs = 500;
  return target;
}

Target directions() {
  Target target;
  target.seeds = file_texts("models/directions", ".toml");
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    const std::vector<models::Direction> all = models::read_directions(input, "fuzz.toml");
    double sum = 0.0;
    for (const double weight : models::weights(all, {0.2, 0.1})) {
      expect(weight >= 0.0, fmt::format("a weight is {}", weight));
      sum += weight;
    }
    expect(std::abs(sum - 1.0) < 1e-9, fmt::format("the weights are {} together", sum));
    return true;
  };
  return target;
}

Target set() {
  Target target;
  target.seeds = {"object.ball.radius_mm=30",
                  "truth.tracker.bias_mm=[0,0,0.3]",
                  "rig.force.filter_hz=20",
                  "behaviour.tennis_ball.response=tennis_ball_B",
                  "rig.tracker.driver=sample",
                  "rig.driver.sample.rate_Hz=100",
                  "title=\"a\"",
                  "object.ball.shape=sphere",
                  "user.depth_mm=unset"};
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    static const Setup kSetup = models::load(model_folder().path("scenes/tennis_ball.toml"), "");
    Setup setup = kSetup;
    models::set(setup, input);
    models::settle_drivers(setup);
    models::check(setup);
    return sane(setup);
  };
  return target;
}

const Offer kScene("scene", &scene), kRig("rig", &rig), kBehaviours("behaviours", &behaviours),
    kResponse("response", &response), kDirections("directions", &directions), kSet("set", &set);

// ---- The calibrations of a stereo head and of a rig, a record, and its content.

// A file that is written and read again must be equal.
template <class File>
Target written(const File& file, std::string (*text_of)(const File&),
               File (*parsed)(const std::string&, const std::string&)) {
  Target target;
  target.seeds = {text_of(file)};
  target.tokens = toml_tokens();
  target.run = [=](const std::string& input) {
    const std::string text = text_of(parsed(input, "fuzz.toml"));
    std::string again;
    try {
      again = text_of(parsed(text, "again.toml"));
    } catch (const Error& e) {
      throw InvariantError(fmt::format("what is written of it is refused: {}", e.what()));
    }
    expect(again == text, "what is written of it is read as another");
    return true;
  };
  return target;
}

Target stereo() {
  models::StereoFile file;
  file.title = "13 pairs";
  file.rig.left = {533.7123, 533.7, 342.2, 235.1, {-0.2891, 0.096, 0.0011, -0.0001, 0.0}};
  file.rig.right = {536.8, 536.4, 327.1, 249.9, {-0.2892, 0.1051, -0.0005, 0.0002, 0.0}};
  file.rig.X_CD = Pose<'C', 'D'>(Quat::Identity(), Vec3(0.08316, -0.00064, 0.00055));
  file.reprojection = 0.194;
  return written<models::StereoFile>(file, models::stereo_text, models::parse_stereo);
}

Target rig_calibration() {
  const models::RigCalibration file{"a rig",
                                    "2026-11-28",
                                    {"gcs 192.168.0.20", "netft 192.168.1.1", "igtl", HexapodGeometry{}},
                                    PoseSpec{{0.0031234, -0.8961, 0.6}, {0.01, -0.02, 0.03}},
                                    Vec3(0.011, 0.0, -0.02),
                                    1.1099};
  return written<models::RigCalibration>(file, models::rig_calibration_text, models::parse_rig_calibration);
}

// ---- records

const Folder& folder() {
  static const Folder kFolder;
  return kFolder;
}

std::string small_record(const Scene& scene, int ticks, const RecordTexts& texts, const RecordTexts& ends) {
  test::Loop loop(scene);
  loop.tool_tip = Point<'W'>(0, 0, 0.02);
  const std::string path = folder().path("seed.encrec");
  RecordWriter record(path, texts, layout_hash(loop.scene));
  for (int i = 0; i < ticks; ++i) {
    loop.tick();
    record.write(loop.k, loop.in, loop.out, 7);
  }
  if (!ends.empty()) record.end_with(ends);
  record.close();
  return test::bytes_of(path);
}

// Corrects the checksums for RecordReader, part by part, as far as the sizes lead.
void seal_again(std::string& bytes) {
  const auto word = [&](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
  };
  StateHash chain;
  for (std::size_t at = 0; at + 16 <= bytes.size();) {
    const bool first = at == 0;
    const std::size_t head = first ? 32 : 8, size = word(first ? 8 : at) >> 32U;
    if (size % 8 != 0 || size > bytes.size() || at + head + size + 8 > bytes.size()) return;
    if (first)
      for (std::size_t i = 0; i < head; i += 8) chain.add(word(i));
    for (std::size_t i = 0; i < size; i += 8) chain.add(word(at + head + i));
    if (!first) chain.add(word(at));
    std::memcpy(bytes.data() + at + head + size, &chain.value, 8);
    at += head + size + 8;
  }
}

// Uses the record's numbers, too; a record without a scene is only read.
void read_all(const std::string& path, PartialRead partial) {
  RecordReader reader(path, partial);
  for (int pass = 0; pass < 2; ++pass) {
    RecordedTick tick;
    std::int64_t ticks = 0;
    while (reader.next(tick)) ++ticks;
    expect(ticks == reader.ticks(), fmt::format("it says {} ticks and gives {}", reader.ticks(), ticks));
    reader.rewind();
  }
  if (reader.texts().contains("resolved")) use(models::setup_of(reader.texts(), path), reader);
}

Target record() {
  Target target;
  const Scene ball = prepare(test::ball_scene(), RigSpec{});
  target.seeds = {small_record(ball, 3, {{"about", "format = 1\n"}, {"seed", "7"}, {"version", "9.8.7"}},
                               {{"ledger", "contact,hand_mJ\n1,2.5\n"}}),
                  small_record(ball, 1, {}, {})};
  // A record of another layout, whose version has two lines.
  target.seeds.push_back(small_record(ball, 1, {{"version", "9\n8"}}, {}));
  target.seeds.back()[16] ^= 1;
  seal_again(target.seeds.back());
  // A record with its scene; mostly ticks, so that most mutations hit them.
  const ModelsFolder models;
  for (const char* scene : {"plane", "tennis_ball"}) {
    const models::Setup setup = models::load(models.path(fmt::format("scenes/{}.toml", scene)), "");
    target.seeds.push_back(small_record(trial::prepare_setup(setup), 60, models::record_texts(setup), {}));
  }
  target.tokens = {"CHNK",
                   "TEXT",
                   "SEAL",
                   "\x89"
                   "ENCREC\n",
                   std::string(8, '\0'),
                   std::string(7, '\xff') + '\x7f',
                   std::string("\2\0\0\0\0\0\0\0", 8)};
  target.run = [](const std::string& input) {
    const std::string path = folder().write("fuzz.encrec", input);
    static_cast<void>(is_record(path));
    try {
      read_all(path, PartialRead::no);
    } catch (const Error&) {
      read_all(path, PartialRead::yes);
      throw;
    }
    return true;
  };
  target.mend = &seal_again;
  return target;
}

// The mesh in a record beside its scene. The hash is removed, because it would exclude every other mesh.
Target recorded_mesh() {
  Target target;
  const models::Setup setup = mesh_setup();
  RecordTexts texts = models::record_texts(setup);
  std::string& resolved = texts.at("resolved");
  const std::size_t hash = resolved.find("mesh_hash");
  resolved.erase(hash, resolved.find('\n', hash) - hash);
  target.seeds = {texts.at("mesh:small.obj")};
  const std::string first =
      folder().write("mesh.encrec", small_record(trial::prepare_setup(setup), 3, {}, {}));
  target.run = [texts, first](const std::string& input) {
    RecordTexts others = texts;
    others["mesh:small.obj"] = input;
    const models::Setup read = models::setup_of(others, "fuzz.encrec");
    expect(models::record_texts(read).at("mesh:small.obj") == input, "what is written of it is another");
    RecordReader record(first);
    use(read, record);
    return true;
  };
  return target;
}

const Offer kStereo("stereo", &stereo), kRigCalibration("rig_calibration", &rig_calibration),
    kRecord("record", &record), kMesh("recorded_mesh", &recorded_mesh);

// ---- Tables: loops of `fit`, points of `calibrate`, logs of a tracker. An accepted table holds finite
// numbers.

const std::vector<std::string>& csv_tokens() {
  static const std::vector<std::string> kAll{",",     ",,",          ";",      "\"",     "#",
                                             "# a\n", " ",           "time_s", "repeat", "source",
                                             "pair",  "tool_time_s", "0.5,",   "1e-9",   "1e9"};
  return kAll;
}
void expect_finite(const Vec3& v, const char* what) {
  expect(v.allFinite(), fmt::format("{} is not finite", what));
}

// Two presses to 6 mm and back.
Target loop() {
  Target target;
  std::string text = "# a loop\ntime_s,deflection_mm,force_N,repeat,source\n";
  for (int press = 0; press < 2; ++press)
    for (int i = 0; i <= 60; ++i) {
      const double d = 0.2 * std::min(i, 60 - i);
      text += fmt::format("{:.2f},{:.3f},{:.4f},{},rig\n", press * 7 + 0.1 * i, d, (i <= 30 ? 1.2 : 1.0) * d,
                          press + 1);
    }
  target.seeds = {text, "time_s,deflection_mm,force_N,repeat\n0,0,,\n1,1,1,1\n"};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    const models::LoopData read = models::parse_loop(input, "fuzz.csv", 6e-3);
    expect(!read.presses.empty() && read.presses.size() == read.moving.size(), "it has no presses");
    for (const auto& press : read.presses)
      for (const models::LoopPoint& p : press)
        expect(std::isfinite(p.deflection) && p.deflection > 0.0 && std::isfinite(p.force),
               "a reading is not finite");
    return true;
  };
  return target;
}

Target points() {
  Target target;
  std::string one = "camera_x_m,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m\n";
  std::string frames = "camera_x_m,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m,pair\n";
  for (int i = 0; i < 8; ++i) {
    const double x = 0.03 * (i % 2), y = 0.05 * (i / 2 % 2), z = 0.5 + 0.04 * (i / 4);
    one += fmt::format("{},{},{},{},{},{}\n", x, y, z, 0.1 + z, 0.2 - x, 0.3 - y);
    for (int k = 0; k < 2; ++k)
      frames += fmt::format("{},{},{},{},{},{},{}\n", x + 1e-4 * k, y, z, 0.1 + z, 0.2 - x, 0.3 - y, i);
  }
  target.seeds = {one, frames};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    static_cast<void>(models::is_point_set(input));
    const models::PointSet places = models::parse_points(input, "fuzz.csv");
    for (const models::SeenPlace& place : places)
      for (const models::PointPair& frame : place.frames) {
        expect_finite(frame.camera.e(), "a place");
        expect_finite(frame.device.e(), "a place");
      }
    const models::Registration found = models::register_points(models::averages(places));
    expect_finite(found.X_WC.p(), "the camera's pose");
    const models::PointSet again = models::parse_points(models::points_text(places), "again.csv");
    expect(again.size() == places.size(), "what is written of it has another number of places");
    return true;
  };
  return target;
}

Target tracker_log() {
  Target target;
  const std::string head = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm";
  std::string sparse = "# a rig\n" + head + "\n", full = head + ",tool_time_s\n";
  for (int n = 0; n < 120; ++n) {
    sparse += fmt::format("{:.3f},{:.3f},0,0,", n * 1e-3, n * 1e-3) +
              (n % 10 == 0 ? fmt::format("{:.3f},0.1,0\n", n * 1e-3) : ",,\n");
    full += fmt::format("{:.3f},{},0,0,{},0,0,{:.3f}\n", n * 1e-3, n, n / 8, n / 8 * 8e-3);
  }
  target.seeds = {sparse, full};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    const models::TrackerLog log = models::parse_tracker_log(input, "fuzz.csv");
    expect(log.time.size() == log.tip.size() && log.time.size() >= 2, "it has too few rows");
    expect(log.period > 0.0 && std::isfinite(log.period), "its period is no time");
    expect(log.packet_period > 0.0 && std::isfinite(log.packet_period),
           "the period of its packets is no time");
    const models::TipPath path(log);
    for (const models::TrackerPacket& packet : log.packets) {
      expect_finite(packet.tool, "a packet");
      if (path.knows(packet.time)) expect_finite(path.velocity(packet.time), "a velocity");
    }
    return true;
  };
  return target;
}

// 6 s of a pen that swings about its tip.
Target pivot_log() {
  Target target;
  const std::string columns = "time_s,tool,P_x_mm,P_y_mm,P_z_mm,P_qx,P_qy,P_qz,P_qw";
  for (const char* prefix : {"tool", "markers"}) {
    std::string text = std::regex_replace(columns, std::regex("P"), prefix) + "\n";
    for (int n = 0; n < 60; ++n) {
      const double x = 0.3 * std::sin(0.4 * n), y = 0.3 * std::sin(0.3 * n + 1.0);
      const double w = std::sqrt(1.0 - x * x - y * y);
      text += fmt::format("{:.1f},pen,{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},0,{:.6f}\n", 0.1 * n, 200 * w * y,
                          -200 * w * x, 200 * w * w, x, y, w);
    }
    target.seeds.push_back(text);
  }
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    static_cast<void>(models::is_pivot_log(input));
    const models::PivotLog log = models::parse_pivot_log(input, "fuzz.csv");
    for (const models::PivotPose& pose : log.poses)
      expect(pose.X_CT.valid() && std::isfinite(pose.time), "a pose is none");
    const models::PivotFit fit = models::fit_pivot(log.poses);
    expect(fit.point().finite() && fit.dimple.finite() && std::isfinite(fit.rms), "the tip is not finite");
    for (const models::Interval& axis : fit.tip)
      expect(std::isfinite(axis.half), "an interval is not finite");
    return true;
  };
  return target;
}

Target places() {
  Target target;
  target.seeds = {"x_m,y_m,z_m\n0,0,0\n1,-2.5,3e-2\r\n+4,5,6\n\n"};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    for (const Vec3& place : models::parse_places(input, "fuzz.csv"))
      expect(place.allFinite() && place.cwiseAbs().maxCoeff() <= 1e6, "a place is too far away");
    return true;
  };
  return target;
}

const Offer kPlaces("places", &places);
const Offer kLoop("loop", &loop), kPoints("points", &points), kTrackerLog("tracker_log", &tracker_log);
const Offer kPivotLog("pivot_log", &pivot_log);

// ---- A folder of kept frames: each line of the input is the name of a file. An accepted folder is in order.

// A valid name of a file. The command line handles names that move a cursor: it shows paths without such
// characters.
std::string name_of(std::string line) {
  for (char& c : line)
    if (c == '/' || static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > 126) c = '_';
  return line.substr(0, 200);
}

Target frames() {
  Target target;
  target.seeds = {"0.png\n50000000.png\n100000000.png\n", "9223372036854775807.png\n", "1.png\n01.png\n"};
  target.tokens = {".png", ".jpg", ".", "..", "-1", "+1", "9223372036854775808", "1e3", " 1"};
  target.run = [](const std::string& input) {
    static const Folder kFolder;
    const fs::path left = kFolder.path("left");
    fs::remove_all(left);
    fs::create_directory(left);
    std::istringstream lines(input);
    std::string line;
    for (int i = 0; i < 6 && std::getline(lines, line); ++i)
      if (!line.empty() && line != "." && line != "..") std::ofstream(left / name_of(line)) << "";
    const std::vector<Time> exposed = trial::exposures_in(fs::path(left).parent_path().string());
    expect(std::is_sorted(exposed.begin(), exposed.end()), "its times are not in order");
    expect(exposed.front() >= Time(), "a time is negative");
    return true;
  };
  return target;
}

const Offer kFrames("frames", &frames);

}  // namespace
}  // namespace enc::fuzz
