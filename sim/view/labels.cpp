#include "sim/view/labels.h"

#include <algorithm>
#include <cmath>

namespace enc::sim {
namespace {

constexpr Ink kText{35, 40, 50};
constexpr Ink kLine{120, 128, 140};

struct Placed {
  std::string text;
  bool left = false;
  double x = 0, y = 0;  // of the thing, pixels, y downwards
  double row = 0;       // of the text's middle
};

// Where a point of W is in the picture.
Eigen::Vector2d projected(const mjvScene& scene, const Point<'W'>& p, int width, int height) {
  const auto vec = [](const float* f) { return Vec3(f[0], f[1], f[2]); };
  const mjvGLCamera& a = scene.camera[0];
  const mjvGLCamera& b = scene.camera[1];  // the two eyes; the picture is from between them
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

// One margin's labels in the order of what they name, no two closer than `pitch`.
void spread(std::vector<Placed>& labels, bool left, double pitch, double top, double bottom) {
  std::vector<Placed*> column;
  for (Placed& label : labels)
    if (label.left == left) column.push_back(&label);
  std::sort(column.begin(), column.end(), [](const Placed* a, const Placed* b) { return a->y < b->y; });
  double lowest = top;
  for (Placed* label : column) {
    label->row = std::max(lowest, label->y);
    lowest = label->row + pitch;
  }
  double highest = bottom;
  for (auto label = column.rbegin(); label != column.rend(); ++label) {
    (*label)->row = std::min(highest, (*label)->row);
    highest = (*label)->row - pitch;
  }
}

void write(const std::string& text, double x, double middle, const Image& picture,
           const mjrContext& context) {
  const double base = middle + 0.3 * context.charHeightBig;
  mjr_text(mjFONT_BIG, text.c_str(), &context, static_cast<float>(x / picture.width),
           static_cast<float>(1.0 - base / picture.height), 1, 1, 1);
}

}  // namespace

void letter(Image& picture, const mjvScene& scene, const mjrContext& context, const ViewRequest& request,
            int finer) {
  const double margin = 14.0 * finer;
  const double pitch = 1.5 * context.charHeightBig;
  std::vector<Placed> labels;
  for (const ViewLabel& label : request.labels) {
    const Eigen::Vector2d at = projected(scene, label.at, picture.width, picture.height);
    labels.push_back({label.text, label.left, at.x(), at.y(), at.y()});
  }
  const double top = (request.title.empty() ? 1.0 : 3.0) * pitch;
  for (const bool left : {true, false}) spread(labels, left, pitch, top, picture.height - pitch);

  const mjrRect all{0, 0, picture.width, picture.height};
  mjr_rectangle(all, 0, 0, 0, 1);
  if (!request.title.empty()) write(request.title, margin, pitch, picture, context);
  for (const Placed& label : labels) {
    const double width = text_width(label.text, context);
    const double x = label.left ? margin : picture.width - margin - width;
    const double end = label.left ? x + width + 5.0 * finer : x - 5.0 * finer;
    write(label.text, x, label.row, picture, context);
    stroke(picture, end, label.row, label.x, label.y, 1.0 * finer, 2.5 * finer, kLine);
  }
  Image mask(picture.width, picture.height);
  mjr_readPixels(mask.rgb.data(), nullptr, all, &context);
  flip(mask);
  ink_through(picture, mask, kText);
}

}  // namespace enc::sim
