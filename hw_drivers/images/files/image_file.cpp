#include "hw_drivers/images/files/image_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include "core/base/error.h"

namespace enc::images {
namespace {

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n", kJpeg = "\xff\xd8\xff";
constexpr std::size_t kHeader = 1U << 16U;       // bytes: nearly every header fits
constexpr std::size_t kLongestFile = 1U << 28U;  // bytes

[[noreturn]] void refuse(const std::string& name, const std::string& what, const std::string& way_out) {
  throw Error(fmt::format("{}: {}; expected a whole PNG or JPEG image; {}", name, what, way_out));
}

// Reads only regular files: opening a named pipe would block.
std::string bytes_of(const std::string& path, std::size_t most) {
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
    refuse(path, "is no file", "name one");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (file == nullptr) refuse(path, std::strerror(errno), "see to its name and whether it may be read");
  std::string bytes;
  std::array<char, 1U << 16U> part;
  while (bytes.size() < most) {
    const std::size_t got =
        std::fread(part.data(), 1, std::min(part.size(), most - bytes.size()), file.get());
    bytes.append(part.data(), got);
    if (got == 0) break;
  }
  if (std::ferror(file.get()) != 0) refuse(path, "cannot be read", "is it a folder?");
  return bytes;
}

ImageSize checked(std::int64_t width, std::int64_t height, const std::string& name) {
  if (width < 1 || height < 1 || width > kLargest || height > kLargest || width * height > kMostPixels)
    refuse(name, fmt::format("is {} x {} px", width, height),
           fmt::format("make it smaller: at most {} px on a side and {} million in all", kLargest,
                       kMostPixels / 1'000'000));
  return {static_cast<int>(width), static_cast<int>(height)};
}

struct JpegReader {
  tjhandle handle = tjInitDecompress();
  JpegReader() = default;
  ~JpegReader() { tjDestroy(handle); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  [[nodiscard]] std::string words() const { return tjGetErrorStr2(handle); }
};

const unsigned char* as_bytes(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

// Returns an empty size if the header is longer than the given bytes.
ImageSize jpeg_size(std::string_view bytes, const std::string& name, const JpegReader& reader) {
  int width = 0, height = 0, sampling = 0, colours = 0;
  if (tjDecompressHeader3(reader.handle, as_bytes(bytes), bytes.size(), &width, &height, &sampling,
                          &colours) != 0)
    return {};
  return checked(width, height, name);
}

// IHDR is always first: its length and name, then width and height in big-endian order.
ImageSize png_size(std::string_view bytes, const std::string& name) {
  if (bytes.size() < 24 || bytes.substr(12, 4) != "IHDR")
    refuse(name, "is cut off or damaged in its header", "make or copy it again");
  const auto number = [&](std::size_t at) {
    std::int64_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes[i]);
    return value;
  };
  return checked(number(16), number(20), name);
}

void make_room(const ImageSize& size, Image& into) {
  if (into.width != size.width || into.height != size.height) into = Image(size.width, size.height);
}

void decode_png(std::string_view bytes, const std::string& name, Image& into) {
  const ImageSize size = png_size(bytes, name);  // check the size before libpng does
  // libpng stops reading at the last pixel.
  if (bytes.rfind("IEND\xae\x42\x60\x82") == std::string_view::npos)
    refuse(name, "is cut off before its end", "make or copy it again");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto fail = [&] {
    const std::string why = image.message;
    png_image_free(&image);
    refuse(name, fmt::format("is damaged or cut off ({})", why), "make or copy it again");
  };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) fail();
  image.format = PNG_FORMAT_RGB;
  make_room(size, into);
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&image, &black, into.rgb.data(), 0, nullptr) == 0) fail();
}

// A JPEG has no checksum. Warnings of libjpeg, such as an early end, count as errors here.
void decode_jpeg(std::string_view bytes, const std::string& name, Image& into) {
  const JpegReader reader;
  const ImageSize size = jpeg_size(bytes, name, reader);
  if (size.width == 0)
    refuse(name, fmt::format("is damaged or cut off ({})", reader.words()), "make or copy it again");
  make_room(size, into);
  if (tjDecompress2(reader.handle, as_bytes(bytes), bytes.size(), into.rgb.data(), size.width, 0, size.height,
                    TJPF_RGB, TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
    refuse(name, fmt::format("is damaged or cut off ({})", reader.words()), "make or copy it again");
}

[[noreturn]] void refuse_kind(std::string_view bytes, const std::string& name) {
  refuse(name, bytes.empty() ? "is empty" : "is neither PNG nor JPEG, whatever its name says",
         "make or convert it again");
}

}  // namespace

bool is_image_name(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower.ends_with(".png") || lower.ends_with(".jpg") || lower.ends_with(".jpeg");
}

ImageSize image_size(const std::string& path) {
  std::string bytes = bytes_of(path, kHeader);
  if (bytes.starts_with(kPng)) return png_size(bytes, path);
  if (!bytes.starts_with(kJpeg)) refuse_kind(bytes, path);
  const JpegReader reader;
  ImageSize size = jpeg_size(bytes, path, reader);
  if (size.width == 0 && bytes.size() == kHeader)
    size = jpeg_size(bytes_of(path, kLongestFile), path, reader);
  if (size.width == 0)
    refuse(path, fmt::format("is damaged or cut off ({})", reader.words()), "make or copy it again");
  return size;
}

void decode_image(std::string_view bytes, const std::string& name, Image& into) {
  if (bytes.starts_with(kPng)) return decode_png(bytes, name, into);
  if (bytes.starts_with(kJpeg)) return decode_jpeg(bytes, name, into);
  refuse_kind(bytes, name);
}

void read_image(const std::string& path, Image& into) {
  const std::string bytes = bytes_of(path, kLongestFile);
  if (bytes.size() == kLongestFile) refuse(path, "is longer than 256 MB", "make it smaller");
  decode_image(bytes, path, into);
}

std::string png_of(const ImageView& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  header.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb, 0, nullptr) == 0)
    throw Error(fmt::format("no PNG can be made of an image ({})", header.message));
  bytes.resize(size);
  return bytes;
}

}  // namespace enc::images
