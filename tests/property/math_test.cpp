// The elementary functions of core/math against MPFR, in units of the last place: at seeded points of each
// range, at all special values, and at the doubles next to multiples of pi/2. README.md in that folder states
// the bounds.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <mpfr.h>

namespace enc {
namespace {

constexpr int kBits = 140;
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Number {
  mpfr_t v;
  Number() { mpfr_init2(v, kBits); }
  explicit Number(double x) : Number() { mpfr_set_d(v, x, MPFR_RNDN); }
  ~Number() { mpfr_clear(v); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
};

using One = double (*)(double);
using Two = double (*)(double, double);
using TrueOne = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using TrueTwo = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

// A function of one or two arguments; its largest allowed error, and its test range [from, to] beside all
// doubles.
struct Function {
  std::string name;
  double bound;  // ulp
  One one;
  TrueOne true_one;
  Two two;
  TrueTwo true_two;
  std::vector<std::pair<double, double>> ranges, second;
};

// The bounds are the largest errors of OnMillionsOfPointsLong, rounded up.
const std::vector<Function>& functions() {
  const auto one = [](const char* name, double bound, One f, TrueOne t,
                      std::vector<std::pair<double, double>> at) {
    return Function{name, bound, f, t, nullptr, nullptr, std::move(at), {}};
  };
  const auto two = [](const char* name, double bound, Two f, TrueTwo t,
                      std::vector<std::pair<double, double>> at,
                      std::vector<std::pair<double, double>> second) {
    return Function{name, bound, nullptr, nullptr, f, t, std::move(at), std::move(second)};
  };
  static const std::vector<std::pair<double, double>> kAngles{{-0.8, 0.8}, {-7, 7}, {-1e4, 1e4}, {-1e7, 1e7}};
  static const std::vector<Function> kAll{
      one("sin", 0.80, &::sin, &mpfr_sin, kAngles),
      one("cos", 0.80, &::cos, &mpfr_cos, kAngles),
      one("tan", 0.86, &::tan, &mpfr_tan, kAngles),
      one("asin", 0.89, &::asin, &mpfr_asin, {{-1, 1}, {0.9, 1}}),
      one("acos", 0.90, &::acos, &mpfr_acos, {{-1, 1}, {0.9, 1}}),
      one("atan", 0.80, &::atan, &mpfr_atan, {{-5, 5}}),
      one("exp", 0.51, &::exp, &mpfr_exp, {{-1, 1}, {-750, 715}, {-746, -707}}),
      one("expm1", 0.83, &::expm1, &mpfr_expm1, {{-1, 1}, {-60, 720}}),
      one("log", 0.52, &::log, &mpfr_log, {{0, 2}, {0.9, 1.1}}),
      one("log2", 0.51, &::log2, &mpfr_log2, {{0, 2}, {0.9, 1.1}}),
      one("log10", 0.51, &::log10, &mpfr_log10, {{0, 2}, {0.9, 1.1}}),
      one("log1p", 0.85, &::log1p, &mpfr_log1p, {{-1, 2}, {1, 1e9}}),
      one("tanh", 2.2, &::tanh, &mpfr_tanh, {{-1, 1}, {-25, 25}}),
      one("cbrt", 0.67, &::cbrt, &mpfr_cbrt, {{-8, 8}}),
      one("erf", 0.96, &::erf, &mpfr_erf, {{-1, 1}, {-7, 7}}),
      two("atan2", 1.45, &::atan2, &mpfr_atan2, {{-1, 1}}, {{-1, 1}}),
      two("hypot", 1.0, &::hypot, &mpfr_hypot, {{-1, 1}}, {{-1, 1}}),
      two("pow", 0.51, &::pow, &mpfr_pow, {{0, 4}, {0.5, 2}, {0, 100}},
          {{-10, 10}, {-1000, 1000}, {-180, 180}}),
  };
  return kAll;
}

// The distance between two neighbours of x.
double last_place(double x) {
  const double a = std::fabs(x);
  return a < std::numeric_limits<double>::min() ? std::numeric_limits<double>::denorm_min()
                                                : std::nextafter(a, kInf) - a;
}

// |got - truth| in last places; infinity where one is no number or has the wrong sign.
double error_of(double got, const Number& truth) {
  const double nearest = mpfr_get_d(truth.v, MPFR_RNDN);
  if (std::isnan(got) || std::isnan(nearest)) return std::isnan(got) == std::isnan(nearest) ? 0.0 : kInf;
  if (std::signbit(got) != std::signbit(nearest)) return kInf;
  if (std::isinf(got) || std::isinf(nearest)) {
    // If the truth is slightly beyond the largest double, that double may be the answer.
    if (got == nearest) return 0.0;
    return std::fabs(std::isinf(got) ? nearest : got) == std::numeric_limits<double>::max() ? 0.5 : kInf;
  }
  Number difference;
  mpfr_sub_d(difference.v, truth.v, got, MPFR_RNDN);
  mpfr_div_d(difference.v, difference.v, last_place(nearest), MPFR_RNDN);
  return std::fabs(mpfr_get_d(difference.v, MPFR_RNDN));
}

double error_at(const Function& f, double x, double y) {
  const Number a(x), b(y);
  Number truth;
  if (f.one != nullptr) {
    f.true_one(truth.v, a.v, MPFR_RNDN);
    return error_of(f.one(x), truth);
  }
  f.true_two(truth.v, a.v, b.v, MPFR_RNDN);
  return error_of(f.two(x, y), truth);
}

struct WorstError {
  double error = 0.0, x = 0.0, y = 0.0;
  void look(const Function& f, double at, double second) {
    const double e = error_at(f, at, second);
    if (e > error) *this = {e, at, second};
  }
};

void expect_within(const Function& f, const WorstError& worst) {
  char where[80];
  std::snprintf(where, sizeof where, "%a, %a", worst.x, worst.y);
  EXPECT_LE(worst.error, f.bound) << f.name << " at " << where;
}

class Points {
 public:
  double in(const std::pair<double, double>& range) {
    const double x =
        range.first + (range.second - range.first) * static_cast<double>(draw_() >> 11) * 0x1p-53;
    return draw_() % 4 == 0 ? std::ldexp(x, -static_cast<int>(draw_() % 40)) : x;  // small ones, too
  }
  double any() {
    const std::uint64_t bits = draw_();
    double x = 0.0;
    std::memcpy(&x, &bits, sizeof x);
    return x;
  }
  std::uint64_t whole() { return draw_(); }

 private:
  std::mt19937_64 draw_{1};
};

void expect_small_errors(int points) {
  Points draw;
  for (const Function& f : functions()) {
    WorstError worst;
    for (std::size_t k = 0; k < f.ranges.size(); ++k)
      for (int i = 0; i < points; ++i)
        worst.look(f, draw.in(f.ranges[k]), f.two != nullptr ? draw.in(f.second[k]) : 0.0);
    for (int i = 0; i < points; ++i) worst.look(f, draw.any(), draw.any());
    expect_within(f, worst);
    testing::Test::RecordProperty(f.name, std::to_string(worst.error));
  }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kPoints = 1000;
constexpr int kMany = 20'000;
#else
constexpr int kPoints = 10'000;
constexpr int kMany = 1'000'000;
#endif

TEST(Math, ErrsLessThanItSays) { expect_small_errors(kPoints); }
TEST(MathLong, OnMillionsOfPoints) { expect_small_errors(kMany); }

// Zeros, infinities, the smallest and largest, whole and half numbers, and their neighbours.
TEST(Math, SpecialValuesAreThoseOfTheStandard) {
  std::vector<double> values{std::numeric_limits<double>::quiet_NaN()};
  for (const double a : {0.0,    kInf,   0x1p-1074,        0x1p-1022, 0x1p-512, 0x1p-66, 0x1p-54, 0x1p-27,
                         0.25,   0.5,    0.6875,           0.975,     1.0,      1.5,     2.0,     2.4375,
                         3.0,    10.0,   709.782712893384, 745.2,     1000.0,   1024.0,  0x1p52,  0x1p53,
                         0x1p63, 0x1p64, 0x1p512,          0x1p1023})
    for (const double b : {std::nextafter(a, 0.0), a, std::nextafter(a, kInf)})
      for (const double sign : {1.0, -1.0}) values.push_back(sign * b);
  for (const Function& f : functions()) {
    WorstError worst;
    for (const double x : values) {
      if (f.two == nullptr)
        worst.look(f, x, 0.0);
      else
        for (const double y : values) worst.look(f, x, y);
    }
    expect_within(f, worst);
  }
}

// If sin, cos or tan nearly vanish, all of x's bits and many of pi's count. The hardest double is
// 6381956970095103 2^797.
TEST(Math, AnglesNextToAMultipleOfARightAngle) {
  Points draw;
  std::vector<double> angles{0x1.6ac5b262ca1ffp+849, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1,
                             std::numeric_limits<double>::max()};
  mpfr_t right, turns;
  mpfr_init2(right, 1400);
  mpfr_init2(turns, 1400);
  for (int i = 0; i < kPoints; ++i) {
    mpfr_const_pi(right, MPFR_RNDN);
    mpfr_div_2ui(right, right, 1, MPFR_RNDN);
    mpfr_set_d(turns, static_cast<double>(draw.whole() >> (draw.whole() % 64)), MPFR_RNDN);
    if (i % 2 == 0) mpfr_mul_2ui(turns, turns, draw.whole() % 950, MPFR_RNDN);
    mpfr_mul(right, right, turns, MPFR_RNDN);
    angles.push_back(mpfr_get_d(right, MPFR_RNDN));
  }
  mpfr_clear(right);
  mpfr_clear(turns);
  for (std::size_t k = 0; k < 3; ++k) {
    WorstError worst;
    for (const double x : angles) worst.look(functions()[k], x, 0.0);
    expect_within(functions()[k], worst);
  }
}

TEST(Math, SinCosIsSinAndCos) {
  Points draw;
  for (int i = 0; i < 10 * kPoints; ++i) {
    const double x = i % 2 == 0 ? draw.in({-10, 10}) : draw.any();
    double s = 0.0, c = 0.0;
    ::sincos(x, &s, &c);
    const double sine = functions()[0].one(x), cosine = functions()[1].one(x);
    ASSERT_TRUE((s == sine && c == cosine) || (std::isnan(s) && std::isnan(sine))) << x;
  }
}

// An exact result must be exact.
TEST(Math, WholePowersAreExact) {
  const auto log2 = functions()[9].one, log10 = functions()[10].one, cbrt = functions()[13].one;
  const auto power = functions()[17].two;
  for (int k = -1074; k <= 1023; ++k) {
    EXPECT_EQ(log2(std::ldexp(1.0, k)), k);
    EXPECT_EQ(power(2.0, k), std::ldexp(1.0, k));
  }
  double ten = 1.0;
  for (int k = 0; k <= 22; ++k, ten *= 10.0) {
    EXPECT_EQ(log10(ten), k);
    EXPECT_EQ(power(10.0, k), ten);
  }
  for (int k = -1000; k <= 1000; ++k) EXPECT_EQ(cbrt(static_cast<double>(k) * k * k), k);
}

// This program calls these functions, not the C library's; so do libmujoco and its libraries.
TEST(Math, TheCLibrarysAreNotInUse) {
  void* const libm = ::dlopen("libm.so.6", RTLD_NOW);
  ASSERT_NE(libm, nullptr);
  for (const Function& f : functions()) {
    void* const own = ::dlsym(RTLD_DEFAULT, f.name.c_str());
    ASSERT_NE(own, nullptr);
    EXPECT_NE(own, ::dlsym(libm, f.name.c_str())) << f.name;
  }
  ::dlclose(libm);
}

}  // namespace
}  // namespace enc
