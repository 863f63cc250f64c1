// Mesh files that are wrong: each is refused by the program with exit code 2 and one line that names the
// file.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "models/mesh_files/mesh_write.h"
#include "tests/support/built.h"
#include "tests/support/replaced.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using test::replaced;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A tetrahedron.
Mesh good() {
  return {{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}
std::string bytes(const std::string& ending) { return models::mesh_bytes(good(), ending); }
std::string put(std::string text, std::size_t at, std::uint32_t word) {
  std::memcpy(text.data() + at, &word, sizeof(word));
  return text;
}
// A word of the tetrahedron's .glb, found from the end: 12 indices of two bytes after 12 floats.
std::string with_float(std::size_t i, float value) {
  std::string text = bytes(".glb");
  std::memcpy(text.data() + text.size() - 24 - 48 + 4 * i, &value, sizeof(value));
  return text;
}
std::string with_index(std::uint16_t value) {
  std::string text = bytes(".glb");
  std::memcpy(text.data() + text.size() - 24, &value, sizeof(value));
  return text;
}
// The tetrahedron as .gltf, its numbers as a data URI, with one part of the JSON changed.
std::string gltf(const std::string& from = "{", const std::string& to = "{") {
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  return replaced(json, from, to);
}
constexpr const char* kUri =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

struct Bad {
  const char* name;
  const char* file;
  std::string content;
  const char* words;  // a part of the line
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadMesh : public ::testing::TestWithParam<Bad> {
 protected:
  BadMesh() { std::ofstream(folder_ / "points.csv") << "x_m,y_m,z_m\n0,0,0\n"; }
  void expect_refused(const std::string& path, const std::string& words) const {
    const Result r = run_program({"nearest", path, (folder_ / "points.csv").string()});
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(r.out, "");
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    EXPECT_THAT(r.err, StartsWith("encounter: " + path + ":"));
    EXPECT_THAT(r.err, HasSubstr(words));
  }
  test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

TEST_P(BadMesh, IsRefusedInOneLine) {
  const fs::path path = folder_ / GetParam().file;
  std::ofstream(path, std::ios::binary) << GetParam().content;
  expect_refused(path.string(), GetParam().words);
}

// Many nodes with one mesh: what is read grows with them, and so must the time, not with their square.
std::string many_nodes(int count) {
  std::string nodes, roots;
  for (int i = 0; i < count; ++i) {
    nodes += i > 0 ? R"(,{"mesh":0})" : R"({"mesh":0})";
    roots += (i > 0 ? "," : "") + std::to_string(i);
  }
  return replaced(gltf(R"("nodes":[0])", R"("nodes":[)" + roots + "]"), R"([{"mesh":0}])", "[" + nodes + "]");
}

constexpr const char* kOpen = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
std::string obj(const std::string& more) { return kOpen + more; }
const std::string kClosed = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

std::vector<Bad> bad_glb() {
  const std::string whole = bytes(".glb");
  const std::size_t json = whole.find("BIN") - 24;  // its chunk ends 4 bytes before
  return {
      {"CutInMagic", "a.glb", whole.substr(0, 3), "byte 0: this is no .glb"},
      {"CutInHeader", "a.glb", whole.substr(0, 15), "ends in its header"},
      {"CutInJson", "a.glb", whole.substr(0, 100), "byte 8"},
      {"CutInBinary", "a.glb", whole.substr(0, whole.size() - 10), "byte 8"},
      {"CutInBinaryAndSaysSo", "a.glb",
       put(whole.substr(0, whole.size() - 12), 8, static_cast<std::uint32_t>(whole.size() - 12)),
       "a chunk of"},
      // tinygltf 2.7 alone would read 8 bytes beyond the end here.
      {"ChunkLongerByItsHead", "a.glb",
       put(whole, 20 + json, static_cast<std::uint32_t>(whole.size() - 20 - json)), "a chunk of"},
      {"HugeJsonChunk", "a.glb", put(whole, 12, 0xfffffff0U), "a JSON chunk of"},
      {"WrongMagic", "a.glb", "Not" + whole.substr(3), "this is no .glb"},
      {"WrongVersion", "a.glb", put(whole, 4, 1), "glTF version 1"},
      {"NanPosition", "a.glb", with_float(4, std::numeric_limits<float>::quiet_NaN()),
       "vertex 1 of accessors[0]"},
      {"InfinitePosition", "a.glb", with_float(0, std::numeric_limits<float>::infinity()), "is not finite"},
      {"IndexOutOfRange", "a.glb", with_index(4), "index 0 of accessors[1] is 4"}};
}

std::vector<Bad> bad_gltf() {
  std::string deep(100000, '[');
  return {
      {"BadJson", "a.gltf", "{\"asset\": {\n  \"version\" 2}", "a.gltf:2:"},
      {"NoGltfAtAll", "a.gltf", "hello, world", "cannot be read"},
      {"NestedForEver", "a.gltf", "{\"extras\":" + deep, "nested 101 deep"},
      {"CyclicNodes", "a.gltf", gltf("[{\"mesh\":0}]", "[{\"mesh\":0,\"children\":[1]},{\"children\":[0]}]"),
       "nodes[0] is met twice"},
      {"OwnChild", "a.gltf", gltf("[{\"mesh\":0}]", "[{\"mesh\":0,\"children\":[0]}]"),
       "nodes[0] is met twice"},
      {"NoSuchNode", "a.gltf", gltf("\"nodes\":[0]", "\"nodes\":[7]"), "nodes[7] is not there"},
      {"NoSuchMesh", "a.gltf", gltf("\"mesh\":0", "\"mesh\":9"), "meshes[9] is not there"},
      {"NoSuchAccessor", "a.gltf", gltf("\"POSITION\":0", "\"POSITION\":-3"), "accessors[-3] is not there"},
      {"NoPosition", "a.gltf", gltf("\"POSITION\"", "\"NORMAL\""), "without POSITION"},
      {"PositionOfBytes", "a.gltf", gltf("5126", "5121"), "expected VEC3 of float"},
      {"UnknownComponent", "a.gltf", gltf("5126", "99"), "Invalid `componentType`"},
      {"HugeCount", "a.gltf", gltf("\"count\":3", "\"count\":4000000000000"), "accessors[0]"},
      {"HugeView", "a.gltf",
       gltf("\"buffer\":0,\"byteLength\":36", "\"buffer\":0,\"byteLength\":99999999999"), "bufferViews[0]"},
      {"HugeOffset", "a.gltf", gltf("\"buffer\":0,", "\"buffer\":0,\"byteOffset\":18446744073709551615,"),
       "bufferViews[0]"},
      {"HugeBuffer", "a.gltf", gltf("[{\"byteLength\":36", "[{\"byteLength\":99999999999999"),
       "cannot be read"},
      {"NoSuchFile", "a.gltf", gltf(kUri, "data.bin"), "File not found : data.bin"},
      {"ImageUpwards", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"images\":[{\"uri\":\"../../etc/passwd\"}],"),
       "outside of its folder"},
      {"PathUpwards", "a.gltf", gltf(kUri, "../../../../../../etc/passwd"), "outside of its folder"},
      {"PathAbsolute", "a.gltf", gltf(kUri, "/etc/passwd"), "'/etc/passwd', which is outside"},
      {"Sparse", "a.gltf",
       gltf("\"count\":3,",
            "\"count\":3,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5123},"
            "\"values\":{\"bufferView\":0}},"),
       "sparse"},
      {"Draco", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],"),
       "compressed with Draco ('KHR_draco_mesh_compression'); expected plain glTF 2.0; export it without"},
      {"DracoWithoutItsData", "a.gltf",
       replaced(gltf("\"bufferView\":0,\"componentType\"", "\"componentType\""), "\"scene\":0,",
                "\"extensionsRequired\" : [ \"KHR_texture_transform\", \"KHR_draco_mesh_compression\" ],"),
       "a.gltf:1:51: the mesh is compressed with Draco"},
      {"Meshopt", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"EXT_meshopt_compression\"],"),
       "compressed with meshopt ('EXT_meshopt_compression')"},
      {"Quantised", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_mesh_quantization\"],"), "quantised"},
      {"UnknownExtension", "a.gltf",
       gltf("\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"ACME_bend\"],"),
       "requires the extension 'ACME_bend'"},
      {"Skewed", "a.gltf", gltf("{\"mesh\":0}", "{\"mesh\":0,\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}"),
       "perspective"},
      {"OneTriangle", "a.gltf", gltf(), "face 0 at a hole"},
      {"ManyNodes", "a.gltf", many_nodes(30'000), "doubled: another face"}};
}

std::vector<Bad> bad_others() {
  const std::string stl = bytes(".stl");
  return {
      {"Empty", "a.obj", "", "it is empty"},
      {"NoTriangles", "a.obj", obj(""), "no triangles"},
      {"UnknownEnding", "a.ply", "ply", "is no ending of a mesh file"},
      {"ObjIndexZero", "a.obj", obj("f 0 1 2\n"), "a.obj:5:3: vertex 0"},
      {"ObjIndexBeyond", "a.obj", obj("f 1 2 5\n"), "a.obj:5:7: vertex 5"},
      {"ObjIndexBeyondBackwards", "a.obj", obj("f -1 -2 -5\n"), "vertex -5"},
      {"ObjTextInNumber", "a.obj", obj("v 1 2 x3\n"), "a.obj:5:7: 'x3'"},
      {"ObjNan", "a.obj", obj("v 1 nan 3\n"), "'nan' is no coordinate"},
      {"ObjShortVertex", "a.obj", obj("v 1 2\n"), "is no coordinate"},
      {"ObjTwoCorners", "a.obj", obj("f 1 2\n"), "2 corners"},
      {"ObjContinued", "a.obj", obj("f 1 2 \\\n3\n"), "a.obj:5:7: a line that goes on"},
      {"ObjGarbage", "a.obj", "hello\n", "a.obj:1:1: 'hello'"},
      {"Open", "a.obj", obj("f 1 3 2\nf 1 2 4\nf 2 3 4\n"), "a.obj:5: faces of lines 5, 6 and 7 at a hole"},
      {"Doubled", "a.obj", obj(kClosed + "f 1 3 2\n"), "doubled"},
      {"NonManifold", "a.obj", obj("v 0.1 -1 -1\n" + kClosed + "f 1 2 5\n"), "non-manifold"},
      {"BowTie", "a.obj",
       obj("v -1 0 0\nv 0 -1 0\nv 0 0 -1\n" + kClosed + "f 1 5 6\nf 1 7 5\nf 5 7 6\nf 1 6 7\n"),
       "meet in a point"},
      {"FlatFace", "a.obj",
       "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 5\nf 1 5 4\nf 3 4 5\n",
       "a.obj:6: face of line 6 of zero area"},
      {"ThroughItself", "a.obj",
       obj("v 0.1 0.1 0.1\nv 1.1 0.1 0.1\nv 0.1 1.1 0.1\nv 0.1 0.1 1.1\n" + kClosed +
           "f 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n"),
       "passing through other faces"},
      {"FarVertex", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e20 0\nv 0 0 1\n" + kClosed,
       "vertex 2 is at y = 1e+20 m; expected at most 1e+06 m from the origin"},
      {"ObjFaceNotFlat", "a.obj", obj("v 1 1 1\nf 1 2 5 3\n"), "a.obj:6:1: a face that is not flat"},
      {"ObjFaceCrossesItself", "a.obj", obj("v 2 2 0\nv 3 0 0\nf 1 5 2 3 6\n"),
       "a.obj:7:1: a face whose sides cross"},
      {"ObjFaceTouchesItself", "a.obj", obj("v 0.5 0 0\nv 1 1 0\nf 1 2 6 5 3\n"),
       "a.obj:7:1: a face whose sides cross or touch"},
      {"ObjFaceBowTie", "a.obj", obj("v 1 1 0\nf 1 5 2 3\n"), "a.obj:6:1: a face of no area"},
      {"FaceToFace", "a.obj",
       obj("v 0.2 0.2 0\nv 0.4 0.2 0\nv 0.2 0.4 0\nv 0.2 0.2 -1\n" + kClosed +
           "f 5 6 7\nf 5 8 6\nf 6 8 7\nf 5 7 8\n"),
       "a.obj:9: faces of lines 9, 13 and 3 more touching others (the first face of line 1"},
      {"StlWrongCount", "a.stl", put(stl, 80, 5),
       "byte 80: the file says 5 triangles, but its 284 bytes fit 4"},
      {"StlHugeCount", "a.stl", put(stl, 80, 0xffffffffU), "the file says 4294967295 triangles"},
      {"StlCut", "a.stl", stl.substr(0, stl.size() - 7), "byte 80"},
      {"StlNan", "a.stl", put(stl, 84 + 12, 0x7fc00000U), "byte 96"},
      {"StlTextCut", "a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0",
       "the file ends here"},
      {"StlTextOutOfPlace", "a.stl", "solid x\nfacet normal 0 0 1\nouter lop\n",
       "a.stl:3:7: 'lop' is out of place"},
      {"StlTextNumber", "a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n",
       "a.stl:4:10: 'zero'"}};
}

const auto kName = [](const auto& tested) { return std::string(tested.param.name); };
INSTANTIATE_TEST_SUITE_P(Glb, BadMesh, ::testing::ValuesIn(bad_glb()), kName);
INSTANTIATE_TEST_SUITE_P(Gltf, BadMesh, ::testing::ValuesIn(bad_gltf()), kName);
INSTANTIATE_TEST_SUITE_P(Others, BadMesh, ::testing::ValuesIn(bad_others()), kName);

using BadPlace = BadMesh;

// A mesh that reaches as far as it may has an answer, and one that its scene makes larger is refused there.
TEST_F(BadPlace, AsFarAsItMayAndNoFarther) {
  const fs::path path = folder_ / "a.obj";
  std::ofstream(path) << "v 0 0 0\nv 1e6 0 0\nv 0 1e6 0\nv 0 0 1e6\n" << kClosed;
  const Result far = run_program({"nearest", path.string(), (folder_ / "points.csv").string()});
  EXPECT_EQ(far.code, 0) << far.err;
  EXPECT_THAT(far.out, HasSubstr("\n-0,0,0,0,-0.577"));
  const Result scaled = run_program(
      {"check", std::string(source_dir()) + "/models/scenes/hare.toml", "--set", "object.hare.scale=1e9"});
  EXPECT_EQ(scaled.code, 2) << scaled.out;
  EXPECT_THAT(scaled.err, HasSubstr("with this scale the mesh reaches beyond 1000 km"));
}

TEST_F(BadPlace, AFolderAndNothing) {
  fs::create_directory(folder_ / "folder.glb");
  expect_refused((folder_ / "folder.glb").string(), "it is a folder");
  expect_refused((folder_ / "none.glb").string(), "there is no such file");
}

TEST_F(BadPlace, ALinkOutOfTheFolder) {
  fs::create_directory(folder_ / "mesh");
  std::ofstream(folder_ / "outside.bin") << std::string(36, '\0');
  fs::create_symlink("../outside.bin", folder_ / "mesh" / "data.bin");
  std::ofstream(folder_ / "mesh" / "a.gltf") << gltf(kUri, "data.bin");
  expect_refused((folder_ / "mesh" / "a.gltf").string(), "outside of its folder");
}

TEST_F(BadPlace, PointsThatAreWrong) {
  const std::string path = (folder_ / "a.glb").string(), csv = (folder_ / "bad.csv").string();
  models::write_mesh(good(), path);
  const auto refused = [&](const std::string& text, const std::string& words) {
    std::ofstream(csv) << text;
    const Result r = run_program({"nearest", path, csv});
    EXPECT_EQ(r.code, 2);
    EXPECT_EQ(r.out, "");
    EXPECT_THAT(r.err, StartsWith("encounter: " + csv + words));
  };
  refused("x,y,z\n0,0,0\n", ":1:1: the header");
  refused("x_m,y_m,z_m\n0,0,0\n1,two,3\n", ":3:3: 'two' is no number");
  refused("x_m,y_m,z_m\n0,0\n", ":2:");
  refused("x_m,y_m,z_m\n0,0,0,0\n", ":2:6: more than three");
  refused("x_m,y_m,z_m\n0,0,inf\n", ":2:5: 'inf'");
}

}  // namespace
}  // namespace enc::tests
