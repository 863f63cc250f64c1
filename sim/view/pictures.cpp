// The view module: MuJoCo's classic renderer at twice or three times the size of the picture, background and
// lettering on top, then shrunk.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/devices/module.h"
#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/egl.h"
#include "sim/view/painter.h"
#include "sim/view/view.h"

namespace enc::sim {
namespace {

// ---- Lettering of a picture: a title, and labels in both margins with lines to their objects.

constexpr Ink kText{35, 40, 50};
constexpr Ink kLine{120, 128, 140};

// Position of a point of W in the picture.
Eigen::Vector2d projected(const mjvScene& scene, const Point<'W'>& p, int width, int height) {
  const auto vec = [](const float* f) { return Vec3(f[0], f[1], f[2]); };
  const mjvGLCamera& a = scene.camera[0];
  const mjvGLCamera& b = scene.camera[1];  // the two eyes; the picture is taken from between them
  const Vec3 eye = 0.5 * (vec(a.pos) + vec(b.pos));
  const Vec3 forward = vec(a.forward).normalized();
  const Vec3 up = vec(a.up).normalized();
  const Vec3 ray = p.e() - eye;
  const double scale = static_cast<double>(a.frustum_near) / std::max(1e-6, ray.dot(forward));
  const double half = 0.5 * static_cast<double>(a.frustum_top - a.frustum_bottom);
  const double u = ray.dot(forward.cross(up)) * scale / half;
  const double v = ray.dot(up) * scale / half;
  return {0.5 * width + 0.5 * height * u, 0.5 * height * (1.0 - v)};
}

int text_width(const std::string& text, const mjrContext& context) {
  int width = 0;
  for (const char c : text) width += context.charWidthBig[std::clamp(static_cast<int>(c), 0, 126)];
  return width;
}

void write(const std::string& text, double x, double middle, const Image& picture,
           const mjrContext& context) {
  const double base = middle + 0.45 * context.charHeightBig;
  mjr_text(mjFONT_BIG, text.c_str(), &context, static_cast<float>(x / picture.width),
           static_cast<float>(1.0 - base / picture.height), 1, 1, 1);
}

// The lines of a text; a line wider than `most` pixels is wrapped at a space.
std::vector<std::string> lines_of(const std::string& text, double most, const mjrContext& context) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(text.find('\n', at), text.size());
    while (text_width(text.substr(at, end - at), context) > most) {
      const std::size_t space = text.rfind(' ', end - 1);
      if (space == std::string::npos || space <= at) break;
      end = space;
    }
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

// `finer`: number of pixels of `picture` for one pixel of the final picture.
void letter(Image& picture, const mjvScene& scene, const mjrContext& context, const ViewRequest& request,
            int finer) {
  const double margin = 14.0 * finer;
  const double pitch = 1.5 * context.charHeightBig;
  std::vector<LabelRow> rows;
  for (const ViewLabel& label : request.labels) {
    const Eigen::Vector2d at = projected(scene, label.at, picture.width, picture.height);
    const double edge = label.left ? margin : picture.width - margin;
    const double width = text_width(label.text, context) + 5.0 * finer;
    rows.push_back({label.left, at.x(), at.y(), at.y(), edge, label.left ? edge + width : edge - width});
  }
  const std::vector<std::string> title = lines_of(request.title, picture.width - 2.0 * margin, context);
  if (title.empty() && request.labels.empty()) return;
  const double clear = title.empty() ? 0.0 : (1.0 + static_cast<double>(title.size())) * pitch;
  spread_rows(rows, pitch, clear + pitch, picture.height - pitch);
  uncross(rows);

  // A picture without labels needs only the title's rows drawn, read and inked.
  const int high =
      rows.empty() ? std::min(picture.height, static_cast<int>(clear + 0.5 * pitch)) : picture.height;
  const mjrRect used{0, picture.height - high, picture.width, high};
  mjr_rectangle({0, 0, picture.width, picture.height}, 0, 0, 0, 1);  // background of the text mask
  for (std::size_t i = 0; i < title.size(); ++i)
    write(title[i], margin, (1.0 + static_cast<double>(i)) * pitch, picture, context);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    LabelRow& label = rows[i];
    const double from = label.left ? label.edge : label.end + 5.0 * finer;
    brighten(picture, std::min(label.edge, label.end), label.row - 0.4 * pitch,
             std::max(label.edge, label.end), label.row + 0.4 * pitch);
    write(request.labels[i].text, from, label.row, picture, context);
    end_below(label, label.end, clear);
    stroke(picture, label.end, label.row, label.x, label.y, 1.0 * finer, label.dot ? 2.5 * finer : 0.0,
           kLine);
  }
  Image mask(picture.width, high);
  mjr_readPixels(mask.rgb.data(), nullptr, used, &context);
  flip(mask);
  ink_through(picture, mask, kText);
}

// Multiplies the white backdrop, and everything through which it shines, by a soft gradient.
void tint_backdrop(Image& picture, const std::vector<float>& depth, const mjvGLCamera& eye) {
  // Depth of a plane a little in front of the backdrop, as OpenGL stores it.
  const double from = static_cast<double>(eye.frustum_near);
  const double to = static_cast<double>(eye.frustum_far);
  const double behind = (1.0 / from - 1.0 / (0.9 * kBackdrop)) / (1.0 / from - 1.0 / to);
  for (int y = 0; y < picture.height; ++y) {
    const double share = static_cast<double>(y) / picture.height;
    const double tint[3] = {0.98 - 0.11 * share, 0.985 - 0.09 * share, 0.99 - 0.06 * share};
    const auto row =
        static_cast<std::size_t>(picture.height - 1 - y) * static_cast<std::size_t>(picture.width);
    for (int x = 0; x < picture.width; ++x) {
      if (static_cast<double>(depth[row + static_cast<std::size_t>(x)]) < behind) continue;
      for (int c = 0; c < 3; ++c)
        picture.at(x, y)[c] = static_cast<std::uint8_t>(picture.at(x, y)[c] * tint[c]);
    }
  }
}

// Settings of each Finish.
struct Fineness {
  int finer;  // drawn this many times larger, then shrunk: smooth edges
  int shadow_size;
  int stacks;                           // parts of a round body along its axis
  mjtFontScale letters, small_letters;  // small: used in a picture less than kLow high
};
constexpr Fineness kStill{3, 4096, 48, mjFONTSCALE_300, mjFONTSCALE_200};
constexpr Fineness kFilm{2, 2048, 16, mjFONTSCALE_200, mjFONTSCALE_150};
constexpr int kLow = 500;  // px

class OffscreenPictures final : public Pictures {
 public:
  OffscreenPictures(const ViewRequest& first, const Fineness& fineness)
      : finer_(fineness.finer),
        all_{0, 0, finer_ * first.width, finer_ * first.height},
        painter_(first,
                 {fineness.shadow_size, fineness.stacks, PaintSettings{}.slices,
                  first.height < kLow ? fineness.small_letters : fineness.letters, all_.width, all_.height}),
        depth_(static_cast<std::size_t>(all_.width) * static_cast<std::size_t>(all_.height)) {}

  Image draw(const ViewRequest& request) override {
    context_.make_current();
    painter_.paint(request, all_);
    Image picture(all_.width, all_.height);
    mjr_readPixels(picture.rgb.data(), depth_.data(), all_, &painter_.context());
    flip(picture);
    tint_backdrop(picture, depth_, painter_.scene().camera[0]);
    letter(picture, painter_.scene(), painter_.context(), request, finer_);
    return shrunk(picture, finer_);
  }

 private:
  OffscreenContext context_;  // before the painter, which needs it from construction to destruction
  int finer_;
  mjrRect all_;
  Painter painter_;
  std::vector<float> depth_;
};

std::unique_ptr<Pictures> open(const ViewRequest& first, Finish finish) {
  if (first.width < 64 || first.height < 64 || first.width > 4000 || first.height > 4000)
    throw Error("a picture is 64 to 4000 pixels wide and high");
  return std::make_unique<OffscreenPictures>(first, finish == Finish::still ? kStill : kFilm);
}

constexpr ViewModule kView{open, png};
constexpr ModuleInfo kInfo{.name = "view", .view = &kView};

}  // namespace

}  // namespace enc::sim

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sim::kInfo;
}
