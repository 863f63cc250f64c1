#include "sim/bodies/seen_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/shape/deformation/dent.h"

namespace enc::sim {
namespace {

constexpr int kRings = 96, kSectors = 144;  // under 1.5 mm apart on a tennis ball

std::vector<float> ball_vertices(double radius) {
  std::vector<float> xyz;
  const auto add = [&](double polar, double azimuth) {
    xyz.push_back(static_cast<float>(radius * std::sin(polar) * std::cos(azimuth)));
    xyz.push_back(static_cast<float>(radius * std::sin(polar) * std::sin(azimuth)));
    xyz.push_back(static_cast<float>(radius * std::cos(polar)));
  };
  add(0.0, 0.0);
  for (int ring = 1; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector)
      add(std::numbers::pi * ring / kRings, 2.0 * std::numbers::pi * sector / kSectors);
  add(std::numbers::pi, 0.0);
  return xyz;
}

std::vector<int> ball_triangles() {
  std::vector<int> all;
  const auto at = [](int ring, int sector) {
    if (ring == 0) return 0;
    return ring == kRings ? 1 + (kRings - 1) * kSectors : 1 + (ring - 1) * kSectors + sector % kSectors;
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int s = 0; s < kSectors; ++s) {
      if (ring + 1 < kRings) all.insert(all.end(), {at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)});
      if (ring > 0) all.insert(all.end(), {at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)});
    }
  return all;
}

mjsGeom* add_seen(mjSpec* spec, std::size_t object, const std::vector<float>& vertices,
                  const std::vector<int>& triangles) {
  const std::string name = seen_name(object);
  mjsMesh* mesh = mjs_addMesh(spec, nullptr);
  mjsGeom* geom = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
  if (mjs_setName(mesh->element, name.c_str()) != 0 || mjs_setName(geom->element, name.c_str()) != 0)
    throw Error("two parts of the simulated world are called '" + name + "'");
  mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
  mjs_setInt(mesh->userface, triangles.data(), static_cast<int>(triangles.size()));
  mesh->smoothnormal = true;
  mesh->inertia = mjMESH_INERTIA_SHELL;  // it has none, and needs no convex hull for it
  geom->type = mjGEOM_MESH;
  mjs_setString(geom->meshname, name.c_str());
  geom->contype = geom->conaffinity = 0;
  geom->mass = 0;
  return geom;
}

constexpr float kVirtual = 0.60F;  // opacity, most

std::optional<SurfaceMaterial> material_of(const ObjectSpec& object) {
  switch (object.material) {
    case MaterialName::unnamed:
      return object.own_material;
    case MaterialName::felt:
      return SurfaceMaterial{{0.78F, 0.90F, 0.20F}, 0.0F, 1.0F, 1.0F};
    case MaterialName::rubber:
      return SurfaceMaterial{{0.16F, 0.17F, 0.19F}, 0.0F, 0.75F, 1.0F};
    case MaterialName::plastic:
      return SurfaceMaterial{{0.80F, 0.14F, 0.12F}, 0.0F, 0.25F, 1.0F};
    case MaterialName::wood:
      return SurfaceMaterial{{0.62F, 0.42F, 0.24F}, 0.0F, 0.65F, 1.0F};
    case MaterialName::steel:
      return SurfaceMaterial{{0.66F, 0.68F, 0.71F}, 1.0F, 0.20F, 1.0F};
    case MaterialName::brass:
      return SurfaceMaterial{{0.80F, 0.63F, 0.26F}, 1.0F, 0.25F, 1.0F};
    case MaterialName::glass:
      return SurfaceMaterial{{0.70F, 0.86F, 0.88F}, 0.0F, 0.02F, 0.30F};
  }
  return {};
}

}  // namespace

std::string seen_name(std::size_t object) { return "seen_" + std::to_string(object); }

mjsGeom* add_seen_ball(mjSpec* spec, std::size_t object, double radius) {
  return add_seen(spec, object, ball_vertices(radius), ball_triangles());
}

mjsGeom* add_seen_mesh(mjSpec* spec, std::size_t object, const Mesh& mesh, double scale) {
  std::vector<float> vertices;
  for (const auto& v : mesh.vertices)
    for (const double x : v) vertices.push_back(static_cast<float>(x * scale));
  std::vector<int> triangles;
  for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return add_seen(spec, object, vertices, triangles);
}

void set_material(mjSpec* spec, mjsGeom* geom, std::size_t object, const ObjectSpec& is, bool real) {
  const std::optional<SurfaceMaterial> of = material_of(is);
  if (!of) return;
  mjsMaterial* material = mjs_addMaterial(spec, nullptr);
  const std::string name = seen_name(object);
  if (mjs_setName(material->element, name.c_str()) != 0)
    throw Error("two materials of the simulated world are called '" + name + "'");
  const float gloss = 1.0F - of->roughness;
  material->shininess = gloss;
  material->specular = std::max(0.9F * gloss, 0.4F * of->metallic);
  std::copy(of->colour.begin(), of->colour.end(), geom->rgba);
  geom->rgba[3] = real ? of->opacity : std::min(of->opacity, kVirtual);
  std::copy_n(geom->rgba, 4, material->rgba);
  mjs_setString(geom->material, name.c_str());
}

void shift_seen(const mjModel* model, mjData* data, std::size_t object, const Vec<'W'>& shift) {
  const int geom = mj_name2id(model, mjOBJ_GEOM, seen_name(object).c_str());
  if (geom < 0) return;
  for (int k = 0; k < 3; ++k) data->geom_xpos[3 * geom + k] += shift.xyz[static_cast<std::size_t>(k)];
}

int dent_seen(mjModel* m, const mjData* data, const Scene& scene, std::size_t object, const Tip<'W'>& tip) {
  const int geom = mj_name2id(m, mjOBJ_GEOM, seen_name(object).c_str());
  if (geom < 0 || m->geom_type[geom] != mjGEOM_MESH) return -1;
  const Object& seen = scene.objects[object];
  const Pose<'O', 'W'> X_OW = seen.X_WO.inverse();
  const DentField<double> field =
      dent_field(seen.surface, dent_of(seen.surface, static_cast<std::int32_t>(object), X_OW * tip));
  // MuJoCo keeps a mesh in its own axes of inertia.
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Vec3 p = Vec3::Map(data->geom_xpos + static_cast<std::ptrdiff_t>(3) * geom);
  const Mat3 turned = RowMajor::Map(data->geom_xmat + static_cast<std::ptrdiff_t>(9) * geom);
  const Pose<'O', 'W'> X_OM(X_OW.q() * Quat(turned), Vec3(X_OW.q() * p + X_OW.p()));
  const Pose<'W', 'O'> X_MO = X_OM.inverse();
  const int mesh = m->geom_dataid[geom];
  float* vertex = m->mesh_vert + static_cast<std::ptrdiff_t>(3) * m->mesh_vertadr[mesh];
  float* normal = m->mesh_normal + static_cast<std::ptrdiff_t>(3) * m->mesh_normaladr[mesh];
  if (m->mesh_normalnum[mesh] != m->mesh_vertnum[mesh]) return -1;
  for (int i = 0; i < m->mesh_vertnum[mesh]; ++i, vertex += 3, normal += 3) {
    const Displaced to = displaced(field, X_OM * Point<'W'>(vertex[0], vertex[1], vertex[2]),
                                   X_OM * Vec<'W'>(Vec3(normal[0], normal[1], normal[2]).normalized()));
    const Point<'W'> at = X_MO * to.point;
    const Vec<'W'> n = X_MO * to.normal;
    for (int k = 0; k < 3; ++k) {
      vertex[k] = static_cast<float>(at.xyz[static_cast<std::size_t>(k)]);
      normal[k] = static_cast<float>(n.xyz[static_cast<std::size_t>(k)]);
    }
  }
  return mesh;
}

}  // namespace enc::sim
