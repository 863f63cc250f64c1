// Meshes as CAD programs export them: corners that differ in the last digits of a float, edges that a corner
// of another face lies beside, holes, shells that almost touch, and parts that reach into each other.
#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/frames.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/mesh_files/mesh_write.h"
#include "models/shapes/shapes.h"
#include "models/sizes/mesh_size.h"
#include "tests/support/temporary_folder.h"

namespace enc::models {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
// Each face with corners of its own, in float, as an STL has them; a share of the coordinates is off by up to
// `ulps` units in the last place.
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
  try {
    (void)check_mesh(mesh, "part");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
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

// Far from the origin along x a float is coarse there, and along y and z as fine as the part is small.
TEST(MeshWeld, AnAxisFarFromTheOriginIsNotTheMeasureOfTheOthers) {
  const Mesh part = moved(cube(4), {1000.0, 0, 0});
  Mesh torn = soup(part, 0, 0.0);
  weld(torn);
  EXPECT_THAT(refusal(torn), "accepted");
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
  // A grid of 1 mm on a cube of 16 mm, and two faces of it that are missing.
  Mesh mesh = cube(16, 0.016);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  EXPECT_THAT(refusal(mesh), AllOf(HasSubstr("at a hole"), HasSubstr("the widest gap is 1 mm"),
                                   HasSubstr("close the hole")));
  // The same in a mesh whose last digits are off: they are joined, and the hole stays.
  EXPECT_THAT(refusal(soup(mesh, 2, 0.5)),
              AllOf(HasSubstr("the widest gap is 1 mm"), HasSubstr("close the hole")));
}

TEST(MeshWeld, CornersThatAreFartherApartThanDigitsAreNotJoined) {
  Mesh torn = soup(cube(4), 0, 0.0);
  weld(torn);
  ASSERT_EQ(refusal(torn), "accepted");
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
  // Even where their last digits have to be joined, and one in the other.
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

}  // namespace
}  // namespace enc::models
