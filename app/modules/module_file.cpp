#include "app/modules/module_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <elf.h>
#include <fmt/format.h>

namespace enc::app {
namespace {

constexpr std::uint64_t kMostHead = 1U << 20U;  // bytes: linkers put the table right behind the header

}  // namespace

std::string cut_off(std::string_view head, std::uint64_t size) {
  Elf64_Ehdr header{};
  if (head.size() < sizeof(header)) return {};
  std::memcpy(&header, head.data(), sizeof(header));
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64 ||
      header.e_phentsize != sizeof(Elf64_Phdr))
    return {};
  const auto ends = [&](std::uint64_t at, std::uint64_t length) {
    return at > size || length > size - at
               ? fmt::format("is cut off: it has {} bytes, and a part of {} at byte {}", size, length, at)
               : std::string();
  };
  const std::uint64_t table = header.e_phnum * sizeof(Elf64_Phdr);
  std::string why = ends(header.e_phoff, table);
  if (!why.empty() || header.e_phoff > head.size() || table > head.size() - header.e_phoff) return why;
  for (std::uint64_t i = 0; i < header.e_phnum && why.empty(); ++i) {
    Elf64_Phdr segment{};
    std::memcpy(&segment, head.data() + header.e_phoff + i * sizeof(segment), sizeof(segment));
    if (segment.p_type == PT_LOAD && segment.p_filesz > 0) why = ends(segment.p_offset, segment.p_filesz);
  }
  return why;
}

std::string cut_off(const std::string& path) {
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(path, failed);
  if (failed) return {};
  std::string head(std::min(size, kMostHead), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return cut_off(head, size);
}

}  // namespace enc::app
