// STL, text and binary. Its normals are not used: the order of the corners defines the outer side.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

static_assert(std::endian::native == std::endian::little,
              "STL and glTF are little-endian: put byte swaps here");

constexpr std::size_t kHeader = 84;  // 80 arbitrary bytes, then the count
constexpr std::size_t kFacet = 50;   // normal, three corners, two arbitrary bytes

std::size_t stated_count(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, sizeof(count));
  return count;
}

// Number of triangles that fit into the file.
std::size_t room(const std::string& bytes) {
  return bytes.size() < kHeader ? 0 : (bytes.size() - kHeader) / kFacet;
}
std::size_t rest(const std::string& bytes) { return bytes.size() - kHeader - kFacet * room(bytes); }

// The size decides, because binary files may begin with "solid" as well.
bool is_text(const std::string& bytes) {
  if (bytes.size() >= kHeader && room(bytes) == stated_count(bytes)) return false;
  const std::string_view head = std::string_view(bytes).substr(0, 1024);
  return head.find('\0') == std::string_view::npos;
}

// The header's count, or the count by size if the header has 0: some programs never write it.
std::size_t triangle_count(const MeshBytes& file, std::vector<std::string>& notes) {
  const std::string& bytes = file.bytes;
  if (bytes.size() < kHeader)
    file.fail_at_byte(bytes.size(),
                      fmt::format("the file ends in its header; expected {} bytes and 50 for each "
                                  "triangle; export it again",
                                  kHeader));
  const std::size_t stated = stated_count(bytes), fits = room(bytes), more = rest(bytes);
  if (stated == 0 && fits > 0 && more == 0) {
    notes.push_back(
        fmt::format("{}: the count of triangles is missing; read {}, which fit the size", file.path, fits));
  } else if (stated != fits) {
    const std::string also = more > 0 ? fmt::format(" and {} bytes", more) : "";
    file.fail_at_byte(
        80, fmt::format(
                "the file says {} triangles, but its {} bytes fit {}{}; expected {} bytes; export it again",
                stated, bytes.size(), fits, also, kHeader + kFacet * stated));
  } else if (more > 0) {
    notes.push_back(rest_note(file, more, "the last triangle"));
  }
  return fits;
}

FileMesh read_binary(const MeshBytes& file) {
  FileMesh read;
  const std::string& bytes = file.bytes;
  const std::size_t count = triangle_count(file, read.notes);
  if (count > kMostTriangles)
    file.fail_at_byte(
        80, fmt::format("{} triangles; expected at most {}; make the mesh coarser", count, kMostTriangles));
  Mesh& mesh = read.mesh;
  mesh.vertices.resize(3 * count);
  mesh.triangles.resize(count);
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const std::size_t at = kHeader + kFacet * (i / 3) + 12 + 12 * (i % 3);
    std::array<float, 3> corner{};
    std::memcpy(corner.data(), bytes.data() + at, sizeof(corner));
    for (std::size_t k = 0; k < 3; ++k) {
      if (!std::isfinite(corner[k]))
        file.fail_at_byte(
            at + 4 * k,
            fmt::format("a corner of triangle {} is {}; expected a finite number; export it again", i / 3,
                        corner[k]));
      mesh.vertices[i][k] = static_cast<double>(corner[k]);
    }
    mesh.triangles[i / 3][i % 3] = static_cast<std::int32_t>(i);
  }
  return read;
}

class TextReader {
 public:
  explicit TextReader(const MeshBytes& file) : file_(file), text_(file.bytes) {
    if (text_.starts_with(kBom)) at_ = kBom.size();
  }

  FileMesh read() {
    for (std::string_view first = word(); !first.empty(); first = word()) {
      const std::size_t left = text_.size() - start_;
      if (!read_.mesh.triangles.empty() && left <= kMostRest && !same(first, "solid")) {
        read_.notes.push_back(rest_note(file_, left, "the last 'endsolid'"));
        break;
      }
      if (!same(first, "solid")) fail(first, "solid");
      skip_line();
      std::string_view next = word();
      for (; same(next, "facet"); next = word()) facet();
      if (!same(next, "endsolid")) fail(next, "facet' or 'endsolid");
      skip_line();
    }
    return std::move(read_);
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  static bool same(std::string_view word, std::string_view wanted) {
    return word.size() == wanted.size() &&
           std::equal(word.begin(), word.end(), wanted.begin(), [](char a, char b) {
             return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
           });
  }
  std::string_view word() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    start_ = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(start_, at_ - start_);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }  // a name may follow
  [[noreturn]] void fail(std::string_view found, std::string_view wanted) const {
    const std::string what =
        found.empty() ? "the file ends here" : quoted(std::string(found)) + " is out of place";
    file_.fail_at_text(start_, fmt::format("{}; expected '{}'; export the file again", what, wanted));
  }
  void expect(std::string_view wanted) {
    const std::string_view found = word();
    if (!same(found, wanted)) fail(found, wanted);
  }

  void facet() {
    expect("normal");
    for (int i = 0; i < 3; ++i)
      if (word().empty()) fail("", "x y z' of the normal");
    expect("outer");
    expect("loop");
    if (read_.mesh.triangles.size() >= kMostTriangles)
      file_.fail_at_text(start_, fmt::format("more than {} triangles; expected fewer; make the mesh coarser",
                                             kMostTriangles));
    std::array<std::int32_t, 3> triangle{};
    for (std::int32_t& corner : triangle) {
      expect("vertex");
      std::array<double, 3> v{};
      for (double& x : v) {
        const std::string_view text = word();
        if (!read_number(text, x)) fail(text, "vertex x y z' with three finite numbers, as 'vertex 0 0 0.01");
      }
      corner = static_cast<std::int32_t>(read_.mesh.vertices.size());
      read_.mesh.vertices.push_back(v);
    }
    read_.mesh.triangles.push_back(triangle);
    expect("endloop");
    expect("endfacet");
  }

  const MeshBytes& file_;
  std::string_view text_;
  std::size_t at_ = 0, start_ = 0;
  FileMesh read_;
};

}  // namespace

FileMesh read_stl(const MeshBytes& file) {
  return is_text(file.bytes) ? TextReader(file).read() : read_binary(file);
}

}  // namespace enc::models
