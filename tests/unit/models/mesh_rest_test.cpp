// Files with bytes after their end, and STL files whose count is missing.
#include <cstring>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_write.h"
#include "models/shapes/shapes.h"
#include "tests/support/temporary_folder.h"

namespace enc::models {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MeshRest : public ::testing::Test {
 protected:
  CheckedMesh read(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
    return load_solid((folder_.path() / name).string());
  }
  std::string refused(const std::string& name, const std::string& bytes) const {
    try {
      (void)read(name, bytes);
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
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
