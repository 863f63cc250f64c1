// MuJoCo's classic renderer, one drawing for each eye. The background changes only with the light, so it is
// drawn once for each. Hand and things are drawn alone and copied over the background where they are nearer;
// the pixels are those of one drawing of all geoms. A hand is appended as geoms of the picture alone. Lamp
// strengths implement light, exposure and white balance, so that they are exact and saturate like a sensor.
#include "sim/camera/stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "sim/bodies/mujoco.h"
#include "sim/camera/context.h"
#include "sim/camera/hand.h"
#include "sim/camera/scenery.h"
#include "sim/camera/sensor.h"

namespace enc::sim {
namespace {

constexpr double kNear = 0.05, kFar = 6.0;  // m
constexpr int kRoom = 256;                  // geoms

// Without this, OpenGL would clip light at 1 before the texture darkens it.
void let_light_exceed_one(const DrawingContext& context) {
  constexpr unsigned kClampVertexColour = 0x891A;
  const auto clamp = reinterpret_cast<void (*)(unsigned, unsigned)>(context.function("glClampColor"));
  if (clamp == nullptr)
    throw Error("this OpenGL has no glClampColor: Mesa is too old", {}, ErrorKind::device);
  clamp(kClampVertexColour, 0);
}

mjvGLCamera gl_camera(const Warp& warp, const Pose<'C', 'D'>& X_CE) {
  mjvGLCamera c{};
  const Vec3 forward = X_CE.q() * Vec3(0, 0, 1), up = X_CE.q() * Vec3(0, -1, 0);
  for (int i = 0; i < 3; ++i) {
    c.pos[i] = static_cast<float>(X_CE.p()(i));
    c.forward[i] = static_cast<float>(forward(i));
    c.up[i] = static_cast<float>(up(i));
  }
  c.frustum_center = static_cast<float>(kNear * 0.5 * (warp.left() + warp.right()));
  c.frustum_width = static_cast<float>(kNear * 0.5 * (warp.right() - warp.left()));  // half of it
  c.frustum_top = static_cast<float>(-kNear * warp.top());
  c.frustum_bottom = static_cast<float>(-kNear * warp.bottom());
  c.frustum_near = static_cast<float>(kNear);
  c.frustum_far = static_cast<float>(kFar);
  return c;
}

const StageSpec& checked(const StageSpec& spec) {
  const StereoRig& c = spec.camera;
  if (c.width < 16 || c.height < 16 || c.width > 4096 || c.height > 4096)
    throw Error("a camera's images are 16 to 4096 pixels wide and high", "truth.camera.width_px");
  for (const Lens* lens : {&c.left, &c.right})
    if (!(lens->focal_x > 1.0 && lens->focal_y > 1.0 && std::isfinite(lens->centre_x + lens->centre_y)))
      throw Error("a camera's focal length is more than 1 px", "truth.camera.focal_px");
  if (!c.X_CD.valid()) throw Error("the pose of the right camera is no pose", "truth.camera.baseline_mm");
  const int samples = spec.finish.samples;
  if (samples < 0 || samples > 16 || (samples & (samples - 1)) != 0)
    throw Error("samples of a pixel are 0, 1, 2, 4, 8 or 16");
  if (!(spec.sensor.exposure >= 0.0)) throw Error("an exposure is not negative", "truth.camera.exposure");
  return spec;
}

}  // namespace

struct Stage::Parts {
  // A drawing. As in OpenGL its lowest row is the first, and its depth is 1 near and 0 far; 0: no surface.
  struct Layer {
    std::vector<std::uint8_t> rgb;
    std::vector<float> depth;
  };

  explicit Parts(const StageSpec& given);

  [[nodiscard]] std::unique_lock<std::mutex> current() const;  // current while the lock is held
  void light(const Light& light);
  // Draws the geoms from `begin` to `end`, `end` excluded.
  void render(int eye, int begin, int end, bool segments);
  void read_colours(int eye, std::vector<std::uint8_t>& rgb);
  void read(int eye, Layer& to);
  void draw_background(const Light& light);
  void lay_over(int eye);
  void draw(int eye, Image& picture, std::uint64_t frame);
  void expose(int eye, Image& picture, std::uint64_t frame) const;
  void tell_truth(const CameraScene& shown, PixelTruth& truth);
  // Shadows, reflections and smooth edges depend on both layers.
  [[nodiscard]] bool layered() const {
    return spec.finish.samples == 0 && !spec.finish.shadows && !spec.finish.reflections;
  }
  [[nodiscard]] int first_moving() const { return layered() ? hands->background() : 0; }  // geom
  // As in MuJoCo, of two equal depths the later geom counts.
  [[nodiscard]] bool in_front(std::size_t eye, std::size_t pixel) const {
    const float depth = moving.depth[pixel];
    return !layered() || (depth > 0.0F && depth >= background[eye].depth[pixel]);
  }

  StageSpec spec;
  int width, height;
  std::unique_ptr<DrawingContext> context;
  ModelPtr model;
  std::array<Warp, 2> warp;
  Renderer renderer;
  std::array<mjvGLCamera, 2> eyes;
  SensorNoise noise;
  std::optional<HandDrawing> hands;
  std::optional<Light> background_light;  // light of the background's drawings
  std::array<Layer, 2> background;        // drawing of each eye
  Layer moving;                           // last drawing of what moves; of all if the stage has no layers
  std::vector<std::uint8_t> drawing;      // last drawing of all
  std::array<Image, 2> clean;             // last picture of each eye, without noise
};

Stage::Parts::Parts(const StageSpec& given)
    : spec(checked(given)),
      width(static_cast<int>(given.camera.width)),
      height(static_cast<int>(given.camera.height)),
      context(drawing_context()),
      model(scenery_model(given)),
      warp{Warp(given.camera.left, width, height), Warp(given.camera.right, width, height)},
      renderer(model.get(), kRoom, mjFONTSCALE_50, std::max(warp[0].width(), warp[1].width()),
               std::max(warp[0].height(), warp[1].height())),
      eyes{gl_camera(warp[0], Pose<'C', 'D'>::identity()), gl_camera(warp[1], given.camera.X_CD)},
      noise(given.sensor.noise, given.seed) {
  let_light_exceed_one(*context);
  renderer.context.readDepthMap = mjDEPTH_ZEROFAR;  // exact: the other one is rounded
  const DataPtr data(mj_makeData(model.get()));
  if (!data) throw Error("not enough memory for a scenery", {}, ErrorKind::device);
  mj_kinematics(model.get(), data.get());
  mjvOption option;
  mjv_defaultOption(&option);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  mjv_updateScene(model.get(), data.get(), &option, nullptr, &camera, mjCAT_ALL, &renderer.scene);
  hands.emplace(model.get(), renderer.scene);
  for (const mjtRndFlag flag : {mjRND_FOG, mjRND_HAZE, mjRND_SKYBOX}) renderer.scene.flags[flag] = 0;
  renderer.scene.flags[mjRND_SHADOW] = spec.finish.shadows ? 1 : 0;
  renderer.scene.flags[mjRND_REFLECTION] = spec.finish.reflections ? 1 : 0;
}

std::unique_lock<std::mutex> Stage::Parts::current() const {
  auto lock = drawing_lock();
  context->make_current();
  return lock;
}

// A lamp over the viewer's shoulder, a weaker one beside the camera, and the reflections of the room.
void Stage::Parts::light(const Light& light) {
  mjvScene& scene = renderer.scene;
  scene.nlight = 2;
  const double turned = 0.45 * std::numbers::pi * std::clamp(light.side, -1.0, 1.0);
  const Vec3 from[2] = {Vec3(std::sin(turned), -0.75, -std::cos(turned)).normalized(), Vec3(0, 0, -1)};
  const double strength[2] = {0.62, 0.26}, around[2] = {0.30, 0.0};
  for (int i = 0; i < 2; ++i) {
    mjvLight& lamp = scene.lights[i];
    lamp = mjvLight{};
    lamp.id = -1;
    lamp.type = mjLIGHT_DIRECTIONAL;
    lamp.attenuation[0] = 1.0F;
    lamp.castshadow = i == 0 ? 1 : 0;
    for (int c = 0; c < 3; ++c) {
      const double gain = light.gain * spec.sensor.exposure *
                          static_cast<double>(light.colour[static_cast<std::size_t>(c)] *
                                              spec.sensor.white[static_cast<std::size_t>(c)]);
      lamp.dir[c] = static_cast<float>(-from[i](c));
      lamp.pos[c] = static_cast<float>(from[i](c));
      lamp.diffuse[c] = static_cast<float>(gain * strength[i]);
      lamp.ambient[c] = static_cast<float>(gain * around[i]);
    }
  }
}

void Stage::Parts::render(int eye, int begin, int end, bool segments) {
  const auto e = static_cast<std::size_t>(eye);
  mjvScene scene = renderer.scene;
  scene.camera[0] = scene.camera[1] = eyes[e];
  scene.flags[mjRND_SEGMENT] = scene.flags[mjRND_IDCOLOR] = segments ? 1 : 0;
  scene.geoms += begin;
  scene.ngeom = end - begin;
  mjr_render({0, 0, warp[e].width(), warp[e].height()}, &scene, &renderer.context);
}

void Stage::Parts::read_colours(int eye, std::vector<std::uint8_t>& rgb) {
  const Warp& w = warp[static_cast<std::size_t>(eye)];
  rgb.resize(3 * static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height()));
  mjr_readPixels(rgb.data(), nullptr, {0, 0, w.width(), w.height()}, &renderer.context);
}

void Stage::Parts::read(int eye, Layer& to) {
  read_colours(eye, to.rgb);
  const Warp& w = warp[static_cast<std::size_t>(eye)];
  to.depth.resize(to.rgb.size() / 3);
  mjr_readPixels(nullptr, to.depth.data(), {0, 0, w.width(), w.height()}, &renderer.context);
}

void Stage::Parts::draw_background(const Light& light) {
  if (!layered() || background_light == light) return;
  for (const int eye : {0, 1}) {
    render(eye, 0, hands->background(), false);
    read(eye, background[static_cast<std::size_t>(eye)]);
  }
  background_light = light;
}

// Reads colours only from the rectangle around what is in front of the background.
void Stage::Parts::lay_over(int eye) {
  const auto e = static_cast<std::size_t>(eye);
  const int across = warp[e].width(), up = warp[e].height();
  drawing = background[e].rgb;
  moving.depth.resize(background[e].depth.size());
  mjr_readPixels(nullptr, moving.depth.data(), {0, 0, across, up}, &renderer.context);
  int left = across, right = -1, bottom = up, top = -1;
  for (int y = 0, i = 0; y < up; ++y)
    for (int x = 0; x < across; ++x, ++i)
      if (in_front(e, static_cast<std::size_t>(i))) {
        left = std::min(left, x);
        right = std::max(right, x);
        bottom = std::min(bottom, y);
        top = y;
      }
  if (right < left) return;
  const int wide = right - left + 1, high = top - bottom + 1;
  moving.rgb.resize(3 * static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
  mjr_readPixels(moving.rgb.data(), nullptr, {left, bottom, wide, high}, &renderer.context);
  const std::uint8_t* from = moving.rgb.data();
  for (int y = bottom; y <= top; ++y)
    for (int x = left; x <= right; ++x, from += 3) {
      const auto i = static_cast<std::size_t>(y * across + x);
      if (in_front(e, i)) std::copy_n(from, 3, drawing.data() + 3 * i);
    }
}

void Stage::Parts::draw(int eye, Image& picture, std::uint64_t frame) {
  const auto e = static_cast<std::size_t>(eye);
  render(eye, first_moving(), renderer.scene.ngeom, false);
  if (layered())
    lay_over(eye);
  else
    read_colours(eye, drawing);
  if (clean[e].width != width) clean[e] = Image(width, height);
  warp[e].colours(drawing.data(), clean[e]);
  expose(eye, picture, frame);
}

void Stage::Parts::expose(int eye, Image& picture, std::uint64_t frame) const {
  picture = clean[static_cast<std::size_t>(eye)];
  noise.add(picture, frame, static_cast<std::uint64_t>(eye));
}

namespace {

// Ground truth of a cap in the picture: its centre, and the radius of the circle with its outline's area.
void tell_cap(const Lens& lens, const Vec3& centre, double radius, PixelTruth& truth) {
  truth.column = truth.row = truth.radius = kUnset;
  const double distance2 = centre.squaredNorm();
  if (!(centre.z() > radius)) return;
  const auto [column, row] = projected(lens, centre);
  truth.column = column;
  truth.row = row;
  // The outline is the circle of the sphere where rays from the camera touch it.
  const double share = radius * radius / distance2;
  const Vec3 middle = (1.0 - share) * centre;
  const double rim = radius * std::sqrt(1.0 - share);
  const Vec3 a = centre.unitOrthogonal(), b = centre.normalized().cross(a);
  constexpr int kPoints = 256;
  double area = 0.0;
  std::array<double, 2> before{};
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    const auto p = projected(lens, middle + rim * (std::cos(angle) * a + std::sin(angle) * b));
    if (i > 0) area += 0.5 * (before[0] * p[1] - p[0] * before[1]);
    before = p;
  }
  truth.radius = std::sqrt(std::abs(area) / std::numbers::pi);
}

}  // namespace

void Stage::Parts::tell_truth(const CameraScene& shown, PixelTruth& truth) {
  const Warp& w = warp[0];
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (Mask* mask : {&truth.skin, &truth.things})
    if (mask->width != width || mask->height != height) *mask = Mask(width, height);
  truth.depth.resize(pixels);
  render(0, first_moving(), renderer.scene.ngeom, true);
  read(0, moving);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t at = w.nearest(x, y);
      const std::uint8_t* c = moving.rgb.data() + 3 * at;
      const int geom = (c[0] + 256 * c[1] + 65536 * c[2]) - 1;
      const bool front = in_front(0, at);
      const bool is_geom = front && geom >= 0 && geom < renderer.scene.ngeom;
      const double d = static_cast<double>(front ? moving.depth[at] : background[0].depth[at]);
      truth.skin.row(y)[x] = is_geom && hands->is_skin(geom) ? 255 : 0;
      truth.things.row(y)[x] = is_geom && hands->is_thing(geom) ? 255 : 0;
      truth.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)] =
          d <= 0.0 ? std::numeric_limits<float>::infinity()
                   : static_cast<float>(kNear * kFar / (kNear + d * (kFar - kNear)));
    }
  truth.column = truth.row = truth.radius = kUnset;
  if (shown.hand) tell_cap(spec.camera.left, shown.pose.tip.e(), 0.5 * shown.look.finger_width, truth);
}

Stage::Stage(const StageSpec& spec) {
  const auto lock = drawing_lock();
  parts_ = std::make_unique<Parts>(spec);
}
Stage::~Stage() {
  const auto lock = parts_->current();
  parts_.reset();
}

void Stage::draw(const CameraScene& shown, std::uint64_t frame, Image& left, Image& right,
                 PixelTruth* truth) {
  Parts& p = *parts_;
  const auto lock = p.current();
  p.hands->show(shown, p.renderer.scene);
  p.light(shown.light);
  p.draw_background(shown.light);
  p.draw(0, left, frame);
  p.draw(1, right, frame);
  if (truth != nullptr) p.tell_truth(shown, *truth);
}

void Stage::again(std::uint64_t frame, Image& left, Image& right) {
  if (parts_->clean[1].width == 0) return;
  parts_->expose(0, left, frame);
  parts_->expose(1, right, frame);
}

void Stage::draw_at_once(const CameraScene& shown, Image& left, Image& right) {
  Parts& p = *parts_;
  const auto lock = p.current();
  p.hands->show(shown, p.renderer.scene);
  p.light(shown.light);
  for (const int eye : {0, 1}) {
    const Warp& w = p.warp[static_cast<std::size_t>(eye)];
    Image& to = eye == 0 ? left : right;
    if (to.width != w.width() || to.height != w.height()) to = Image(w.width(), w.height());
    p.render(eye, 0, p.renderer.scene.ngeom, false);
    p.read_colours(eye, to.rgb);
  }
}

const char* Stage::renderer() const { return parts_->context->name(); }

}  // namespace enc::sim
