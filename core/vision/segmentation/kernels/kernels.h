// What is done to each pixel of a row, twice: plainly, and with AVX2 where the processor has it. Both give
// the same bits. Masks are bytes, 255 or 0. C-like, so that nothing inline is shared by the two.
#pragma once

#include <cstddef>
#include <cstdint>

namespace enc::segmentation {

inline constexpr int kBins = 8;         // of the AVX2 form; other numbers of bins run plainly
inline constexpr int kMostTile = 15;    // px: a column's count of a bin fits 4 bits, a tile's 8
inline constexpr int kMostMedian = 15;  // px: a window's count fits 8 bits

// An arc of hue and what has a hue, so that no pixel needs a division. Of an arc of at most half a turn (or
// its opposite) either end is a share of 256 of one sextant: floor(256 d / chroma) >= t is d >= ceil(t chroma
// / 256).
struct Cut {
  enum : std::uint8_t { past_from = 1, before_to = 2, never = 4 };  // what a sextant asks for
  std::uint8_t sextant[6];
  std::uint16_t from, to;  // 1 to 256
  std::uint8_t opposite;   // 255: skin is what the arc has not
  std::uint8_t least_chroma, least_value;
};

// The light of a frame against that of the background, and how well that explains it (light.h).
struct Explained {
  std::uint16_t gain[3];   // of R, G, B; 1024 is 1
  std::uint16_t white[3];  // what takes the light's colour away again; 256 is 1, the largest
  std::uint16_t noise;     // times a tile's noise (eighths): quarters of 255 that are no change; 256 is 1
  std::uint16_t colour, bright;  // shares that are no change either; 65536 is 1
};

struct ChangeRow {
  const std::uint8_t* rgb;
  const std::uint8_t *red, *green, *blue;  // of the background
  const std::uint8_t* noise;               // of the background, eighths of 255
  const std::uint16_t* side;               // brightness across the row; 16384 is 1
};

// Some rows of an image, at most kMostTile; a mask's rows are as wide.
struct Rows {
  const std::uint8_t* rgb;
  std::ptrdiff_t width;  // px, from one row to the next
  int count;
};

struct Kernels {
  // Of the rows' pixels x from 0 to n - 1: columns[x] counts each bin of hue in four bits; skin says which
  // are of the hue of skin.
  void (*read_rows)(const Rows& rows, int n, int bins, const Cut& cut, std::uint32_t* columns,
                    std::uint8_t* skin);
  // found[i] = 255 where tile i has less than `need` of its `pixels` pixels in common with the model [VisHap
  // eq. 1]. A histogram is a byte for each bin; what lacks to `pixels` has no hue, and is a bin of its own.
  void (*match_row)(const std::uint64_t* seen, const std::uint64_t* model, int n, int pixels, int need,
                    std::uint8_t* found);
  // skin: pixels of the hue of skin once the light's colour is taken away. strong: those of them that the
  // light does not explain. hueless: what it does not explain and has no hue.
  void (*change_row)(const ChangeRow& row, int n, const Explained& light, const Cut& cut,
                     std::uint8_t* strong, std::uint8_t* skin, std::uint8_t* hueless);
  void (*and_row)(const std::uint8_t* with, int n, std::uint8_t* row);
  // a or (b and c)
  void (*join_row)(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int n,
                   std::uint8_t* out);
  // Counts of columns: sums[x] += add[x] is on, -= drop[x] is on. Either may be null.
  void (*slide)(const std::uint8_t* add, const std::uint8_t* drop, int n, std::uint8_t* sums);
  // out[x] = 255 where sums[x] + ... + sums[x + side - 1] is more than half of side^2.
  void (*majority_row)(const std::uint8_t* sums, int n, int side, std::uint8_t* out);
};

[[nodiscard]] const Kernels& plain_kernels();
[[nodiscard]] const Kernels* avx2_kernels();  // null where they cannot run
[[nodiscard]] const Kernels& kernels();       // the faster that can

}  // namespace enc::segmentation
