// Mesh files as they should be: every format and index type, transforms worked out by hand, and what is
// repaired.
#include "models/mesh_files/mesh_file.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/frames.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_write.h"
#include "tests/support/temporary_folder.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
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

// Corners with coordinates that float and double share.
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
      load_mesh(file("a.stl", mesh_bytes(mesh, ".stl")));  // its vertices come as the faces name them
  EXPECT_EQ(stl.vertices.size(), 4U);
  EXPECT_EQ(stl.triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(volume(stl), 8.0 / 6.0);
}

TEST_F(MeshFiles, ObjInAllItsForms) {
  const std::string text =
      "# a comment\r\no thing\nvn 0 0 1\n" + kVertices +
      "vt 0 0\nf 1/1 3/1 2/1\nf 1//1 2//1 4//1 # more\nf -3/1/1 -2/1/1 -1/1/1\n\tf 1 4 3\n";
  EXPECT_EQ(load_mesh(file("a.obj", text)).triangles, tetrahedron().triangles);
  // A square pyramid: what is convex becomes a fan around its first corner.
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

// From whichever corner it begins: an L, a comb, a star, one with corners along its sides, a spiral.
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
  // Without its last face, the top: the walls of lines 13 to 18 end at a hole.
  EXPECT_THAT(said(text.substr(0, text.rfind("f "))),
              ::testing::StartsWith("a.obj:13: faces of lines 13, 14 and 4 more at a hole"));
  // The base twice: two triangles and more of one line are one face.
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
  // A matrix stands in columns: the last four are the shift.
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
  EXPECT_NEAR(second->colour[1], 0.7297F, 1e-3F);  // the file's is linear in light
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

// A small one inside a large one: a hollow if it looks in, refused if it looks out.
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
  EXPECT_THROW(check_mesh(wrong, "m"), Error);
}

// Two faces back to back, and a tetrahedron pressed flat.
TEST(MeshCheck, WhatLiesFoldedIsRefused) {
  EXPECT_THROW(check_mesh({tetrahedron().vertices, {{0, 1, 2}, {0, 2, 1}}}, "m"), Error);
  Mesh flat = tetrahedron();
  flat.vertices[3] = {0.3, 0.3, 0};
  EXPECT_THROW(check_mesh(flat, "m"), Error);
}

TEST(MeshCheck, FacesAreNamed) {
  EXPECT_EQ(face_list({12, 15}, true), "faces of lines 12 and 15");
  EXPECT_EQ(face_list({12}), "face 12");
  EXPECT_EQ(face_list({12, 15}), "faces 12 and 15");
  EXPECT_EQ(face_list({1, 2, 3}), "faces 1, 2 and 3");
  EXPECT_EQ(face_list({12, 15, 20, 21, 22}), "faces 12, 15 and 3 more");
}

}  // namespace
}  // namespace enc::models
