// Valid mesh files: every format and index type, transforms by hand, and repairs.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/frames.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/shapes/shapes.h"
#include "models/sizes/mesh_size.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Point3 = std::array<double, 3>;

class MeshFiles : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }
  test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

// Corners with coordinates that are exact as float and double.
Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}
const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 4\n";

double volume(const Mesh& mesh) {
  double six = 0.0;
  const auto at = [&](std::int32_t i) { return Vec3(mesh.vertices[static_cast<std::size_t>(i)].data()); };
  for (const auto& t : mesh.triangles) six += at(t[0]).dot(at(t[1]).cross(at(t[2])));
  return six / 6.0;
}

TEST_F(MeshFiles, AMeshWithoutFacesIsNoSolid) {
  EXPECT_THROW((void)check_mesh({}, "m"), Error);
  EXPECT_THROW((void)check_mesh({tetrahedron().vertices, {}}, "m"), Error);
}

TEST_F(MeshFiles, WhatIsWrittenIsReadAgain) {
  const Mesh mesh = tetrahedron();
  for (const char* ending : {".glb", ".obj"}) {
    const Mesh read = load_mesh(file(std::string("a") + ending, mesh_bytes(mesh, ending)));
    EXPECT_EQ(read.vertices, mesh.vertices) << ending;
    EXPECT_EQ(read.triangles, mesh.triangles) << ending;
    EXPECT_EQ(content_hash(read), content_hash(mesh));
  }
  const Mesh stl =
      load_mesh(file("a.stl", mesh_bytes(mesh, ".stl")));  // its vertices come in the order of the faces
  EXPECT_EQ(stl.vertices.size(), 4U);
  EXPECT_EQ(stl.triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(volume(stl), 8.0 / 6.0);
}

TEST_F(MeshFiles, ObjInAllItsForms) {
  const std::string text =
      "# a comment\r\no thing\nvn 0 0 1\n" + kVertices +
      "vt 0 0\nf 1/1 3/1 2/1\nf 1//1 2//1 4//1 # more\nf -3/1/1 -2/1/1 -1/1/1\n\tf 1 4 3\n";
  EXPECT_EQ(load_mesh(file("a.obj", text)).triangles, tetrahedron().triangles);
  // A square pyramid: a convex face becomes a fan around its first corner.
  const Mesh fan = load_mesh(file("b.obj",
                                  "v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv .5 .5 +1e0\nf 1 2 3 4\n"
                                  "f 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n"));
  EXPECT_THAT(fan.triangles[0], ElementsAre(0, 1, 2));
  EXPECT_THAT(fan.triangles[1], ElementsAre(0, 2, 3));
  EXPECT_EQ(fan.vertices[4], (Point3{0.5, 0.5, 1.0}));
  EXPECT_TRUE(check_mesh(fan, "fan").notes.empty());
}

// A prism 1 high over a polygon of the x-y plane, as .obj; its first corner is `first`.
std::string prism_obj(const std::vector<std::array<double, 2>>& corners, std::size_t first) {
  std::string text, base = "f", top = "f";
  const std::size_t n = corners.size();
  for (const int z : {0, 1})
    for (const auto& c : corners)
      text += "v " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(z) + "\n";
  for (std::size_t i = 0; i < n; ++i) {
    base += " " + std::to_string((first + n - i) % n + 1);
    top += " " + std::to_string(n + (first + i) % n + 1);
    const std::size_t a = i + 1, b = (i + 1) % n + 1;
    text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + n) + " " +
            std::to_string(a + n) + "\n";
  }
  return text + base + "\n" + top + "\n";
}

// Polygons with any first corner: an L, a comb, a star, one with corners along its sides, a spiral.
TEST_F(MeshFiles, PolygonsThatAreNotConvex) {
  const std::vector<std::pair<std::vector<std::array<double, 2>>, double>> shapes{
      {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 4.0},
      {{{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {4, 1}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}},
       13.0},
      {{{0, -3}, {1, -1}, {3, 0}, {1, 1}, {0, 3}, {-1, 1}, {-3, 0}, {-1, -1}}, 12.0},
      {{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}, 4.0},
      {{{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2}, {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}},
       15.0}};
  for (const auto& [corners, area] : shapes)
    for (std::size_t first = 0; first < corners.size(); ++first) {
      const CheckedMesh checked = load_solid(file("a.obj", prism_obj(corners, first)));
      EXPECT_TRUE(checked.notes.empty());
      EXPECT_EQ(checked.mesh.triangles.size(), 2 * (corners.size() - 2) + 2 * corners.size());
      EXPECT_NEAR(volume(checked.mesh), area, 1e-12);
    }
}

TEST_F(MeshFiles, FacesOfAnObjAreNamedByTheirLines) {
  const std::string text = prism_obj({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 0);
  const auto said = [&](const std::string& content) -> std::string {
    try {
      (void)load_solid(file("a.obj", content));
    } catch (const Error& e) {
      return std::string(e.what()).substr(folder_.string().size() + 1);
    }
    return "taken";
  };
  // The mesh lacks its last face, the top: the walls of lines 13 to 18 end at a hole.
  EXPECT_THAT(said(text.substr(0, text.rfind("f "))),
              ::testing::StartsWith("a.obj:13: faces of lines 13, 14 and 4 more at a hole"));
  // The base twice: two or more triangles of one line are one face.
  const std::size_t base = text.rfind("f ", text.rfind("f ") - 1), end = text.rfind("f ");
  EXPECT_THAT(said(text + text.substr(base, end - base)),
              ::testing::StartsWith("a.obj:21: face of line 21 doubled"));
  const CheckedMesh checked =
      load_solid(file("b.obj", kVertices + "f 1 3 2\nf 1 2 4\nf 1 1 1\nf 2 3 4\nf 1 4 3\n"));
  EXPECT_THAT(checked.notes, ElementsAre(HasSubstr("removed face of line 7 of zero area")));
}

TEST_F(MeshFiles, StlAsText) {
  const Mesh mesh =
      load_mesh(file("a.stl",
                     "solid two words\nFACET NORMAL 0 0 1\n outer loop\n vertex 0 0 -0\n vertex 1 0 0\n"
                     " vertex 0 1 0\n endloop\n endfacet\nfacet normal 0 0 0 outer loop vertex 0 0 0 "
                     "vertex 0 1 0 vertex 0 0 1e-1 endloop endfacet\nendsolid two words\n"));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.vertices.size(), 4U) << "welded, -0 as 0";
  EXPECT_EQ(mesh.vertices[3], (Point3{0, 0, 0.1}));
}

// A glTF of one mesh in two nodes: the tetrahedron's four vertices and its indices with `size` bytes each.
std::string gltf_bytes(std::size_t size, bool indexed = true) {
  std::string data;
  const Mesh mesh = tetrahedron();
  const auto point = [&](std::int32_t i) {
    for (const double x : mesh.vertices[static_cast<std::size_t>(i)]) {
      const auto value = static_cast<float>(x);
      data.append(reinterpret_cast<const char*>(&value), 4);
    }
  };
  for (std::int32_t i = 0; indexed && i < 4; ++i) point(i);
  for (const auto& t : mesh.triangles)
    for (const std::int32_t corner : t) {
      if (indexed)
        data.append(reinterpret_cast<const char*>(&corner), size);
      else
        point(corner);
    }
  return data;
}
std::string gltf_json(std::size_t bytes, int component, bool indexed, const std::string& nodes,
                      const std::string& uri) {
  const std::string count = indexed ? "4" : "12";
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"images":[{"uri":"none.png"}],"nodes":)" +
      nodes + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0})" +
      (indexed ? R"(,"indices":1)" : "") +
      R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" + count + R"(,"type":"VEC3"})";
  if (indexed)
    json += R"(,{"bufferView":1,"componentType":)" + std::to_string(component) +
            R"(,"count":12,"type":"SCALAR"})";
  json += R"(],"bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(indexed ? 48 : bytes) + "}";
  if (indexed) json += R"(,{"buffer":0,"byteOffset":48,"byteLength":)" + std::to_string(bytes - 48) + "}";
  return json + R"(],"buffers":[{"byteLength":)" + std::to_string(bytes) + R"(,"uri":")" + uri + R"("}]})";
}

TEST_F(MeshFiles, GltfIndicesOfEveryTypeAndNone) {
  for (const auto& [component, size] :
       {std::pair{5121, std::size_t{1}}, {5123, std::size_t{2}}, {5125, std::size_t{4}}}) {
    const std::string data = gltf_bytes(size);
    file("data.bin", data);
    const Mesh mesh =
        load_mesh(file("a.gltf", gltf_json(data.size(), component, true, "[{\"mesh\":0}]", "data.bin")));
    EXPECT_EQ(mesh.vertices, tetrahedron().vertices) << component;
    EXPECT_EQ(mesh.triangles, tetrahedron().triangles) << component;
  }
  const std::string data = gltf_bytes(0, false);
  file("data.bin", data);
  const Mesh mesh = load_mesh(file("a.gltf", gltf_json(data.size(), 0, false, "[{\"mesh\":0}]", "data.bin")));
  EXPECT_EQ(mesh.vertices.size(), 4U) << "seams are welded";
  EXPECT_DOUBLE_EQ(volume(mesh), 8.0 / 6.0);
}

TEST_F(MeshFiles, GltfTransformsGoThroughTheTree) {
  const std::string data = gltf_bytes(1);
  file("data.bin", data);
  const auto placed = [&](const std::string& nodes) {
    return load_mesh(file("a.gltf", gltf_json(data.size(), 5121, true, nodes, "data.bin")));
  };
  // Parent: 10 along x. Child: twice as large, turned by 90 degrees about z, so x becomes y. (1, 0, 0) ->
  // (10, 2, 0).
  const Mesh turned =
      placed(R"([{"translation":[10,0,0],"children":[1]},)"
             R"({"mesh":0,"scale":[2,2,2],"rotation":[0,0,0.70710678118654752,0.70710678118654752]}])");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(turned.vertices[1][i], (std::array{10.0, 2.0, 0.0})[i], 1e-15);
  EXPECT_NEAR(volume(turned), 8.0 * 8.0 / 6.0, 1e-13);
  // A matrix is stored by columns: the last four are the shift.
  const Mesh shifted = placed(R"([{"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}])");
  EXPECT_EQ(shifted.vertices[3], (Point3{5, 6, 11}));
  // A mirror turns every triangle around, so that out stays out.
  const Mesh mirrored = placed(R"([{"mesh":0,"scale":[-1,1,1]}])");
  EXPECT_EQ(mirrored.vertices[1], (Point3{-1, 0, 0}));
  EXPECT_DOUBLE_EQ(volume(mirrored), 8.0 / 6.0);
}

TEST_F(MeshFiles, TheMaterialOfAGltfIsThatOfMostTriangles) {
  const std::string data = gltf_bytes(1);
  file("data.bin", data);
  const auto with = [&](const std::string& materials, int index) {
    std::string json = gltf_json(data.size(), 5121, true, "[{\"mesh\":0}]", "data.bin");
    const std::string primitive = "\"indices\":";
    json.replace(json.find(primitive), 0, "\"material\":" + std::to_string(index) + ",");
    json.insert(json.rfind('}'), ",\"materials\":" + materials);
    return load_faces(file("a.gltf", json)).material;
  };
  const std::string both =
      "[{},{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0,0.25],\"metallicFactor\":0.5,"
      "\"roughnessFactor\":0.75},\"alphaMode\":\"BLEND\"}]";
  const std::optional<SurfaceMaterial> second = with(both, 1);
  ASSERT_TRUE(second);
  EXPECT_FLOAT_EQ(second->colour[0], 1.0F);
  EXPECT_NEAR(second->colour[1], 0.7297F, 1e-3F);  // the file's colour is linear in light
  EXPECT_FLOAT_EQ(second->colour[2], 0.0F);
  EXPECT_FLOAT_EQ(second->metallic, 0.5F);
  EXPECT_FLOAT_EQ(second->roughness, 0.75F);
  EXPECT_FLOAT_EQ(second->opacity, 0.25F);
  const std::string opaque = "[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,0]}}]";
  EXPECT_FLOAT_EQ(with(opaque, 0)->opacity, 1.0F) << "OPAQUE, the default, ignores it";
  EXPECT_FALSE(with(both, 7)) << "a picture is no reason to refuse a mesh";
  EXPECT_FALSE(
      load_faces(file("b.gltf", gltf_json(data.size(), 5121, true, "[{\"mesh\":0}]", "data.bin"))).material);
}

TEST(MeshCheck, RepairsWithAWordWhatIsSafe) {
  Mesh inverted = tetrahedron();
  for (auto& t : inverted.triangles) std::swap(t[1], t[2]);
  CheckedMesh checked = check_mesh(inverted, "m");
  EXPECT_THAT(checked.notes, ElementsAre(HasSubstr("inside out")));
  EXPECT_DOUBLE_EQ(volume(checked.mesh), 8.0 / 6.0);

  Mesh one = tetrahedron();
  std::swap(one.triangles[2][0], one.triangles[2][1]);
  checked = check_mesh(one, "m");
  EXPECT_THAT(checked.notes, ElementsAre("m: turned face 2 to run the same way as their neighbours"));
  EXPECT_DOUBLE_EQ(volume(checked.mesh), 8.0 / 6.0);

  Mesh more = tetrahedron();
  more.triangles.insert(more.triangles.begin(), {1, 1, 2});
  more.vertices.push_back({9, 9, 9});
  checked = check_mesh(more, "m");
  EXPECT_THAT(checked.notes, ElementsAre("m: removed face 0 of zero area"));
  EXPECT_EQ(checked.mesh.vertices.size(), 4U) << "the vertex that no face uses is dropped";
  EXPECT_EQ(checked.mesh.triangles, tetrahedron().triangles);
}

// A small shell inside a large one: a hollow if it faces inwards, refused if it faces outwards.
TEST(MeshCheck, HollowsAreAllowed) {
  Mesh mesh = tetrahedron();
  for (const auto& v : tetrahedron().vertices)
    mesh.vertices.push_back({0.1 + 0.1 * v[0], 0.1 + 0.1 * v[1], 0.1 + 0.1 * v[2]});
  Mesh wrong = mesh;
  for (const auto& t : tetrahedron().triangles) {
    mesh.triangles.push_back({t[0] + 4, t[2] + 4, t[1] + 4});
    wrong.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  }
  EXPECT_TRUE(check_mesh(mesh, "m").notes.empty());
  EXPECT_THROW(static_cast<void>(check_mesh(wrong, "m")), Error);
}

// Two faces back to back, and a tetrahedron pressed flat.
TEST(MeshCheck, WhatLiesFoldedIsRefused) {
  EXPECT_THROW(static_cast<void>(check_mesh({tetrahedron().vertices, {{0, 1, 2}, {0, 2, 1}}}, "m")), Error);
  Mesh flat = tetrahedron();
  flat.vertices[3] = {0.3, 0.3, 0};
  EXPECT_THROW(static_cast<void>(check_mesh(flat, "m")), Error);
}

TEST(MeshCheck, FacesAreNamed) {
  EXPECT_EQ(face_list({12, 15}, true), "faces of lines 12 and 15");
  EXPECT_EQ(face_list({12}), "face 12");
  EXPECT_EQ(face_list({12, 15}), "faces 12 and 15");
  EXPECT_EQ(face_list({1, 2, 3}), "faces 1, 2 and 3");
  EXPECT_EQ(face_list({12, 15, 20, 21, 22}), "faces 12, 15 and 3 more");
}

// Meshes as CAD programs export them: corners that differ in the last digits of a float, corners beside
// another face's edge, holes, shells that almost touch, and parts that overlap.

Mesh moved(Mesh mesh, const Vec3& by, double scale = 1.0) {
  for (auto& v : mesh.vertices)
    for (std::size_t i = 0; i < 3; ++i) v[i] = scale * v[i] + by[static_cast<Eigen::Index>(i)];
  return mesh;
}
Mesh joined(Mesh a, const Mesh& b, bool turned = false) {
  const auto first = static_cast<std::int32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto t : b.triangles) {
    for (std::int32_t& corner : t) corner += first;
    if (turned) std::swap(t[1], t[2]);
    a.triangles.push_back(t);
  }
  return a;
}
// Each face has its own corners, in float, as in an STL; a share of the coordinates is off by up to `ulps`
// units in the last place.
Mesh soup(const Mesh& mesh, int ulps, double share) {
  std::mt19937_64 random(3);
  Mesh loose;
  for (const auto& t : mesh.triangles) {
    std::array<std::int32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> at{};
      for (std::size_t k = 0; k < 3; ++k) {
        auto x = static_cast<float>(mesh.vertices[static_cast<std::size_t>(t[i])][k]);
        const bool off = static_cast<double>(random() % 1'000'000) < share * 1e6;
        const int by = static_cast<int>(random() % static_cast<std::uint64_t>(2 * ulps + 1)) - ulps;
        for (int n = 0; off && n < std::abs(by); ++n) x = std::nextafter(x, by > 0 ? 1e30F : -1e30F);
        at[k] = static_cast<double>(x);
      }
      corners[i] = static_cast<std::int32_t>(loose.vertices.size());
      loose.vertices.push_back(at);
    }
    loose.triangles.push_back(corners);
  }
  return loose;
}
CheckedMesh as_stl(const Mesh& mesh) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "part.stl").string();
  write_mesh(mesh, path);
  return load_solid(path);
}
std::string refusal(const Mesh& mesh) {
  return test::refusal([&] { (void)check_mesh(mesh, "part"); });
}

// A cube of 60 mm: the faces beside an edge are split in its middle, and those across it are not.
Mesh with_t_junctions(std::size_t count, double gap) {
  Mesh mesh = cube(4, 0.06);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = mesh.triangles[7 * i];
    const auto at = [&](std::size_t k) { return Vec3(mesh.vertices[static_cast<std::size_t>(t[k])].data()); };
    const Vec3 out = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    const Vec3 middle = 0.5 * (at(0) + at(1)) + gap * out;
    const auto corner = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back({middle.x(), middle.y(), middle.z()});
    mesh.triangles[7 * i] = {t[0], corner, t[2]};
    mesh.triangles.push_back({corner, t[1], t[2]});
  }
  return mesh;
}

// ---- last digits

TEST(MeshWeld, NoiseOfTheLastDigitsIsJoinedAndTold) {
  const std::vector<Mesh> parts{moved(geodesic_ball(12), {0.2, 0.1, 0.05}), moved(cube(8), {0.2, 0.1, 0.05}),
                                moved(turned_part(40), {-0.3, 0.02, 0.7}), knot(120, 12)};
  for (const Mesh& part : parts)
    for (const int ulps : {1, 2, 4})
      for (const double share : {0.02, 1.0}) {
        const CheckedMesh checked = as_stl(soup(part, ulps, share));
        EXPECT_EQ(checked.mesh.vertices.size(), part.vertices.size()) << ulps << " " << share;
        EXPECT_EQ(checked.mesh.triangles.size(), part.triangles.size()) << ulps << " " << share;
        EXPECT_THAT(checked.notes,
                    ElementsAre(AllOf(HasSubstr("part.stl: joined "), HasSubstr("of the mesh's size"))));
        EXPECT_NEAR(size_of(checked.mesh).volume, size_of(part).volume, 1e-5 * size_of(part).volume);
      }
}

TEST(MeshWeld, AMeshWithoutNoiseStaysAsItIs) {
  for (const Mesh& part : {moved(geodesic_ball(12), {0.2, 0.1, 0.05}), knot(120, 12)}) {
    const CheckedMesh checked = check_mesh(part, "part");
    EXPECT_THAT(checked.notes, IsEmpty());
    EXPECT_EQ(checked.mesh.vertices, part.vertices);
    EXPECT_EQ(checked.mesh.triangles, part.triangles);
  }
}

// Far from the origin along x a float is coarse there, but along y and z as fine as the small part needs.
TEST(MeshWeld, AnAxisFarFromTheOriginIsNotTheMeasureOfTheOthers) {
  const Mesh part = moved(cube(4), {1000.0, 0, 0});
  Mesh torn = soup(part, 0, 0.0);
  weld(torn);
  EXPECT_THAT(refusal(torn), "");
  torn = soup(part, 0, 0.0);
  for (std::size_t i = 0; i < 3; ++i)
    torn.vertices[i][2] += 1e-5;  // 2e-4 of the size, 1e-8 of the coordinate in x
  weld(torn);
  EXPECT_THAT(refusal(torn), HasSubstr("at a hole"));
}

// ---- what stays open

TEST(MeshWeld, TJunctionsAreToldWithTheirGap) {
  for (const std::size_t count : {1U, 4U})
    EXPECT_THAT(refusal(with_t_junctions(count, 1e-9)),
                AllOf(HasSubstr("at a hole"), HasSubstr("the widest gap is 1 nm, 2e-08 of the mesh's size"),
                      HasSubstr("T-junctions")));
  EXPECT_THAT(refusal(with_t_junctions(3, 0.0)), AllOf(HasSubstr("gap is 0 mm"), HasSubstr("T-junctions")));
}

TEST(MeshWeld, AHoleIsRefusedWithItsWidth) {
  // A grid of 1 mm on a cube of 16 mm, with two missing faces.
  Mesh mesh = cube(16, 0.016);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  EXPECT_THAT(refusal(mesh), AllOf(HasSubstr("at a hole"), HasSubstr("the widest gap is 1 mm"),
                                   HasSubstr("close the hole")));
  // The mesh with errors in the last digits: its corners are joined, and the hole stays.
  EXPECT_THAT(refusal(soup(mesh, 2, 0.5)),
              AllOf(HasSubstr("the widest gap is 1 mm"), HasSubstr("close the hole")));
}

TEST(MeshWeld, CornersThatAreFartherApartThanDigitsAreNotJoined) {
  Mesh torn = soup(cube(4), 0, 0.0);
  weld(torn);
  ASSERT_EQ(refusal(torn), "");
  const auto last = static_cast<std::size_t>(torn.triangles.back()[0]);
  torn.vertices.push_back(torn.vertices[last]);
  torn.vertices.back()[0] += 1e-6;
  torn.triangles.back()[0] = static_cast<std::int32_t>(torn.vertices.size()) - 1;
  EXPECT_THAT(refusal(torn), AllOf(HasSubstr(", 1e-05 of the mesh's size"), HasSubstr("merge the corners")));
}

// ---- shells

TEST(MeshWeld, ShellsThatAlmostTouchAreKeptApart) {
  const Mesh box = cube(4, 0.01);
  for (const double apart : {2e-7, 2e-9}) {  // m; 2e-5 and 2e-7 of the size
    const Mesh two = joined(box, moved(box, {0.01 + apart, 0, 0}));
    const CheckedMesh checked = check_mesh(two, "part");
    EXPECT_THAT(checked.notes, IsEmpty()) << apart;
    EXPECT_EQ(checked.mesh.vertices, two.vertices) << apart;
    EXPECT_EQ(checked.mesh.triangles, two.triangles) << apart;
  }
  // Also with last digits that have to be joined, one shell inside another.
  const CheckedMesh noisy = as_stl(soup(joined(box, moved(box, {0.01 + 2e-7, 0, 0})), 2, 0.05));
  EXPECT_EQ(noisy.mesh.vertices.size(), 2 * box.vertices.size());
  const Mesh ball = geodesic_ball(8);
  const Mesh hollow = joined(ball, moved(ball, {0, 0, 0}, 1.0 - 2e-7 / kBallRadius), true);
  EXPECT_EQ(check_mesh(hollow, "part").mesh.vertices.size(), 2 * ball.vertices.size());
}

// ---- parts that reach into each other

TEST(MeshWeld, TheDepthOfSelfIntersectionsIsTold) {
  const Mesh box = cube(1, 0.01);
  EXPECT_THAT(
      refusal(joined(box, moved(box, {0.009, 0.003, 0.002}))),
      AllOf(HasSubstr("passing through other faces (each by at most 1 mm"), HasSubstr("unite the parts")));
  EXPECT_THAT(refusal(joined(box, moved(box, {0.01 - 1e-8, 0.003, 0.002}))),
              HasSubstr("each by at most 10 nm, "));
}

// ---- sizes in messages

TEST(MeshSizes, AreToldInAUnitThatFits) {
  EXPECT_EQ(length_text(1e-9), "1 nm");
  EXPECT_EQ(length_text(9.9999e-7), "1 um");
  EXPECT_EQ(length_text(0.0335), "33.5 mm");
  EXPECT_EQ(length_text(67), "67 m");
  EXPECT_EQ(length_text(0), "0 mm");
  EXPECT_EQ(extent_text({67, 67, 67}), "67 x 67 x 67 m");
  EXPECT_EQ(extent_text({0.0670001, 0.05, 0.04}), "67 x 50 x 40 mm");
  EXPECT_EQ(place_text({1200, 1e-7, -3}), "(1.2, 0, -0.003) km");
  EXPECT_EQ(volume_text(8e-6), "8 cm^3");
  const MeshSize size = size_of(moved(cube(2), {1, 2, 3}));
  EXPECT_NEAR(size.volume, size.extent.prod(), 1e-12);
  EXPECT_NEAR(size.middle.y(), 2.0, 1e-12);
}

// Files with bytes after their end, and STL files whose count is missing.

class MeshRest : public ::testing::Test {
 protected:
  CheckedMesh read(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
    return load_solid((folder_.path() / name).string());
  }
  std::string refused(const std::string& name, const std::string& bytes) const {
    return test::refusal([&] { (void)read(name, bytes); });
  }
  static std::string with_count(std::string bytes, std::uint32_t count) {
    std::memcpy(bytes.data() + 80, &count, sizeof(count));
    return bytes;
  }
  test::TemporaryFolder folder_;
  const Mesh ball_ = geodesic_ball(3);  // 180 faces
};

TEST_F(MeshRest, OfABinaryStlIsPassedOverWithAWord) {
  const std::string stl = mesh_bytes(ball_, ".stl");
  EXPECT_THAT(read("a.stl", stl).notes, IsEmpty());
  EXPECT_THAT(read("a.stl", stl + "\r\n").notes,
              ElementsAre(HasSubstr("a.stl: passed over 2 bytes after the last triangle")));
  EXPECT_THAT(read("a.stl", stl + "x").notes, ElementsAre(HasSubstr("passed over 1 byte after")));
  EXPECT_THAT(read("a.stl", stl + std::string(49, '\0')).notes, ElementsAre(HasSubstr("49 bytes")));
  EXPECT_THAT(refused("a.stl", stl + std::string(50, '\0')),
              HasSubstr("says 180 triangles, but its 9134 bytes fit 181"));
  EXPECT_THAT(refused("a.stl", stl.substr(0, stl.size() - 1)), HasSubstr("fit 179 and 49 bytes"));
}

TEST_F(MeshRest, ACountThatIsMissingComesFromTheSize) {
  const std::string stl = with_count(mesh_bytes(ball_, ".stl"), 0);
  const CheckedMesh checked = read("a.stl", stl);
  EXPECT_EQ(checked.mesh.triangles.size(), 180U);
  EXPECT_THAT(checked.notes,
              ElementsAre(HasSubstr("the count of triangles is missing; read 180, which fit the size")));
  EXPECT_THAT(refused("a.stl", stl + "ab"),
              HasSubstr("says 0 triangles, but its 9086 bytes fit 180 and 2 bytes"));
}

TEST_F(MeshRest, OfTextsAndGlb) {
  const std::string obj = mesh_bytes(ball_, ".obj"), glb = mesh_bytes(ball_, ".glb");
  EXPECT_THAT(read("a.obj", obj + std::string("\x1a\0", 2)).notes,
              ElementsAre(HasSubstr("passed over 2 bytes after the end of the text")));
  EXPECT_THAT(read("a.obj", "\xEF\xBB\xBF" + obj).notes, IsEmpty());
  EXPECT_THAT(read("a.glb", glb + "\r\n").notes,
              ElementsAre(HasSubstr("passed over 2 bytes after the length")));
  EXPECT_THAT(refused("a.glb", glb + std::string(50, '\0')), HasSubstr("the header says"));
  EXPECT_THAT(refused("a.glb", glb.substr(0, glb.size() - 1)), HasSubstr("the header says"));
  std::string text = "solid a\n";
  for (const auto& t : ball_.triangles) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const std::int32_t corner : t) {
      const auto& v = ball_.vertices[static_cast<std::size_t>(corner)];
      text += fmt::format("vertex {} {} {}\n", v[0], v[1], v[2]);
    }
    text += "endloop\nendfacet\n";
  }
  EXPECT_THAT(read("a.stl", text + "endsolid a\n").notes, IsEmpty());
  EXPECT_THAT(read("a.stl", text + "endsolid a\n\x1a").notes,
              ElementsAre(HasSubstr("passed over 1 byte after the last 'endsolid'")));
}

}  // namespace
}  // namespace enc::models
