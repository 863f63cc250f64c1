#include "sim/model.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.h"

namespace enc::sim {
namespace {

void set3(double* to, const Vec3& v) { std::copy_n(v.data(), 3, to); }
void set4(double* to, const Quat& q) {  // MuJoCo writes w first
  to[0] = q.w();
  to[1] = q.x();
  to[2] = q.y();
  to[3] = q.z();
}
// mjs_setName says -1 for a duplicate and the spec still compiles: check (decisions 26).
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

// A hard stop between tool and haptic-tip.
// No haptic stiffness is rendered by it: that is the core's business.
void hard_contact(mjsGeom* geom, const WorldTruth& world) {
  geom->contype = geom->conaffinity = 1;
  geom->condim = 3;
  geom->friction[0] = world.tip_friction;
  geom->solref[0] = world.contact_time;
  geom->solref[1] = 1.0;
  geom->solimp[0] = geom->solimp[1] = 0.99;
}

void add_machine(mjSpec* spec, const ModelParts& parts) {
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
  tip->size[0] = parts.twin.hexapod.tip_radius;
  tip->mass = 0;
  colour(tip, {0.90F, 0.35F, 0.10F, 1});
  hard_contact(tip, parts.twin.world);
}

void add_sensor(mjSpec* spec, mjtSensor type, const char* text) {
  mjsSensor* sensor = mjs_addSensor(spec);
  sensor->type = type;
  sensor->objtype = mjOBJ_SITE;
  mjs_setString(sensor->objname, "force_sensor");
  name(sensor->element, text);
}

// The held tool: its tip's centre on three slides. The hand keeps its orientation.
void add_tool(mjSpec* spec, const ModelParts& parts) {
  mjsBody* body = mjs_addBody(mjs_findBody(spec, "world"), nullptr);
  name(body->element, "tool");
  body->mass = parts.tool->mass;
  body->explicitinertial = true;
  std::fill_n(body->inertia, 3, 1e-5);
  for (int axis = 0; axis < 3; ++axis) {
    mjsJoint* slide = mjs_addJoint(body, nullptr);
    slide->type = mjJNT_SLIDE;
    set3(slide->axis, Vec3::Unit(axis));
  }
  mjsGeom* tip = mjs_addGeom(body, nullptr);
  name(tip->element, "tool_tip");
  tip->type = mjGEOM_SPHERE;
  tip->size[0] = std::max(parts.tool->tip_radius, 1e-4);
  tip->mass = 0;
  colour(tip, {0.85F, 0.85F, 0.20F, 1});
  hard_contact(tip, parts.twin.world);
  const auto from_tip = [&](const Vec3& p_T) { return Vec3(parts.q_WT * (p_T - parts.tool->tip)); };
  Vec3 middle = Vec3::Zero();
  for (const Vec3& marker : parts.tool->markers) {
    drawn(body, mjGEOM_SPHERE, from_tip(marker), {0.006, 0, 0}, {0.8F, 0.8F, 0.85F, 1});
    middle += from_tip(marker) / static_cast<double>(parts.tool->markers.size());
  }
  mjsGeom* shaft = drawn(body, mjGEOM_CAPSULE, Vec3::Zero(), {0.003, 0, 0}, {0.2F, 0.4F, 0.7F, 1});
  std::fill_n(shaft->fromto, 3, 0.0);
  set3(shaft->fromto + 3, middle);
}

// A surface of triangles as it is seen. Only for pictures: a mesh that collides costs a convex hull at each
// start.
mjsGeom* draw_mesh(mjSpec* spec, const ObjectSpec& object, const Pose<'W', 'O'>& X_WO) {
  mjsMesh* mesh = mjs_addMesh(spec, nullptr);
  name(mesh->element, "surface of " + object.name);
  mesh->inertia = mjMESH_INERTIA_SHELL;
  std::vector<float> vertices;
  for (const auto& v : object.surface->vertices)
    for (const double x : v) vertices.push_back(static_cast<float>(x * object.scale));
  std::vector<int> faces;
  for (const auto& t : object.surface->triangles) faces.insert(faces.end(), t.begin(), t.end());
  mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
  mjs_setInt(mesh->userface, faces.data(), static_cast<int>(faces.size()));
  mjsGeom* geom =
      drawn(mjs_findBody(spec, "world"), mjGEOM_MESH, X_WO.p(), Vec3::Zero(), {0.72F, 0.55F, 0.38F, 0.55F});
  mjs_setString(geom->meshname, ("surface of " + object.name).c_str());
  return geom;
}

mjsGeom* draw_object(mjSpec* spec, const ObjectSpec& object, const Pose<'W', 'O'>& X_WO) {
  mjsBody* world = mjs_findBody(spec, "world");
  if (object.shape == ShapeKind::mesh) return draw_mesh(spec, object, X_WO);
  if (object.shape == ShapeKind::sphere)
    return drawn(world, mjGEOM_SPHERE, X_WO.p(), {object.radius, 0, 0}, {0.78F, 0.90F, 0.20F, 0.35F});
  return drawn(world, mjGEOM_BOX, X_WO.p() - X_WO.q() * Vec3(0, 0, 0.001), {0.08, 0.08, 0.001},
               {0.4F, 0.6F, 0.9F, 0.4F});
}

void add_pictures(mjSpec* spec, const ModelParts& parts) {
  mjsBody* world = mjs_findBody(spec, "world");
  for (std::size_t i = 0; i < parts.scene.objects.size(); ++i) {
    const Pose<'W', 'O'>& X_WO = parts.prepared.objects[i].X_WO;
    set4(draw_object(spec, parts.scene.objects[i], X_WO)->quat, Quat(X_WO.q()));
  }
  for (const double side : {-1.0, 1.0}) {
    mjsLight* light = mjs_addLight(world, nullptr);
    set3(light->pos, {0.5 * side, -0.6, 1.2});
    set3(light->dir, Vec3(-0.4 * side, 0.5, -1.0).normalized());
  }
}

}  // namespace

SpecPtr build_model(const ModelParts& parts) {
  install_mujoco_handlers();  // attaching warns on standard output otherwise
  SpecPtr spec(mj_makeSpec());
  spec->option.timestep = parts.twin.world.timestep;
  set3(spec->option.gravity, {0, 0, -9.80665});
  const std::array<std::pair<const char*, mjtIntegrator>, 4> integrators{
      {{"euler", mjINT_EULER},
       {"implicitfast", mjINT_IMPLICITFAST},
       {"implicit", mjINT_IMPLICIT},
       {"rk4", mjINT_RK4}}};
  const auto* found = std::find_if(integrators.begin(), integrators.end(),
                                   [&](const auto& i) { return parts.twin.world.integrator == i.first; });
  if (found == integrators.end())
    throw Error("unknown integrator '" + parts.twin.world.integrator +
                    "'; expected euler, implicitfast, implicit or rk4",
                "truth.world.integrator");
  spec->option.integrator = found->second;
  // Dry friction that does not creep: otherwise a pressed tip crawls off a round haptic-tip within seconds.
  spec->option.cone = mjCONE_ELLIPTIC;
  spec->option.impratio = 20.0;
  spec->option.noslip_iterations = 4;
  add_machine(spec.get(), parts);
  if (parts.scene.force) {
    add_sensor(spec.get(), mjSENS_FORCE, "force");
    add_sensor(spec.get(), mjSENS_TORQUE, "torque");
  }
  if (parts.tool != nullptr)
    add_tool(spec.get(), parts);
  else
    spec->option.disableflags |= mjDSBL_CONTACT | mjDSBL_CONSTRAINT;  // nothing can touch
  if (parts.draw_all) add_pictures(spec.get(), parts);
  return spec;
}

}  // namespace enc::sim
