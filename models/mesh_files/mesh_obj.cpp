// Wavefront OBJ: the lines `v x y z` and `f a b c ...`; what only concerns looks is passed over.
#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

constexpr std::array<std::string_view, 17> kPassedOver{
    "vt", "vn", "o",   "g",     "s",      "mg",         "usemtl",    "mtllib", "l",
    "p",  "vp", "lod", "bevel", "usemap", "shadow_obj", "trace_obj", "maplib"};

class ObjReader {
 public:
  explicit ObjReader(const MeshBytes& file) : file_(file), text_(file.bytes) {
    if (text_.starts_with(kBom)) at_ = kBom.size();
  }

  FileMesh read() {
    while (at_ < text_.size()) {
      take_line();
      const std::string_view what = word();
      if (what.empty()) continue;
      if (what == "v") {
        vertex();
      } else if (what == "f") {
        face();
      } else if (std::find(kPassedOver.begin(), kPassedOver.end(), what) == kPassedOver.end()) {
        fail(fmt::format(
            "{} is nothing a triangle mesh has; expected lines 'v x y z' and 'f a b c'; export the "
            "surface as polygons",
            quoted(std::string(what))));
      }
    }
    return {std::move(mesh_), std::move(lines_), {}};
  }

 private:
  // The next line into line_, without its comment.
  void take_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    line_start_ = word_start_ = at_;
    at_ = end + 1;
    ++number_;
    line_ = line_.substr(0, line_.find('#'));
    while (!line_.empty() && is_space(line_.back())) line_.remove_suffix(1);
    cursor_ = 0;
    if (line_.ends_with('\\')) {
      word_start_ = line_start_ + line_.size() - 1;
      fail(
          "a line that goes on in the next is not read; expected one whole statement in a line; join the "
          "two");
    }
  }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
  // The next word of the line; empty at its end.
  std::string_view word() {
    while (cursor_ < line_.size() && is_space(line_[cursor_])) ++cursor_;
    const std::size_t start = cursor_;
    while (cursor_ < line_.size() && !is_space(line_[cursor_])) ++cursor_;
    word_start_ = line_start_ + start;
    return line_.substr(start, cursor_ - start);
  }
  [[noreturn]] void fail(const std::string& what) const { file_.fail_at_text(word_start_, what); }

  void vertex() {
    std::array<double, 3> v{};
    for (double& x : v) {
      const std::string_view text = word();
      if (!read_number(text, x))
        fail(
            fmt::format("{} is no coordinate; expected 'v x y z' with three finite numbers; correct the line",
                        quoted(std::string(text))));
    }
    mesh_.vertices.push_back(v);  // what may follow is a weight or a colour
  }

  // "7", "7/1", "7//3", "7/1/3" or "-1"; only the first number is used.
  std::int32_t corner(std::string_view text) const {
    const std::string_view first = text.substr(0, text.find('/'));
    std::int64_t index = 0;
    const auto [end, bad] = std::from_chars(first.data(), first.data() + first.size(), index);
    const bool rest_good = text.find_first_not_of("-0123456789/") == std::string_view::npos;
    if (bad != std::errc() || end != first.data() + first.size() || !rest_good)
      fail(fmt::format(
          "{} is no corner of a face; expected the number of a vertex, as in 'f 1 2 3' or 'f 1/1/1 ...'; "
          "correct the line",
          quoted(std::string(text))));
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (index == 0 || index > count || index < -count)
      fail(fmt::format(
          "vertex {} is not there; expected 1 to {} (or -1 to -{}), those above this line; correct the line",
          index, count, count));
    return static_cast<std::int32_t>(index > 0 ? index - 1 : count + index);
  }

  void face() {
    polygon_.clear();
    const std::size_t start = word_start_;
    for (std::string_view text = word(); !text.empty(); text = word()) polygon_.push_back(corner(text));
    word_start_ = start;
    if (polygon_.size() < 3)
      fail(fmt::format("a face with {} corners; expected at least 3; correct the line", polygon_.size()));
    if (mesh_.triangles.size() + polygon_.size() > kMostTriangles)
      fail(fmt::format("more than {} triangles; expected fewer; make the mesh coarser", kMostTriangles));
    const std::string wrong = add_polygon(mesh_, polygon_);
    if (!wrong.empty()) fail(wrong);
    lines_.resize(mesh_.triangles.size(), number_);
  }

  const MeshBytes& file_;
  std::string_view text_, line_;
  std::size_t at_ = 0, line_start_ = 0, word_start_ = 0, cursor_ = 0;
  std::vector<std::int32_t> polygon_, lines_;
  std::int32_t number_ = 0;  // of the line
  Mesh mesh_;
};

}  // namespace

FileMesh read_obj(const MeshBytes& file) { return ObjReader(file).read(); }

}  // namespace enc::models
