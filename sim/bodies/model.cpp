#include "sim/bodies/model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/shape/deformation/dent.h"
#include "sim/bodies/arm_model.h"
#include "sim/bodies/legs.h"

namespace enc::sim {
namespace {

constexpr int kRings = 96, kSectors = 144;  // less than 1.5 mm apart on a tennis ball

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
  mesh->inertia = mjMESH_INERTIA_SHELL;  // it has no inertia, and needs no convex hull for it
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
  // MuJoCo stores a mesh in its own principal axes of inertia.
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
    const DisplacedPoint to = displaced(field, X_OM * Point<'W'>(vertex[0], vertex[1], vertex[2]),
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

namespace {

void set4(double* to, const Quat& q) {  // MuJoCo writes w first
  to[0] = q.w();
  to[1] = q.x();
  to[2] = q.y();
  to[3] = q.z();
}
// mjs_setName returns -1 for a duplicate and the spec still compiles, so check it (sources/twin 4).
void name(mjsElement* element, const std::string& text) {
  if (mjs_setName(element, text.c_str()) != 0)
    throw Error("two parts of the simulated world are called '" + text + "'");
}
void colour(mjsGeom* geom, std::array<float, 4> rgba) { std::copy(rgba.begin(), rgba.end(), geom->rgba); }

mjsGeom* drawn(mjsBody* body, mjtGeom type, const Vec3& position, const Vec3& size,
               std::array<float, 4> rgba) {
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom->type = type;
  set3(geom->pos, position);
  set3(geom->size, size);
  geom->contype = geom->conaffinity = 0;
  geom->mass = 0;
  colour(geom, rgba);
  return geom;
}

// A hard stop between tool and haptic-tip. It renders no haptic stiffness; the core does that.
void hard_contact(mjsGeom* geom, const WorldTruth& world) {
  geom->contype = geom->conaffinity = 1;
  geom->condim = 3;
  geom->friction[0] = world.tip_friction;
  geom->solref[0] = world.contact_time;
  geom->solref[1] = 1.0;
  geom->solimp[0] = geom->solimp[1] = 0.99;
}

// Markers and shaft of a tool, for the picture. `tip`: centre of its tip; q: its rotation.
void draw_tool(mjsBody* body, const ToolSpec& tool, const Quat& q, const Vec3& tip) {
  const auto placed = [&](const Vec3& p_T) { return Vec3(tip + q * (p_T - tool.tip)); };
  Vec3 middle = Vec3::Zero();
  for (const Vec3& marker : tool.markers) {
    drawn(body, mjGEOM_SPHERE, placed(marker), {0.006, 0, 0}, {0.8F, 0.8F, 0.85F, 1});
    middle += placed(marker) / static_cast<double>(tool.markers.size());
  }
  if (tool.markers.empty()) return;
  mjsGeom* shaft = drawn(body, mjGEOM_CAPSULE, Vec3::Zero(), {0.003, 0, 0}, {0.2F, 0.4F, 0.7F, 1});
  set3(shaft->fromto, tip);
  set3(shaft->fromto + 3, middle);
}

constexpr std::array<float, 4> kSkin{0.87F, 0.66F, 0.54F, 1};

// A fingertip is a tool without markers. Draws its last two joints, slightly bent.
void draw_finger(mjsBody* body, const Vec3& to_hand, double radius) {
  const Vec3 bent = (to_hand + 0.4 * to_hand.unitOrthogonal()).normalized();
  const Vec3 joint = 0.024 * to_hand;
  for (const auto& [from, to] : {std::pair<Vec3, Vec3>{Vec3::Zero(), joint}, {joint, joint + 0.03 * bent}}) {
    mjsGeom* bone = drawn(body, mjGEOM_CAPSULE, Vec3::Zero(), {0.95 * radius, 0, 0}, kSkin);
    set3(bone->fromto, from);
    set3(bone->fromto + 3, to);
  }
}

// A child of the tip's body, because a weld to it would err by 128 um at 40 mm/s (sources/twin 3). It has no
// contacts.
void add_clamped_tool(mjsBody* behind_sensor, const ToolSpec& tool, const Pose<'H', 'T'>& X_HT) {
  mjsBody* body = mjs_addBody(behind_sensor, nullptr);
  name(body->element, "clamped_tool");
  body->mass = tool.mass;
  body->explicitinertial = true;
  set3(body->ipos, (X_HT * Point<'T'>(tool.tip)).e());
  std::fill_n(body->inertia, 3, 1e-5);
  draw_tool(body, tool, Quat(X_HT.q()), (X_HT * Point<'T'>(tool.tip)).e());
}

void add_hexapod(mjSpec* spec, const ModelParts& parts) {
  std::array<char, 500> error{};
  const std::string file = parts.mjcf_dir + "/hexapod.xml";
  const SpecPtr machine(mj_parseXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
  if (!machine) throw Error(file + ": " + error.data());
  mjsBody* world = mjs_findBody(spec, "world");
  mjsFrame* frame = mjs_addFrame(world, nullptr);
  for (const char* body : {"base", "platform"})
    if (mjs_attach(frame->element, mjs_findBody(machine.get(), body)->element, "", "") == nullptr)
      throw Error(file + ": body '" + body + "' cannot be attached: " + mjs_getError(spec));
  mjsBody* base = mjs_findBody(spec, "base");
  set3(base->pos, parts.X_WR.p());
  set4(base->quat, Quat(parts.X_WR.q()));
  mjsBody* behind = mjs_findBody(spec, "behind_sensor");
  behind->mass = parts.twin.hexapod.mass;
  mjsSite* sensor = mjs_asSite(mjs_findElement(spec, mjOBJ_SITE, "force_sensor"));
  const Pose<'H', 'F'> X_HF = pose_of<'H', 'F'>(parts.twin.frames.H_F);
  set3(sensor->pos, X_HF.p());
  set4(sensor->quat, Quat(X_HF.q()));
  mjsGeom* tip = mjs_addGeom(behind, nullptr);
  name(tip->element, "haptic_tip");
  tip->type = mjGEOM_SPHERE;
  tip->size[0] = parts.scene.probe ? parts.scene.probe->radius : parts.twin.hexapod.tip_radius;
  tip->mass = 0;
  colour(tip, {0.90F, 0.35F, 0.10F, 1});
  hard_contact(tip, parts.twin.world);
  if (parts.clamped != nullptr) add_clamped_tool(behind, *parts.clamped, parts.X_HT);
  if (!parts.twin.structural()) return;
  const double moved =
      parts.twin.structure.platform_mass + behind->mass + (parts.clamped ? parts.clamped->mass : 0.0);
  Legs::build(spec, Hexapod(parts.twin.hexapod.geometry), parts.twin.structure, moved);
}

// Only a tool can touch a hexapod, which has no other constraint.
void touch_hexapod(mjSpec* spec, const ModelParts& parts) {
  if (parts.tool == nullptr) spec->option.disableflags |= mjDSBL_CONTACT | mjDSBL_CONSTRAINT;
}

// All parts of an arm belong to one island, so the search for islands would waste 8 % of the run time.
void add_arm(mjSpec* spec, const ModelParts& parts) {
  spec->option.disableflags |= mjDSBL_ISLAND;
  const ArmMachine machine = true_machine(parts.twin.arm);
  build_arm(spec, {machine, parts.twin.arm, parts.scene.prop ? &*parts.scene.prop : nullptr, parts.X_WR});
  spec->option.disableflags |= mjDSBL_MIDPHASE;  // its boxes do not follow a prop that rotates on its body
}

void add_sensor(mjSpec* spec, mjtSensor type, const char* text) {
  mjsSensor* sensor = mjs_addSensor(spec);
  sensor->type = type;
  sensor->objtype = mjOBJ_SITE;
  mjs_setString(sensor->objname, "force_sensor");
  name(sensor->element, text);
}

// A tool of the user: its tip's centre on three slides. The hand keeps its orientation.
void add_tool(mjSpec* spec, const ModelParts& parts, const ToolSpec& tool, const std::string& called) {
  mjsBody* body = mjs_addBody(mjs_findBody(spec, "world"), nullptr);
  name(body->element, called);
  body->mass = tool.mass;
  body->explicitinertial = true;
  set3(body->ipos, Vec3::Zero());  // if unset, MuJoCo compiles the body but omits its mass from the MJCF
  std::fill_n(body->inertia, 3, 1e-5);
  for (int axis = 0; axis < 3; ++axis) {
    mjsJoint* slide = mjs_addJoint(body, nullptr);
    slide->type = mjJNT_SLIDE;
    set3(slide->axis, Vec3::Unit(axis));
  }
  mjsGeom* tip = mjs_addGeom(body, nullptr);
  name(tip->element, called + "_tip");
  tip->type = mjGEOM_SPHERE;
  tip->size[0] = std::max(tool.tip_radius, 1e-4);
  tip->mass = 0;
  colour(tip, {0.85F, 0.85F, 0.20F, 1});
  hard_contact(tip, parts.twin.world);
  if (!parts.draw_all) return;
  draw_tool(body, tool, parts.q_WT, Vec3::Zero());
  if (!tool.markers.empty()) return;
  draw_finger(body, parts.finger, tip->size[0]);
  colour(tip, kSkin);
}

// Declares the only pair that can touch, so that MuJoCo checks no other pair (3 % of the instructions of a
// tick). Friction and stop are those of the first geom.
mjsPair* only_pair(mjSpec* spec, const char* one, const char* other) {
  mjsPair* pair = mjs_addPair(spec, nullptr);
  mjs_setString(pair->geomname1, one);
  mjs_setString(pair->geomname2, other);
  mjsGeom* first = mjs_asGeom(mjs_findElement(spec, mjOBJ_GEOM, one));
  mjsGeom* second = mjs_asGeom(mjs_findElement(spec, mjOBJ_GEOM, other));
  pair->condim = first->condim;
  std::fill_n(pair->friction, 2, first->friction[0]);
  std::copy_n(first->solref, mjNREF, pair->solref);
  std::copy_n(first->solimp, mjNIMP, pair->solimp);
  for (mjsGeom* geom : {first, second}) geom->contype = geom->conaffinity = 0;
  return pair;
}

// A button or a piece of a plane, whose face is at z = 0 of O.
mjsGeom* draw_slab(mjSpec* spec, std::size_t index, const ObjectSpec& object, const Pose<'W', 'O'>& X_WO) {
  const bool button = object.shape == ShapeKind::button;
  const Vec3 half = button ? Vec3(0.5 * object.width, 0.5 * object.height, 0.5 * object.thickness)
                           : Vec3(0.08, 0.08, 0.001);
  mjsGeom* geom =
      drawn(mjs_findBody(spec, "world"), mjGEOM_BOX, X_WO.p() - X_WO.q() * Vec3(0, 0, half.z()), half,
            button ? std::array{0.85F, 0.35F, 0.30F, 0.40F} : std::array{0.4F, 0.6F, 0.9F, 0.4F});
  name(geom->element, seen_name(index));
  return geom;
}

// A drum under its face, which is at z = 0 of O and runs along the behaviour's way.
mjsGeom* draw_drum(mjSpec* spec, std::size_t index, const ObjectSpec& object, const Object& prepared) {
  const Pose<'W', 'O'>& X_WO = prepared.X_WO;
  const Vec3 way = prepared.interaction.way.normalized();
  const bool across = std::abs(way.x()) > std::abs(way.y());  // the face's width is along that direction
  const double radius = 0.5 * (across ? object.width : object.height);
  const Vec3 axis = 0.5 * (across ? object.height : object.width) * way.cross(Vec3::UnitZ());
  mjsGeom* geom = drawn(mjs_findBody(spec, "world"), mjGEOM_CYLINDER, Vec3::Zero(), {radius, 0, 0},
                        {0.85F, 0.35F, 0.30F, 0.40F});
  set3(geom->fromto, X_WO.q() * (Vec3(0, 0, -radius) - axis) + X_WO.p());
  set3(geom->fromto + 3, X_WO.q() * (Vec3(0, 0, -radius) + axis) + X_WO.p());
  name(geom->element, seen_name(index));
  return geom;
}

mjsGeom* draw_object(mjSpec* spec, std::size_t index, const ObjectSpec& object, const Object& prepared) {
  const Pose<'W', 'O'>& X_WO = prepared.X_WO;
  if (object.shape == ShapeKind::button && prepared.interaction.kind == Interaction::spin)
    return draw_drum(spec, index, object, prepared);
  if (object.shape == ShapeKind::button || object.shape == ShapeKind::plane)
    return draw_slab(spec, index, object, X_WO);
  const bool ball = object.shape == ShapeKind::sphere;
  mjsGeom* geom = ball ? add_seen_ball(spec, index, object.radius)
                       : add_seen_mesh(spec, index, *object.surface, object.scale);
  set3(geom->pos, X_WO.p());
  colour(geom, ball ? std::array{0.78F, 0.90F, 0.20F, 0.35F} : std::array{0.72F, 0.55F, 0.38F, 0.55F});
  return geom;
}

void add_pictures(mjSpec* spec, const ModelParts& parts) {
  mjsBody* world = mjs_findBody(spec, "world");
  for (std::size_t i = 0; i < parts.scene.objects.size(); ++i) {
    const Pose<'W', 'O'>& X_WO = parts.prepared.objects[i].X_WO;
    mjsGeom* geom = draw_object(spec, i, parts.scene.objects[i], parts.prepared.objects[i]);
    set4(geom->quat, Quat(X_WO.q()));  // `fromto`, if set, takes precedence
    const bool real =
        parts.prepared.indentation() && parts.prepared.indentation()->object == static_cast<int>(i);
    if (real) geom->rgba[3] = 1.0F;
    set_material(spec, geom, i, parts.scene.objects[i], real);
  }
  // A picture shows a belt on its rollers instead of the touched box (app/view/moment/depict.cpp).
  if (parts.scene.prop && parts.scene.prop->kind == PropKind::drum)
    mjs_asGeom(mjs_findElement(spec, mjOBJ_GEOM, "prop_front"))->rgba[3] = 0.0F;
  for (const double side : {-1.0, 1.0}) {
    mjsLight* light = mjs_addLight(world, nullptr);
    set3(light->pos, {0.5 * side, -0.6, 1.2});
    set3(light->dir, Vec3(-0.4 * side, 0.5, -1.0).normalized());
  }
}

void touch_arm(mjSpec* spec, const ModelParts& parts) {
  if (parts.tool == nullptr) spec->option.disableflags |= mjDSBL_CONTACT;
  if (parts.tool == nullptr || !parts.scene.prop) return;
  mjsPair* pair = only_pair(spec, "prop_front", "tool_tip");
  if (parts.scene.prop->kind != PropKind::drum) return;
  pair->solreffriction[0] = parts.twin.arm.belt_friction_time;
  pair->solreffriction[1] = 1.0;
}

// The parts of a scene's model that differ from machine to machine.
struct MachineModel {
  void (*add)(mjSpec* spec, const ModelParts& parts);    // its bodies
  void (*touch)(mjSpec* spec, const ModelParts& parts);  // contacts with the machine, once all bodies exist
  int noslip;  // steps of the pass that removes creep, unless the rig file sets it
};
// Dry friction that does not creep: otherwise a pressed tip crawls off a round haptic-tip within seconds. A
// scene with an arm does without the last pass. That pass changes the dry friction of the joints after the
// contact forces are found, and would release a pressed finger for a tick whenever the arm begins to slip.
constexpr PerMachine<MachineModel> kModels{.hexapod = {add_hexapod, touch_hexapod, 4},
                                           .arm = {add_arm, touch_arm, 0}};

mjtIntegrator integrator_of(const Stepping& stepping) {
  constexpr std::array<mjtIntegrator, kIntegrators.size()> kOfMujoco{mjINT_EULER, mjINT_RK4, mjINT_IMPLICIT,
                                                                     mjINT_IMPLICITFAST, mjINT_DISCRETE};
  const auto found = std::find(kIntegrators.begin(), kIntegrators.end(), stepping.integrator);
  if (found == kIntegrators.end()) {
    std::string words;
    for (const std::string_view word : kIntegrators) words += (words.empty() ? "" : ", ") + std::string(word);
    throw Error("unknown integrator '" + stepping.integrator + "'; expected one of " + words,
                stepping.table + ".integrator");
  }
  return kOfMujoco[static_cast<std::size_t>(found - kIntegrators.begin())];
}

void set_solver(const SolverTruth& solver, int noslip, mjOption& option) {
  option.cone = solver.cone == Cone::elliptic ? mjCONE_ELLIPTIC : mjCONE_PYRAMIDAL;
  option.impratio = solver.impratio;
  option.noslip_iterations =
      std::isfinite(solver.noslip) ? static_cast<int>(std::lround(solver.noslip)) : noslip;
  option.iterations = static_cast<int>(std::lround(solver.iterations));
  option.tolerance = solver.tolerance;
}

}  // namespace

SpecPtr build_model(const ModelParts& parts) {
  install_mujoco_handlers();  // otherwise attaching prints warnings on standard output
  SpecPtr spec(mj_makeSpec());
  const MachineModel& machine = kModels.of(parts.scene);
  const Stepping stepping = parts.twin.stepping(parts.scene);
  spec->option.timestep = stepping.timestep;
  set3(spec->option.gravity, {0, 0, -9.80665});
  spec->option.integrator = integrator_of(stepping);
  set_solver(parts.twin.solver, machine.noslip, spec->option);
  // Speculative contacts: at 5 m/s a tool moves 5 mm a step and would pass through the tip. Slower tools keep
  // their bits.
  spec->option.enableflags |= mjENBL_SPECULATIVE;
  machine.add(spec.get(), parts);
  if (parts.scene.force) {
    add_sensor(spec.get(), mjSENS_FORCE, "force");
    add_sensor(spec.get(), mjSENS_TORQUE, "torque");
  }
  if (parts.tool != nullptr) add_tool(spec.get(), parts, *parts.tool, "tool");
  if (parts.other != nullptr) add_tool(spec.get(), parts, *parts.other, "other_tool");
  machine.touch(spec.get(), parts);
  if (parts.draw_all) add_pictures(spec.get(), parts);
  return spec;
}

}  // namespace enc::sim
