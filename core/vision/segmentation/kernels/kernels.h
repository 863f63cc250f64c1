// Operations on the pixels of a row, in two versions: plain, and with AVX2 if the processor has it. Both give
// the same bits. Masks are bytes, 255 or 0. The interface is C-like, so that the two share no inline code.
#pragma once

#include <cstddef>
#include <cstdint>

namespace enc::segmentation {

// AVX2 version only; other numbers of bins use the plain one.
inline constexpr int kBins = 8;
inline constexpr int kMostTile = 15;    // px: a column's count of a bin fits 4 bits, a tile's 8
inline constexpr int kMostMedian = 15;  // px: a window's count fits 8 bits

// An arc of hue and the HueRule, in a form that needs no division for a pixel. In an arc of at most half a
// turn (or its opposite), either end is a share out of 256 of one sextant: floor(256 d / chroma) >= t is d >=
// ceil(t chroma 256).
struct Cut {
  enum : std::uint8_t { past_from = 1, before_to = 2, never = 4 };  // condition of a sextant
  std::uint8_t sextant[6];
  std::uint16_t from, to;  // 1 to 256
  std::uint8_t opposite;   // 255: skin is the complement of the arc
  std::uint8_t least_chroma, least_value;
};

// The light of a frame relative to that of the background, and its residual (light.h).
struct FrameLight {
  std::uint16_t gain[3];   // red, green, blue; 1024 is 1
  std::uint16_t white[3];  // correction of the light's colour; 256 is 1, the largest
  // Threshold of change in a tile's noise (eighths): quarters of 255; 256 is 1.
  std::uint16_t noise;
  std::uint16_t colour, bright;  // thresholds of change as shares; 65536 is 1
};

struct ChangeRow {
  const std::uint8_t* rgb;
  const std::uint8_t *red, *green, *blue;  // background
  const std::uint8_t* noise;               // background, eighths of 255
  const std::uint16_t* side;               // brightness across the row; 16384 is 1
};

// Some rows of an image, at most kMostTile; a mask's rows have equal width.
struct Rows {
  const std::uint8_t* rgb;
  std::ptrdiff_t width;  // px, from one row to the next
  int count;
};

struct Kernels {
  // Reads pixels x from 0 to n - 1 of the rows: columns[x] counts each bin of hue in four bits; `skin` marks
  // the pixels with the hue of skin.
  void (*read_rows)(const Rows& rows, int n, int bins, const Cut& cut, std::uint32_t* columns,
                    std::uint8_t* skin);
  // found[i] = 255 if tile i has less than `need` of its `pixels` pixels in common with the model [VisHap eq.
  // 1]. A histogram is one byte for each bin; pixels missing from the sum `pixels` have no hue, and form a
  // bin of their own.
  void (*match_row)(const std::uint64_t* seen, const std::uint64_t* model, int n, int pixels, int need,
                    std::uint8_t* found);
  // skin: pixels with the hue of skin after removal of the light's colour. strong: the skin pixels that the
  // light does not explain. hueless: unexplained pixels without a hue.
  void (*change_row)(const ChangeRow& row, int n, const FrameLight& light, const Cut& cut,
                     std::uint8_t* strong, std::uint8_t* skin, std::uint8_t* hueless);
  void (*and_row)(const std::uint8_t* with, int n, std::uint8_t* row);
  // a or (b and c)
  void (*join_row)(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int n,
                   std::uint8_t* out);
  // Column counts: sums[x] += add[x] is on, -= drop[x] is on. Either may be null.
  void (*slide)(const std::uint8_t* add, const std::uint8_t* drop, int n, std::uint8_t* sums);
  // out[x] = 255 if sums[x] + ... + sums[x + side - 1] is more than half of side^2.
  void (*majority_row)(const std::uint8_t* sums, int n, int side, std::uint8_t* out);
};

[[nodiscard]] const Kernels& plain_kernels();
[[nodiscard]] const Kernels* avx2_kernels();  // null if the processor lacks AVX2
[[nodiscard]] const Kernels& kernels();       // the fastest that can run

}  // namespace enc::segmentation
