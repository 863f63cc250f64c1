// The calibrations of a stereo head and of a rig, a record, and what a record holds.
#include <cstring>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/record/record.h"
#include "models/setup/rig_calibration.h"
#include "models/setup/scene_file.h"
#include "models/setup/stereo_file.h"
#include "tests/fuzz/machine/target.h"
#include "tests/fuzz/targets/seeds.h"
#include "tests/support/bytes_of.h"
#include "tests/support/scenes.h"
#include "trial/assemble/prepare.h"

namespace enc::fuzz {
namespace {

// A file that is written and read again is the same.
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
      throw Broken(fmt::format("what is written of it is refused: {}", e.what()));
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
// ---------------------------------------------------------------------------------------------------------

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

// Checksums as RecordReader wants them, part by part, as far as the sizes lead.
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

// Also on to where its numbers go; a record without a scene is only read.
void read_all(const std::string& path, Partial partial) {
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
  // Of another layout, by a version that wants two lines.
  target.seeds.push_back(small_record(ball, 1, {{"version", "9\n8"}}, {}));
  target.seeds.back()[16] ^= 1;
  seal_again(target.seeds.back());
  // With its scene; mostly ticks, so that most of what is spoiled is in them.
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
      read_all(path, Partial::no);
    } catch (const Error&) {
      read_all(path, Partial::yes);
      throw;
    }
    return true;
  };
  target.mend = &seal_again;
  return target;
}

// The mesh that a record holds beside its scene. Its hash is left out, or no other mesh were taken.
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

}  // namespace
}  // namespace enc::fuzz
