// The loader refuses a faulty module with one line that says what to do.
#include "app/modules/modules.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include "core/base/error.h"
#include "encounter_version.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;
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
                             "static const struct { uint32_t interface; uint64_t border; const char "
                             "*version, *name; const void *driver, *view; }\n"
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

// A copy may stop at any byte. Loading an incomplete file would end the program.
TEST_F(ModulesTest, AFileThatIsCutOff) {
  const std::string whole = bytes_of(fs::path(tests::module_folder()) / "encounter_sample.so");
  std::uint64_t at = 1;
  for (; at < whole.size(); at += 1 + at / 3) {
    std::ofstream(file("sample"), std::ios::binary) << whole.substr(0, at);
    if (app::cut_off(file("sample")).empty() && at > 64) break;  // the loaded part is complete
    EXPECT_THAT(refusal("sample"),
                AllOf(HasSubstr(file("sample") + ": cannot be loaded"), HasSubstr("again")));
  }
  EXPECT_GT(at, 10'000U);
  EXPECT_EQ(app::cut_off(whole, whole.size()), "");
}

// The header may contain any value.
TEST_F(ModulesTest, AHeaderThatPromisesMoreThanThereIs) {
  const std::string whole =
      bytes_of(fs::path(tests::module_folder()) / "encounter_sample.so").substr(0, 4096);
  for (std::size_t at = 4; at < 1024; ++at)
    for (const char byte : {'\xff', '\x7f', '\0'}) {
      std::string spoiled = whole;
      spoiled[at] = byte;
      EXPECT_THAT(app::cut_off(spoiled, spoiled.size()), Not(HasSubstr("\n")));
      (void)app::cut_off(spoiled.substr(0, at), spoiled.size());
    }
  EXPECT_THAT(app::cut_off(whole, whole.size()), HasSubstr("is cut off: it has 4096 bytes"));
}

TEST_F(ModulesTest, ALibraryWithoutTheSymbol) {
  std::ofstream((folder_ / "none.c").string()) << "int nothing;\n";
  ASSERT_EQ(tests::run({"cc", "-shared", "-fPIC", "-o", file("none"), (folder_ / "none.c").string()}).code,
            0);
  EXPECT_THAT(refusal("none"), AllOf(HasSubstr("no Encounter module"), HasSubstr("encounter_module()")));
}

TEST_F(ModulesTest, AnotherInterfaceVersionOrName) {
  const std::string kNumber = std::to_string(kModuleInterface);
  const std::string kBorder = std::to_string(ENCOUNTER_BORDER) + "u";
  compile("old", "9999, " + kBorder + ", \"" ENCOUNTER_VERSION "\", \"old\", 0, 0");
  EXPECT_THAT(refusal("old"), AllOf(HasSubstr("interface 9999"), HasSubstr("expects " + kNumber),
                                    HasSubstr("build program and modules together")));
  compile("other", kNumber + ", " + kBorder + ", \"77.1\", \"other\", 0, 0");
  EXPECT_THAT(refusal("other"), AllOf(HasSubstr("version 77.1"), HasSubstr(ENCOUNTER_VERSION)));
  compile("renamed", kNumber + ", " + kBorder + ", \"" ENCOUNTER_VERSION "\", \"first\", 0, 0");
  EXPECT_THAT(refusal("renamed"), HasSubstr("calls itself 'first'"));
}

// A struct that crosses the border has changed, but its version number was not raised.
TEST_F(ModulesTest, OtherDeclarationsAreAnotherBorder) {
  const std::string text = fmt::format("{}u, {}u, \"{}\", \"stale\", 0, 0", kModuleInterface,
                                       ENCOUNTER_BORDER ^ 1U, ENCOUNTER_VERSION);
  compile("stale", text);
  EXPECT_THAT(refusal("stale"),
              AllOf(HasSubstr("other declarations"), HasSubstr("build program and modules together")));
}

// The number depends on the declarations alone and not on their comments.
TEST_F(ModulesTest, TheBorderIsAHashOfTheDeclarationsThatCross) {
  const fs::path root = folder_ / "tree";
  const auto hash = [&] {
    const std::string out = (folder_ / "border.h").string();
    EXPECT_EQ(tests::run({"cmake", "-DROOT=" + root.string(), "-DOUT=" + out, "-DCOMPILER=x", "-P",
                          tests::source_dir() + "/cmake/border.cmake"})
                  .code,
              0);
    std::ifstream file(out);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const auto edit = [&](const std::string& header, const std::string& from, const std::string& to) {
    std::ifstream in(root / header);
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << header;
    std::ofstream(root / header) << text.replace(at, from.size(), to);
  };
  for (const char* folder : {"core", "sim", "trial", "app", "benchmarks", "models"}) {
    fs::create_directories(root / folder);
    fs::copy(fs::path(tests::source_dir()) / folder, root / folder,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  const std::string before = hash();
  EXPECT_THAT(before, HasSubstr("#define ENCOUNTER_BORDER 0x"));
  edit("core/base/sample.h", "// N, N m.", "// newton");
  EXPECT_EQ(hash(), before);
  edit("core/base/sample.h", "Vec<'F'> force;",
       "Vec<'F'> pull;");  // deep inside the file: module.h, rig.h, devices, sample.h
  const std::string other = hash();
  EXPECT_NE(other, before);
  const std::vector<std::array<const char*, 3>> contract{
      {"core/spec/settings.h", "bool needed", "int needed"},
      {"core/devices/driver.h", "Duration period;", "double period;"},
      {"core/devices/fake.h", "std::uint64_t seed", "std::int64_t seed"},
      {"core/devices/device.h", "bool linked()", "int linked()"},
      {"core/devices/device.h", "void stop()", "int stop()"}};
  for (const auto& [header, from, to] : contract) {
    const std::string old = hash();
    edit(header, from, to);
    EXPECT_NE(hash(), old) << header;
  }
  edit("core/machine/hexapod.h", "double speed = kUnset;", "float speed = kUnset;");
  EXPECT_NE(hash(), other);
}

TEST_F(ModulesTest, ANameIsNoPath) { EXPECT_THAT(refusal("../view"), HasSubstr("has no '/'")); }

TEST_F(ModulesTest, TheSampleIsTaken) {
  setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
  const ModuleInfo& info = app::load_module("sample");
  EXPECT_STREQ(info.name, "sample");
  ASSERT_NE(info.driver, nullptr);
  EXPECT_NE(info.driver->settings, nullptr);
  EXPECT_NE(info.driver->manipulator, nullptr);
  EXPECT_NE(info.driver->force, nullptr);
  EXPECT_EQ(info.driver->tracker, nullptr);
  EXPECT_EQ(&app::load_module("sample"), &info);  // loaded once
}

}  // namespace
}  // namespace enc::test
