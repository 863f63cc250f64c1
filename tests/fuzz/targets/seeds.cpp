#include "tests/fuzz/targets/seeds.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/record/replay.h"
#include "models/mesh_files/mesh_file.h"
#include "models/shapes/shapes.h"
#include "tests/fuzz/machine/fuzzing.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "trial/assemble/assemble.h"
#include "trial/mcap/mcap_writer.h"
#include "trial/mcap/record_mcap.h"
#include "trial/measure/record_table.h"

namespace enc::fuzz {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = tests::source_dir();

}  // namespace

std::string file_text(const std::string& name) { return test::bytes_of(kRoot / name); }

std::vector<std::string> file_texts(const std::string& folder, const std::string& ending, std::size_t most) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(kRoot / folder))
    if (entry.path().extension() == ending && entry.file_size() <= most) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const fs::path& path : paths) texts.push_back(test::bytes_of(path));
  return texts;
}

std::string mesh_scene() {
  std::string text = file_text("models/scenes/hare.toml");
  const std::string mesh = "hare.glb\"";
  return text.replace(text.find(mesh), mesh.size(), "small.obj\"");
}
std::string small_mesh() { return models::mesh_bytes(models::geodesic_ball(2), ".obj"); }

models::Setup mesh_setup() {
  const ModelsFolder models;
  return models::load(models.write("scenes/a.toml", mesh_scene()), "");
}

void use(const models::Setup& setup, RecordReader& record) {
  const Scene scene = trial::prepare_setup(setup);
  for (const Object& object : scene.objects)
    for (const Point<'O'>& p : {Point<'O'>(0, 0, 0), Point<'O'>(0.01, 0.02, 0.03), Point<'O'>(0, 0, -1e6)}) {
      const SurfacePoint near = object.surface.nearest(p);
      expect(std::isfinite(near.distance) && near.point.finite() && near.normal.finite(),
             "nothing of an object is nearest to a place");
    }
  static_cast<void>(replay(scene, record));
  trial::RecordTable table(setup, scene);
  trial::McapWriter file([](std::string_view) {}, "fuzz");
  trial::RecordMcap mcap(file, setup, scene, record.texts());
  RecordedTick frame;
  for (record.rewind(); record.next(frame); mcap.add(frame))
    static_cast<void>(table.row(frame.tick, frame.in, frame.out));
  mcap.end(record.end_texts(), "whole");
}

const std::vector<std::string>& jpeg_tokens() {
  static const std::vector<std::string> kAll{"\xff\xd8",
                                             "\xff\xd9",
                                             "\xff\xda",
                                             "\xff\xc0",
                                             "\xff\xc2",
                                             "\xff\xc4",
                                             "\xff\xdb",
                                             "\xff\xdd",
                                             "\xff\xd0",
                                             "\xff\xe0",
                                             std::string("\xff\0", 2)};
  return kAll;
}

const std::vector<std::string>& toml_tokens() {
  static const std::vector<std::string> kAll{"true",
                                             "false",
                                             "1979-05-27",
                                             "07:32:00Z",
                                             "{}",
                                             "[]",
                                             "[[]]",
                                             "[0, 0, 0]",
                                             "[nan, inf, -inf]",
                                             "\"\"",
                                             "\"\"\"",
                                             "'''",
                                             "\"\\u0000\"",
                                             "\"\\n\"",
                                             "\"\\U00110000\"",
                                             "\"a/b\"",
                                             "\"..\"",
                                             "\"/\"",
                                             "name = \"a\"\n",
                                             "format = 2\n",
                                             " = ",
                                             ".",
                                             "#",
                                             "[[object]]\n",
                                             "[[tool]]\n",
                                             "[[behaviour]]\n",
                                             "[camera]\n",
                                             "[rig]\n",
                                             "[truth]\n",
                                             "[arm]\n",
                                             "[manipulator]\n",
                                             "[user]\n",
                                             "[session]\n",
                                             "[driver.sample]\n",
                                             "a.b.c.d = 1\n",
                                             "mesh = \"small.obj\"\n",
                                             "shape = \"mesh\"\n",
                                             "shape = \"plane\"\n",
                                             "shape = \"sphere\"\n",
                                             "shape = \"box\"\n",
                                             "1e-9",
                                             "1e9",
                                             "1e-300",
                                             "0x7fffffffffffffff",
                                             "1_000",
                                             "0b1"};
  return kAll;
}

Folder::Folder() {
  std::error_code none;
  const fs::path memory = "/dev/shm";
  std::string name =
      ((fs::is_directory(memory, none) ? memory : fs::temp_directory_path()) / "encounter_fuzz_XXXXXX")
          .string();
  if (mkdtemp(name.data()) == nullptr) std::abort();  // no target can continue without it
  root_ = name;
}

Folder::~Folder() {
  std::error_code none;
  fs::remove_all(root_, none);
}

ModelsFolder::ModelsFolder() {
  for (const auto& entry : fs::directory_iterator(kRoot / "models")) {
    const std::string name = entry.path().filename().string();
    if (name.find("toml") != std::string::npos) fs::create_symlink(entry.path(), path(name));
    if (!entry.is_directory()) continue;
    fs::create_directory(path(name));
    for (const auto& file : fs::directory_iterator(entry.path()))
      fs::create_symlink(file.path(), path(name + '/' + file.path().filename().string()));
  }
  write("scenes/small.obj", small_mesh());  // beside the scenes that name it
}

std::string Folder::write(const std::string& name, const std::string& bytes) const {
  const fs::path path = root_ / name;
  if (fs::is_symlink(path)) fs::remove(path);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  return path.string();
}

}  // namespace enc::fuzz
