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
  const double base = middle + 0.45 * context.charHeightBig;
  mjr_text(mjFONT_BIG, text.c_str(), &context, static_cast<float>(x / picture.width),
           static_cast<float>(1.0 - base / picture.height), 1, 1, 1);
}

// The lines of a text; one that is wider than `most` pixels goes on in the next, from a space on.
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

}  // namespace

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

  // Without labels only the title's rows are drawn, read and inked.
  const int high =
      rows.empty() ? std::min(picture.height, static_cast<int>(clear + 0.5 * pitch)) : picture.height;
  const mjrRect used{0, picture.height - high, picture.width, high};
  mjr_rectangle({0, 0, picture.width, picture.height}, 0, 0, 0, 1);  // text has its place in it
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

}  // namespace enc::sim
