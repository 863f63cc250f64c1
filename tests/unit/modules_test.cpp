// Modules that are wrong are refused in one line that says what to do.
#include "app/modules.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"
#include "encounter_version.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

// A folder of modules for one test.
class ModulesTest : public testing::Test {
 protected:
  ModulesTest() : folder_(fs::path(testing::TempDir()) / ("modules_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    setenv("ENCOUNTER_MODULES", folder_.c_str(), 1);
  }
  ~ModulesTest() override {
    unsetenv("ENCOUNTER_MODULES");
    fs::remove_all(folder_);
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / ("encounter_" + name + ".so")).string();
  }
  // A module with the layout of ModuleInfo, in C, made by the compiler that built this test.
  void compile(const std::string& name, const std::string& info) const {
    const std::string source = (folder_ / (name + ".c")).string();
    std::ofstream(source) << "#include <stdint.h>\n"
                             "static const struct { uint32_t interface; const char *version, *name; const "
                             "void *driver, *view; }\n"
                             "info = {"
                          << info << "};\nconst void* encounter_module(void) { return &info; }\n";
    ASSERT_EQ(tests::run({"cc", "-shared", "-fPIC", "-o", file(name), source}).code, 0);
  }
  static std::string refusal(const std::string& name) {
    try {
      (void)app::load_module(name);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::device);
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
      return error.what();
    }
    ADD_FAILURE() << name << " was taken";
    return {};
  }
  fs::path folder_;
};

TEST_F(ModulesTest, MissingFileListsWhatIsThere) {
  std::ofstream(file("alpha")) << "";
  std::ofstream(file("beta")) << "";
  EXPECT_THAT(refusal("gamma"), AllOf(HasSubstr(file("gamma")), HasSubstr("no module 'gamma'"),
                                      HasSubstr("alpha, beta"), HasSubstr("ENCOUNTER_MODULES")));
}

TEST_F(ModulesTest, NoFolderAtAllIsSaidToo) {
  setenv("ENCOUNTER_MODULES", "/nowhere", 1);
  EXPECT_THAT(refusal("view"),
              AllOf(HasSubstr("/nowhere/encounter_view.so"), HasSubstr("modules there: none")));
}

TEST_F(ModulesTest, AFileThatIsNoLibrary) {
  std::ofstream(file("text")) << "this is no library";
  EXPECT_THAT(refusal("text"),
              AllOf(HasSubstr(file("text") + ": cannot be loaded"), HasSubstr("build it again")));
}

TEST_F(ModulesTest, ALibraryWithoutTheSymbol) {
  std::ofstream((folder_ / "none.c").string()) << "int nothing;\n";
  ASSERT_EQ(tests::run({"cc", "-shared", "-fPIC", "-o", file("none"), (folder_ / "none.c").string()}).code,
            0);
  EXPECT_THAT(refusal("none"), AllOf(HasSubstr("no Encounter module"), HasSubstr("encounter_module()")));
}

TEST_F(ModulesTest, AnotherInterfaceVersionOrName) {
  const std::string kNumber = std::to_string(kModuleInterface);
  compile("old", "9999, \"" ENCOUNTER_VERSION "\", \"old\", 0, 0");
  EXPECT_THAT(refusal("old"), AllOf(HasSubstr("interface 9999"), HasSubstr("expects " + kNumber),
                                    HasSubstr("build program and modules together")));
  compile("other", kNumber + ", \"77.1\", \"other\", 0, 0");
  EXPECT_THAT(refusal("other"), AllOf(HasSubstr("version 77.1"), HasSubstr(ENCOUNTER_VERSION)));
  compile("renamed", kNumber + ", \"" ENCOUNTER_VERSION "\", \"first\", 0, 0");
  EXPECT_THAT(refusal("renamed"), HasSubstr("calls itself 'first'"));
}

TEST_F(ModulesTest, ANameIsNoPath) { EXPECT_THAT(refusal("../view"), HasSubstr("has no '/'")); }

TEST_F(ModulesTest, TheSampleIsTaken) {
  setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
  const ModuleInfo& info = app::load_module("sample");
  EXPECT_STREQ(info.name, "sample");
  ASSERT_NE(info.driver, nullptr);
  EXPECT_NE(info.driver->manipulator, nullptr);
  EXPECT_NE(info.driver->force, nullptr);
  EXPECT_EQ(info.driver->tracker, nullptr);
  EXPECT_EQ(&app::load_module("sample"), &info);  // loaded once
}

}  // namespace
}  // namespace enc::test
