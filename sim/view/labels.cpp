#include "sim/view/labels.h"

#include <algorithm>
#include <cmath>

#include "sim/picture/label_rows.h"

namespace enc::sim {
namespace {

constexpr Ink kText{35, 40, 50};
constexpr Ink kLine{120, 128, 140};

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

void write(const std::string& text, double x, double middle, const Image& picture,
           const mjrContext& context) {
  const double base = middle + 0.3 * context.charHeightBig;
  mjr_text(mjFONT_BIG, text.c_str(), &context, static_cast<float>(x / picture.width),
           static_cast<float>(1.0 - base / picture.height), 1, 1, 1);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace

void letter(Image& picture, const mjvScene& scene, const mjrContext& context, const ViewRequest& request,
            int finer) {
  const double margin = 14.0 * finer;
  const double pitch = 1.5 * context.charHeightBig;
  std::vector<LabelRow> rows;
  for (const ViewLabel& label : request.labels) {
    const Eigen::Vector2d at = projected(scene, label.at, picture.width, picture.height);
    rows.push_back({label.left, at.x(), at.y(), at.y()});
  }
  const std::vector<std::string> title = lines_of(request.title);
  const double clear = title.empty() ? 0.0 : (1.0 + static_cast<double>(title.size())) * pitch;
  spread_rows(rows, pitch, clear + pitch, picture.height - pitch);

  const mjrRect all{0, 0, picture.width, picture.height};
  mjr_rectangle(all, 0, 0, 0, 1);
  for (std::size_t i = 0; i < title.size(); ++i)
    write(title[i], margin, (1.0 + static_cast<double>(i)) * pitch, picture, context);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    LabelRow& label = rows[i];
    const std::string& text = request.labels[i].text;
    const double width = text_width(text, context);
    const double x = label.left ? margin : picture.width - margin - width;
    const double end = label.left ? x + width + 5.0 * finer : x - 5.0 * finer;
    write(text, x, label.row, picture, context);
    end_below(label, end, clear);
    stroke(picture, end, label.row, label.x, label.y, 1.0 * finer, label.dot ? 2.5 * finer : 0.0, kLine);
  }
  Image mask(picture.width, picture.height);
  mjr_readPixels(mask.rgb.data(), nullptr, all, &context);
  flip(mask);
  ink_through(picture, mask, kText);
}

}  // namespace enc::sim
