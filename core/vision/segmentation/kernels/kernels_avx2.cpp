// Compiled with AVX2: this file may use no inline function of another file, because the linker keeps only one
// copy of it.
#include "core/vision/segmentation/kernels/kernels.h"

#if defined(__AVX2__)
#include <immintrin.h>

namespace enc::segmentation {
namespace {

using V = __m256i;

V load(const void* p) { return _mm256_loadu_si256(static_cast<const V*>(p)); }
void store(void* p, V v) { _mm256_storeu_si256(static_cast<V*>(p), v); }
V bytes(int x) { return _mm256_set1_epi8(static_cast<char>(x)); }
V words(int x) { return _mm256_set1_epi16(static_cast<short>(x)); }
V at_least(V a, V b) { return _mm256_cmpeq_epi8(_mm256_max_epu8(a, b), a); }  // unsigned bytes
V is_not(V v) { return _mm256_xor_si256(v, bytes(255)); }
V low(V v) { return _mm256_unpacklo_epi8(v, _mm256_setzero_si256()); }
V high(V v) { return _mm256_unpackhi_epi8(v, _mm256_setzero_si256()); }
V both(const char* sixteen) {
  return _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(sixteen)));
}

struct Rgb {
  V r, g, b;
};

// Loads 32 pixels, in order. Each half takes 16 pixels from three loads. Byte i of a channel is at a
// different position in each of the three. So a blend merges them first, and one shuffle puts them in order.
Rgb load_rgb(const unsigned char* p) {
  const auto half = [p](int at) {
    const auto part = [p](int i) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p + i)); };
    return _mm256_inserti128_si256(_mm256_castsi128_si256(part(at)), part(at + 48), 1);
  };
  static constexpr char kR[16] = {0, 3, 6, 9, 12, 15, 2, 5, 8, 11, 14, 1, 4, 7, 10, 13};
  static constexpr char kG[16] = {1, 4, 7, 10, 13, 0, 3, 6, 9, 12, 15, 2, 5, 8, 11, 14};
  static constexpr char kB[16] = {2, 5, 8, 11, 14, 1, 4, 7, 10, 13, 0, 3, 6, 9, 12, 15};
  static constexpr char kFirst[16] = {-1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1};  // i = 0 mod 3
  static constexpr char kSecond[16] = {0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0};  // i = 1 mod 3
  const V a = half(0), b = half(16), c = half(32), first = both(kFirst), second = both(kSecond);
  const auto mix = [&](V zero, V one, V two) {
    return _mm256_blendv_epi8(_mm256_blendv_epi8(two, one, second), zero, first);
  };
  return {_mm256_shuffle_epi8(mix(a, c, b), both(kR)), _mm256_shuffle_epi8(mix(b, a, c), both(kG)),
          _mm256_shuffle_epi8(mix(c, b, a), both(kB))};
}

struct Hue {
  V with;     // 255 if the pixel has a hue
  V sextant;  // 0 to 5; either one where two sextants meet, but never 2 for 3 or 5 for 0
  V d, chroma;
};

Hue hue_of(const Rgb& p, const Cut& cut) {
  // Bits of the comparisons: 1 g >= b, 2 b >= g, 4 r >= g, 8 b >= r.
  static constexpr char kSextant[16] = {0, 1, 3, 3, 0, 0, 5, 0, 0, 2, 3, 3, 0, 2, 4, 0};
  const V gb = _mm256_max_epu8(p.g, p.b), most = _mm256_max_epu8(p.r, gb);
  const V least = _mm256_min_epu8(p.r, _mm256_min_epu8(p.g, p.b));
  const V index = _mm256_or_si256(_mm256_or_si256(_mm256_and_si256(_mm256_cmpeq_epi8(gb, p.g), bytes(1)),
                                                  _mm256_and_si256(_mm256_cmpeq_epi8(gb, p.b), bytes(2))),
                                  _mm256_or_si256(_mm256_and_si256(at_least(p.r, p.g), bytes(4)),
                                                  _mm256_and_si256(at_least(p.b, p.r), bytes(8))));
  Hue hue;
  hue.sextant = _mm256_shuffle_epi8(both(kSextant), index);
  hue.chroma = _mm256_sub_epi8(most, least);
  const V middle =
      _mm256_xor_si256(_mm256_xor_si256(_mm256_xor_si256(p.r, p.g), _mm256_xor_si256(p.b, most)), least);
  const V odd = _mm256_slli_epi16(hue.sextant, 7);
  hue.d = _mm256_blendv_epi8(_mm256_sub_epi8(middle, least), _mm256_sub_epi8(most, middle), odd);
  hue.with =
      _mm256_and_si256(at_least(hue.chroma, bytes(cut.least_chroma)), at_least(most, bytes(cut.least_value)));
  return hue;
}

// 4 times the bin out of eight: 45 degrees are 3/4 of a sextant, so three sextants contain one edge each.
V four_bins(const Hue& hue) {
  static constexpr char kFirstBin[16] = {0, 4, 8, 16, 20, 24};
  static constexpr char kThird[16] = {-1, 0, 0, -1, 0, 0}, kFirstThird[16] = {0, -1, 0, 0, -1, 0};
  const V c = hue.chroma, zero = _mm256_setzero_si256();
  const V half = _mm256_avg_epu8(c, zero), quarter = _mm256_avg_epu8(half, zero);  // both rounded up
  const V three = _mm256_sub_epi8(c, _mm256_and_si256(_mm256_srli_epi16(c, 2), bytes(63)));
  const V edge = _mm256_blendv_epi8(
      _mm256_blendv_epi8(quarter, half, _mm256_shuffle_epi8(both(kFirstThird), hue.sextant)), three,
      _mm256_shuffle_epi8(both(kThird), hue.sextant));
  const V up = _mm256_and_si256(at_least(hue.d, edge), bytes(4));
  return _mm256_add_epi8(_mm256_shuffle_epi8(both(kFirstBin), hue.sextant), up);
}

// ceil(t chroma / 256) for t up to 256: t chroma + 255 fits 16 bits.
V share(V chroma, V t) {
  const auto of = [t](V c) {
    return _mm256_srli_epi16(_mm256_add_epi16(_mm256_mullo_epi16(c, t), words(255)), 8);
  };
  return _mm256_packus_epi16(of(low(chroma)), of(high(chroma)));
}

V skin_of(const Hue& hue, const Cut& cut) {
  const char asked[16] = {static_cast<char>(cut.sextant[0]), static_cast<char>(cut.sextant[1]),
                          static_cast<char>(cut.sextant[2]), static_cast<char>(cut.sextant[3]),
                          static_cast<char>(cut.sextant[4]), static_cast<char>(cut.sextant[5])};
  const V past = _mm256_and_si256(at_least(hue.d, share(hue.chroma, words(cut.from))), bytes(Cut::past_from));
  const V before =
      _mm256_andnot_si256(at_least(hue.d, share(hue.chroma, words(cut.to))), bytes(Cut::before_to));
  const V lacks =
      _mm256_andnot_si256(_mm256_or_si256(past, before), _mm256_shuffle_epi8(both(asked), hue.sextant));
  const V in = _mm256_cmpeq_epi8(lacks, _mm256_setzero_si256());
  return _mm256_and_si256(_mm256_xor_si256(in, bytes(cut.opposite)), hue.with);
}

// Counts of each hue bin in 32 columns, four bits each. A shift of 32 or more counts nothing, so a pixel
// without a hue is not counted.
struct Columns {
  V eight[4] = {_mm256_setzero_si256(), _mm256_setzero_si256(), _mm256_setzero_si256(),
                _mm256_setzero_si256()};

  void add(V shifts) {
    alignas(32) unsigned char at[32];
    _mm256_store_si256(reinterpret_cast<V*>(at), shifts);
    for (int i = 0; i < 4; ++i) {
      const V shift = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at + 8 * i)));
      eight[i] = _mm256_add_epi32(eight[i], _mm256_sllv_epi32(_mm256_set1_epi32(1), shift));
    }
  }
};

void read_rows(const Rows& rows, int n, int bins, const Cut& cut, std::uint32_t* columns,
               std::uint8_t* skin) {
  int x = 0;
  for (; bins == kBins && x + 32 <= n; x += 32) {
    Columns sums;
    for (int y = 0; y < rows.count; ++y) {
      const std::uint8_t* rgb = rows.rgb + 3 * (rows.width * y + x);
      // Prefetch this position of the next tiles, because the processor cannot predict row-by-row access.
      _mm_prefetch(rgb + 3 * rows.width * rows.count, _MM_HINT_T0);
      _mm_prefetch(rgb + 3 * rows.width * rows.count + 64, _MM_HINT_T0);
      const Hue hue = hue_of(load_rgb(rgb), cut);
      store(skin + rows.width * y + x, skin_of(hue, cut));
      sums.add(_mm256_or_si256(four_bins(hue), is_not(hue.with)));
    }
    for (int i = 0; i < 4; ++i) store(columns + x + 8 * i, sums.eight[i]);
  }
  if (x == n) return;
  const Rows rest{rows.rgb + 3 * x, rows.width, rows.count};
  plain_kernels().read_rows(rest, n - x, bins, cut, columns + x, skin + x);
}

void match_row(const std::uint64_t* seen, const std::uint64_t* model, int n, int pixels, int need,
               std::uint8_t* found) {
  int i = 0;
  const V zero = _mm256_setzero_si256(), least = _mm256_set1_epi64x(need - pixels);
  for (; i + 4 <= n; i += 4) {
    const V a = load(seen + i), b = load(model + i);
    const V common = _mm256_sad_epu8(_mm256_min_epu8(a, b), zero);
    const V most = _mm256_max_epi32(_mm256_sad_epu8(a, zero), _mm256_sad_epu8(b, zero));
    const V less = _mm256_cmpgt_epi64(least, _mm256_sub_epi64(common, most));
    const int bits = _mm256_movemask_pd(_mm256_castsi256_pd(less));
    for (int k = 0; k < 4; ++k) found[i + k] = (bits >> k & 1) != 0 ? 255 : 0;
  }
  if (i < n) plain_kernels().match_row(seen + i, model + i, n - i, pixels, need, found + i);
}

// 16 pixels in words, in the order of unpacking; packing restores their order.
struct Words {
  V r, g, b;
};
Words low(const Rgb& p) { return {low(p.r), low(p.g), low(p.b)}; }
Words high(const Rgb& p) { return {high(p.r), high(p.g), high(p.b)}; }
V part(V v, unsigned share) { return _mm256_mulhi_epu16(v, words(static_cast<int>(share))); }
V sum(const Words& p) { return _mm256_add_epi16(_mm256_add_epi16(p.r, p.g), p.b); }
V four(V v) { return _mm256_slli_epi16(v, 2); }

V expected(V mean, unsigned gain) {
  return _mm256_min_epu16(part(_mm256_slli_epi16(mean, 8), gain), words(1020));
}

// |a e - b s| > limit m, per word; the products have 32 bits.
V apart(V a, V b, V e, V s, V limit, V m) {
  const V minus = _mm256_sub_epi16(_mm256_setzero_si256(), s), zero = _mm256_setzero_si256();
  const auto half = [](V ab, V es, V l, V mm) {
    return _mm256_cmpgt_epi32(_mm256_abs_epi32(_mm256_madd_epi16(ab, es)), _mm256_madd_epi16(l, mm));
  };
  return _mm256_packs_epi32(half(_mm256_unpacklo_epi16(a, b), _mm256_unpacklo_epi16(e, minus),
                                 _mm256_unpacklo_epi16(limit, zero), _mm256_unpacklo_epi16(m, zero)),
                            half(_mm256_unpackhi_epi16(a, b), _mm256_unpackhi_epi16(e, minus),
                                 _mm256_unpackhi_epi16(limit, zero), _mm256_unpackhi_epi16(m, zero)));
}

V changed(const Words& p, const Words& mean, V noise, V side, const FrameLight& light) {
  const Words seen{four(p.r), four(p.g), four(p.b)};
  const Words was{expected(mean.r, light.gain[0]), expected(mean.g, light.gain[1]),
                  expected(mean.b, light.gain[2])};
  const V s = sum(seen), e = sum(was), most = _mm256_max_epi16(s, e);
  const V unclear = _mm256_min_epu16(part(_mm256_slli_epi16(noise, 8), light.noise), words(0x1fff));
  const V limit = _mm256_add_epi16(unclear, part(most, light.colour));
  const V colour =
      _mm256_or_si256(apart(seen.r, was.r, e, s, limit, most), apart(seen.b, was.b, e, s, limit, most));
  const V lit = _mm256_min_epu16(_mm256_mulhi_epu16(four(e), side), words(3 * 1020));
  const V away = _mm256_abs_epi16(_mm256_sub_epi16(s, lit));
  const V usual = _mm256_add_epi16(_mm256_add_epi16(unclear, unclear), part(lit, light.bright));
  return _mm256_or_si256(colour, _mm256_cmpgt_epi16(away, usual));
}

V whiter(V channel, unsigned gain) {
  const auto of = [gain](V v) {
    return _mm256_srli_epi16(
        _mm256_add_epi16(_mm256_mullo_epi16(v, words(static_cast<int>(gain))), words(128)), 8);
  };
  return _mm256_packus_epi16(of(low(channel)), of(high(channel)));
}

void change_row(const ChangeRow& row, int n, const FrameLight& light, const Cut& cut, std::uint8_t* strong,
                std::uint8_t* skin, std::uint8_t* hueless) {
  int x = 0;
  for (; x + 32 <= n; x += 32) {
    const Rgb p = load_rgb(row.rgb + 3 * x);
    const Rgb mean{load(row.red + x), load(row.green + x), load(row.blue + x)};
    const V noise = load(row.noise + x);
    const Rgb white{whiter(p.r, light.white[0]), whiter(p.g, light.white[1]), whiter(p.b, light.white[2])};
    const Hue hue = hue_of(white, cut);
    const V is_skin = skin_of(hue, cut);
    store(skin + x, is_skin);
    // Unpacking starts with words 0 to 7 and 16 to 23 of the row.
    const V one = load(row.side + x), two = load(row.side + x + 16);
    const V a = changed(low(p), low(mean), low(noise), _mm256_permute2x128_si256(one, two, 0x20), light);
    const V b = changed(high(p), high(mean), high(noise), _mm256_permute2x128_si256(one, two, 0x31), light);
    const V unlike = _mm256_packs_epi16(a, b);
    store(strong + x, _mm256_and_si256(is_skin, unlike));
    store(hueless + x, _mm256_andnot_si256(hue.with, unlike));
  }
  if (x == n) return;
  const ChangeRow rest{row.rgb + 3 * x, row.red + x,   row.green + x,
                       row.blue + x,    row.noise + x, row.side + x};
  plain_kernels().change_row(rest, n - x, light, cut, strong + x, skin + x, hueless + x);
}

void and_row(const std::uint8_t* with, int n, std::uint8_t* row) {
  int x = 0;
  for (; x + 32 <= n; x += 32) store(row + x, _mm256_and_si256(load(row + x), load(with + x)));
  for (; x < n; ++x) row[x] &= with[x];
}

void join_row(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int n, std::uint8_t* out) {
  int x = 0;
  for (; x + 32 <= n; x += 32)
    store(out + x, _mm256_or_si256(load(a + x), _mm256_and_si256(load(b + x), load(c + x))));
  for (; x < n; ++x) out[x] = static_cast<std::uint8_t>(a[x] | (b[x] & c[x]));
}

void slide(const std::uint8_t* add, const std::uint8_t* drop, int n, std::uint8_t* sums) {
  int x = 0;
  for (; x + 32 <= n; x += 32) {  // 255 is -1
    V v = load(sums + x);
    if (add != nullptr) v = _mm256_sub_epi8(v, load(add + x));
    if (drop != nullptr) v = _mm256_add_epi8(v, load(drop + x));
    store(sums + x, v);
  }
  if (x < n)
    plain_kernels().slide(add != nullptr ? add + x : nullptr, drop != nullptr ? drop + x : nullptr, n - x,
                          sums + x);
}

void majority_row(const std::uint8_t* sums, int n, int side, std::uint8_t* out) {
  int x = 0;
  const V enough = bytes(side * side / 2 + 1);
  for (; x + 32 <= n; x += 32) {
    V v = load(sums + x);
    for (int k = 1; k < side; ++k) v = _mm256_add_epi8(v, load(sums + x + k));
    store(out + x, at_least(v, enough));
  }
  if (x < n) plain_kernels().majority_row(sums + x, n - x, side, out + x);
}

}  // namespace

const Kernels* avx2_kernels() {
  static constexpr Kernels kFast{read_rows, match_row, change_row, and_row, join_row, slide, majority_row};
  return __builtin_cpu_supports("avx2") != 0 ? &kFast : nullptr;
}

}  // namespace enc::segmentation

#else

namespace enc::segmentation {
const Kernels* avx2_kernels() { return nullptr; }
}  // namespace enc::segmentation

#endif
