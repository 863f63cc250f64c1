// Meshes of every format: read, welded, checked as solids. An accepted mesh is a closed surface with a
// nearest point, and equals itself when written and read again.
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/shape/surface/mesh_tree.h"
#include "core/shape/surface/triangle.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"
#include "models/shapes/shapes.h"
#include "tests/fuzz/machine/fuzzing.h"
#include "tests/fuzz/targets/seeds.h"
#include "tests/support/scenes.h"
#include "trial/assemble/assemble.h"

namespace enc::fuzz {
namespace {

const Folder& mesh_folder() {
  static const Folder kFolder;
  static const bool kFilled = (kFolder.write("b.bin", std::string(96, '\1')), true);
  static_cast<void>(kFilled);
  return kFolder;
}

// Puts the mesh into a scene, at a size that the machine can hold. If the machine does not reach it, the
// error is one line.
void press(const Mesh& mesh, double radius) {
  static models::Setup setup = mesh_setup();
  ObjectSpec& object = setup.scene.objects.at(0);
  object.surface = std::make_shared<const Mesh>(mesh);
  object.scale = 0.05 / radius;
  try {
    test::Loop loop(trial::prepare_setup(setup));
    loop.tool_tip = Point<'W'>(0, 0, 0.02);
    loop.tick(3);
  } catch (const Error& e) {
    expect(models::printable(e.what()) == e.what(), "an Error of more than one line comes of it");
  }
}

bool sane(models::FileMesh read, const std::string& name) {
  const auto count = static_cast<std::int32_t>(read.mesh.vertices.size());
  for (const auto& triangle : read.mesh.triangles)
    for (const std::int32_t corner : triangle)
      expect(corner >= 0 && corner < count, "a face has a corner that is not there");
  if (read.mesh.triangles.empty()) return true;
  models::weld(read.mesh);
  const Mesh mesh = models::check_mesh(std::move(read.mesh), name, read.lines).mesh;
  for (const auto& vertex : mesh.vertices)
    for (const double x : vertex) expect(std::isfinite(x), "a vertex is not finite");
  const MeshTree tree(mesh);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.01, 0.02, 0.03), Vec3(-1e6, 1e6, 1e6), vec(mesh.vertices[0])}) {
    const SurfacePoint near = tree.nearest(Point<'O'>(p));
    expect(std::isfinite(near.distance) && near.point.finite() && near.normal.finite() && near.feature >= 0,
           "nothing of it is nearest to a place");
  }
  press(mesh, tree.bound().radius);
  const std::string text = models::mesh_bytes(mesh, ".obj");
  const models::FileMesh again = models::read_obj({name, text});
  expect(again.mesh.vertices == mesh.vertices && again.mesh.triangles == mesh.triangles,
         "what is written of it is read as another");
  return true;
}

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

Target obj() {
  Target target;
  target.seeds = {models::mesh_bytes(tetrahedron(), ".obj"),
                  models::mesh_bytes(models::geodesic_ball(1), ".obj"),
                  "o pyramid\nvn 0 0 1\nv 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv .5 .5 +1e0\nf 1/1 2//2 3/1/1 "
                  "4\nf -5 -1 -4\nf 2 5 3 # a\nf 3 5 4\nf 4 5 1\n",
                  "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nv 2 1 3\nf 5 4 3 2 1\nf 1 2 6\nf 2 3 6\nf 3 "
                  "4 6\nf 4 5 6\nf 5 1 6\n"};
  target.tokens = {"v ", "f ",       "f 1 2 3 4 5 6\n", "v 1 1 1\n", "/",     "//", "\\\n",
                   "#",  "vt 0 0\n", "mtllib a\n",      "-1",        "1/1/1", " "};
  target.run = [](const std::string& input) {
    static const std::string kPath = "fuzz.obj";
    return sane(models::read_obj({kPath, input}), kPath);
  };
  return target;
}

std::string ascii_stl() {
  const Mesh mesh = tetrahedron();
  std::string text = "solid a\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const std::int32_t i : t)
      text += fmt::format("  vertex {}\n", fmt::join(mesh.vertices[static_cast<std::size_t>(i)], " "));
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid a\n";
}

Target stl() {
  Target target;
  target.seeds = {ascii_stl(), models::mesh_bytes(tetrahedron(), ".stl"),
                  models::mesh_bytes(models::geodesic_ball(1), ".stl")};
  target.tokens = {"solid",          "endsolid", "facet normal 0 0 0", "outer loop",
                   "vertex 0 0 0\n", "endloop",  "endfacet",           " "};
  target.run = [](const std::string& input) {
    static const std::string kPath = "fuzz.stl";
    return sane(models::read_stl({kPath, input}), kPath);
  };
  // Corrects the count of a binary file.
  target.mend = [](std::string& bytes) {
    if (bytes.size() < 84 || bytes.starts_with("solid")) return;
    const auto count = static_cast<std::uint32_t>((bytes.size() - 84) / 50);
    bytes.resize(84 + 50 * std::size_t{count});
    std::memcpy(bytes.data() + 80, &count, sizeof(count));
  };
  return target;
}

std::string json_of(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof(size));
  return glb.substr(20, size);
}

// Every form of a mesh in glTF: nodes with transforms, a buffer in the text, in a file, strips.
std::string gltf_text(const std::string& buffer, int mode) {
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}},)"
      R"({{"mesh":0,"scale":[1,1,1],"rotation":[0,0,0,1],"translation":[0,0,0.1]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":{}}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},{{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],"buffers":[{{"byteLength":60,"uri":"{}"}}]}})",
      mode, buffer);
}
// Four corners as floats, twelve indices as bytes.
constexpr const char* kInText =
    "data:application/"
    "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAIBAAAIBAAEDAQIDAAMC";

const std::vector<std::string>& gltf_tokens() {
  static const std::vector<std::string> kAll{"{}",
                                             "[]",
                                             "null",
                                             "true",
                                             "\"\"",
                                             ",",
                                             ":",
                                             "\"uri\":\"b.bin\"",
                                             "\"../b.bin\"",
                                             "\"b.bin\"",
                                             "\"/etc/passwd\"",
                                             "data:,",
                                             "5120",
                                             "5121",
                                             "5123",
                                             "5125",
                                             "5126",
                                             "\"VEC3\"",
                                             "\"SCALAR\"",
                                             "\"byteStride\":12,",
                                             "\"byteOffset\":",
                                             "\"sparse\":{\"count\":1},",
                                             "\"images\":[{\"uri\":\"b.bin\"}],",
                                             "\"extensionsRequired\":[\"a\"],",
                                             "\"extensions\":{\"KHR_draco_mesh_compression\":{}},",
                                             "\"children\":[0],",
                                             "\"skin\":0,",
                                             "\"targets\":[{}],",
                                             "\"mode\":5,",
                                             "\"indices\":0,",
                                             "\"mesh\":0,",
                                             "\"bufferView\":0,"};
  return kAll;
}

Target gltf() {
  Target target;
  target.seeds = {gltf_text(kInText, 4), gltf_text(kInText, 5), gltf_text("b.bin", 4),
                  json_of(models::mesh_bytes(tetrahedron(), ".glb"))};
  target.tokens = gltf_tokens();
  target.run = [](const std::string& input) {
    static const std::string kPath = mesh_folder().path("fuzz.gltf");
    return sane(models::read_gltf({kPath, input}, false), kPath);
  };
  target.bound = {512, 4U << 20U};
  return target;
}

Target glb() {
  Target target;
  target.seeds = {models::mesh_bytes(tetrahedron(), ".glb"),
                  models::mesh_bytes(models::geodesic_ball(1), ".glb")};
  target.tokens = gltf_tokens();
  target.run = [](const std::string& input) {
    static const std::string kPath = mesh_folder().path("fuzz.glb");
    return sane(models::read_gltf({kPath, input}, true), kPath);
  };
  // Corrects the lengths: the JSON ends with its last brace, or where BIN begins.
  target.mend = [](std::string& bytes) {
    if (bytes.size() < 20) return;
    const auto put = [&](std::size_t at, std::size_t value) {
      const auto word = static_cast<std::uint32_t>(value);
      std::memcpy(bytes.data() + at, &word, sizeof(word));
    };
    put(8, bytes.size());
    const std::size_t bin = bytes.find(std::string("BIN\0", 4), 20);
    if (bin == std::string::npos || bin < 24) return put(12, bytes.size() - 20);
    put(12, bin - 24);
    put(bin - 4, bytes.size() - bin - 4);
  };
  target.bound = {512, 4U << 20U};
  return target;
}

const Offer kObj("obj", &obj), kStl("stl", &stl), kGltf("gltf", &gltf), kGlb("glb", &glb);

}  // namespace
}  // namespace enc::fuzz
