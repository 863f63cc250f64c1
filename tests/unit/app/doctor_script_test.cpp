// `encounter doctor` before anything is built: on a sound bare system, and on that system with one defect at
// a time. Each defect must produce its own remedy.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// A clone that was never built, with its own PATH: tools that do not depend on the machine, and stubs for the
// tools that describe the machine.
class BareSystem {
 public:
  BareSystem() {
    for (const char* name : {"encounter", "CMakeLists.txt", "cmake/commit.sh", "cmake/setup.sh",
                             "cmake/doctor.sh", "cmake/packages.txt"}) {
      fs::create_directories((clone() / name).parent_path());
      fs::copy_file(fs::path(source_dir()) / name, clone() / name);
    }
    const std::string link = "mkdir -p '" + bin() +
                             "'; for t in bash env awk sed grep sort stat date df tr head cat dirname "
                             "readlink id mkdir rm chmod touch printf; do ln -s \"$(command -v $t)\" '" +
                             bin() + "'; done";
    EXPECT_EQ(run({"bash", "-c", link}).code, 0);
    stand_in("dpkg-query", "shift 3; for p in \"$@\"; do echo \"$p installed\"; done");
    for (const char* quiet : {"dpkg", "git", "gnuplot", "chrt", "flock", "getent", "sudo"})
      stand_in(quiet, "");
    stand_in("uname", "echo x86_64");
    stand_in("lscpu", "echo Flags: fpu avx");
    stand_in("nproc", "echo 2");
    stand_in("getconf", "echo 1048576");
    stand_in("findmnt", "echo rw,relatime");
    stand_in("df", "echo head; echo x 9 9 20000000 9 /");
    stand_in("g++", "echo 12");
    stand_in("cmake", "echo cmake version 3.25.1");
    stand_in("ldconfig", "echo libEGL.so.1");
    stand_in("ldd", "");
    stand_in("apt-get", "echo http://packages.test/debian/x");
  }
  [[nodiscard]] fs::path clone() const { return folder_.path() / "clone"; }
  [[nodiscard]] std::string bin() const { return folder_.file("bin"); }
  void stand_in(const std::string& tool, const std::string& script) const {
    fs::remove(bin() + "/" + tool);
    std::ofstream(bin() + "/" + tool) << "#!/bin/bash\n" << script << "\n";
    fs::permissions(bin() + "/" + tool, fs::perms::all);
  }
  // Run the shell lines `broken` in the clone, with PATH as it is here, and then run the doctor.
  [[nodiscard]] Result doctor(const std::string& broken = "") const {
    return run({"/usr/bin/env", "-i", "DISPLAY=:0", "PATH=" + bin(), bin() + "/bash", "-c",
                "cd '" + clone().string() + "'\n" + broken + "\n./encounter doctor"});
  }

 private:
  test::TemporaryFolder folder_;
};

TEST(DoctorScript, ASoundSystemIsReadyAndNothingIsChanged) {
  const BareSystem system;
  const Result r = system.doctor();
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_THAT(r.out, HasSubstr("ready to build"));
  EXPECT_THAT(r.out, Not(HasSubstr("MISSING")));
  EXPECT_FALSE(fs::exists(system.clone() / "build"));
}

struct Break {
  std::string what, tool, script, shell, remedy;
  int code = 1;
};
std::vector<Break> breaks() {
  const std::string mujoco =
      "mkdir -p m/include/mujoco; export ENCOUNTER_MUJOCO=$PWD/m; echo '#define mjVERSION_HEADER ";
  const std::string no_packages = "shift 3; echo \"$1 half-installed\"";
  return {
      {"no compiler, root", "dpkg-query", no_packages, "", "the first call installs them", 0},
      {"no compiler, no right", "dpkg-query", no_packages,
       "rm $PATH/sudo $PATH/id; echo 'echo 7' >$PATH/id; chmod +x $PATH/id",
       "as root, apt-get update && apt-get install -y --no-install-recommends cmake ninja-build g++"},
      {"half-installed package", "dpkg", "echo g++ is half configured", "", "dpkg --configure -a"},
      {"no network", "getent", "exit 2", "", "packages.test, from which packages come, has no address"},
      {"no Debian", "", "", "rm $PATH/dpkg-query", "this is no Debian", 0},
      {"old compiler", "g++", "echo 9", "", "g++ 9 is too old: C++20 needs 12"},
      {"old compiler, newer one beside it", "g++", "echo 11",
       "printf '#!/bin/bash\necho 12' >$PATH/g++-12; chmod +x $PATH/g++-12; export CXX=g++-12",
       "ready to build", 0},
      {"old CMake", "cmake", "echo cmake version 3.18.4", "", "cmake 3.18.4 at"},
      {"no such compiler", "", "", "export CXX=g++-99", "CXX=g++-99 does not exist: unset CXX"},
      {"flags that change bits", "", "", "export CXXFLAGS='-O2 -ffast-math'", "unset CXXFLAGS"},
      {"folder is a file", "", "", "touch build", "build is a file: move it away"},
      {"no programs may run", "findmnt", "echo rw,noexec,relatime", "", "runs no programs (noexec)"},
      {"full disk", "df", "echo head; echo x 9 9 500000 9 /", "", "less than 1 GB is free"},
      {"small disk", "df", "echo head; echo x 9 9 3000000 9 /", "", "3 GB; enough for the program", 0},
      {"no temporary folder", "", "", "export TMPDIR=/nowhere", "TMPDIR=/nowhere cannot be written to"},
      {"old clock", "", "", "touch -d 2099-01-01 CMakeLists.txt", "set it (timedatectl set-ntp true)"},
      {"MuJoCo folder without MuJoCo", "", "", "export ENCOUNTER_MUJOCO=/nowhere", "has no mujoco/mujoco.h"},
      {"MuJoCo 4.0.0", "", "", mujoco + "4000000' >m/include/mujoco/mujoco.h", "is MuJoCo 4.0.0"},
      {"MuJoCo 3", "", "", mujoco + "3003000' >m/include/mujoco/mujoco.h", "is not MuJoCo 4"},
      {"foreign libmujoco", "", "", "mkdir l; touch l/libmujoco.so.4.0.1; export LD_LIBRARY_PATH=$PWD/l",
       "LD_LIBRARY_PATH has another MuJoCo"},
      {"another processor", "uname", "echo aarch64", "", "it is fetched for x86_64 only"},
      {"no AVX", "lscpu", "echo Flags: fpu sse2", "", "AVX: this processor has none"},
      {"moved build", "", "",
       "mkdir -p build/release; echo CMAKE_HOME_DIRECTORY:INTERNAL=/a >build/release/CMakeCache.txt",
       "was made in another folder", 0},
      {"build cut off", "", "", "mkdir -p build/release; touch build/release/.ninja_log",
       "carries on from there", 0},
      {"another set-up", "flock", "exit 1", "mkdir build; touch build/.lock", "another set-up is at work", 0},
      {"no EGL", "ldconfig", "", "", "./encounter view installs it", 0},
      {"no gnuplot", "", "", "rm $PATH/gnuplot", "./encounter bench installs it", 0},
      {"no screen", "", "", "unset DISPLAY", "--shot and --video draw without one", 0},
      {"no real-time right", "chrt", "exit 1", "", "--cap-add SYS_NICE --ulimit rtprio=40", 0},
      {"one core", "nproc", "echo 1", "", "builds take twice as long", 0},
      {"little memory", "getconf", "[[ $1 == PAGE_SIZE ]] && echo 4096 || echo 250000", "",
       "less than 2 GB of memory", 0},
  };
}

TEST(DoctorScript, EachBrokenSystemGetsItsRemedy) {
  const std::string sound = BareSystem().doctor().out;
  for (const Break& one : breaks()) {
    SCOPED_TRACE(one.what);
    if (one.remedy != "ready to build") {
      EXPECT_THAT(sound, Not(HasSubstr(one.remedy)));
    }
    const BareSystem system;
    if (!one.tool.empty()) system.stand_in(one.tool, one.script);
    const Result r = system.doctor(one.shell);
    EXPECT_THAT(r.out, HasSubstr(one.remedy)) << r.err;
    EXPECT_EQ(r.code, one.code) << r.out;
    EXPECT_EQ(r.err, "");
  }
}

}  // namespace
}  // namespace enc::tests
