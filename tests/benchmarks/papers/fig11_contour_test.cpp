// The committed contours of Fig 11: read whole, refused in one line where they are damaged.
#include "benchmarks/deformation/fig11_contour.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/bytes_of.h"

namespace enc::bench::deformation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kModels = tests::source_dir() + "/models";
std::string file() { return test::bytes_of(kModels + "/../benchmarks/reference/fig11_contour.csv"); }

std::string refusal(const std::string& text) {
  try {
    (void)parse_fig11(text, "fig11_contour.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}
std::string with(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), instead);
}

TEST(Fig11Contour, TheCommittedFileStartsOnTheProbe) {
  const Fig11Contours contours = load_fig11(kModels);
  for (std::size_t d = 0; d < fig11_depths().size(); ++d)
    for (const Contour& contour : {contours.probe[d], contours.stylus[d]}) {
      EXPECT_EQ(contour.front()[0], 0.0);
      EXPECT_NEAR(contour.front()[1], 0.033 - fig11_depths()[d], 1e-9);
      EXPECT_NEAR(contour.back().norm(), 0.033, 3e-6);  // at the mount the normal is one-sided
    }
}

TEST(Fig11Contour, ADamagedFileIsRefusedInOneLine) {
  const std::string whole = file();
  EXPECT_EQ(refusal(whole), "");
  const auto one_line = AllOf(HasSubstr("fig11_contour.csv"), Not(HasSubstr("\n")));
  EXPECT_THAT(refusal(""), one_line);
  EXPECT_THAT(refusal(whole.substr(0, whole.size() / 2)), AllOf(one_line, HasSubstr("expected")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000")),
              AllOf(one_line, HasSubstr("3 cells")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000,31.x")),
              AllOf(one_line, HasSubstr("expected a number")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000,nan")),
              AllOf(one_line, HasSubstr("row 1")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000,310")),
              AllOf(one_line, HasSubstr("row 1")));
  EXPECT_THAT(refusal(with(whole, "z_mm", "height")), AllOf(one_line, HasSubstr("no column 'z_mm'")));
}

}  // namespace
}  // namespace enc::bench::deformation
