// The committed hare is what its generator makes, byte for byte, and a sound solid.
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_write.h"
#include "models/shapes/hare.h"
#include "tests/support/built.h"

namespace enc {
namespace {

TEST(HareGoldenLong, IsReproducedAndSound) {
  const std::string path = tests::source_dir() + "/models/meshes/hare.glb";
  std::ifstream file(path, std::ios::binary);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(committed.empty());
  EXPECT_LT(committed.size(), 600'000U);
  EXPECT_TRUE(models::mesh_bytes(models::hare_mesh(), ".glb") == committed);
  const models::CheckedMesh solid = models::load_solid(path);
  EXPECT_TRUE(solid.notes.empty()) << solid.notes.front();
  EXPECT_EQ(solid.mesh.triangles.size(), 19824U);
  // Euler: a closed surface without handles.
  EXPECT_EQ(solid.mesh.vertices.size(), solid.mesh.triangles.size() / 2 + 2);
}

}  // namespace
}  // namespace enc
