# shellcheck shell=bash
# Makes a machine ready and builds: Debian packages, MuJoCo, a preset. Sourced by `encounter` and `check`, which set
# $root. Every step looks first and does nothing where nothing is missing, so an interrupted set-up resumes by itself.
# Words for people go to stderr; what the tools say goes to build/setup.log.

: "${root:?is set by the caller}"
mujoco_version=4.0.1
mujoco_sha256=be28c0c7587347ef996b4de0487264e9da296282082b092bae211a9163e9aed6
log=$root/build/setup.log
doing="starting"

say() { echo "encounter: $*" >&2; }
stop() { say "$*"; exit 2; }

# Runs a tool with its words in the log and without our standard input, which belongs to the program.
logged() {
  { echo; echo "== $(date '+%F %T') $*"; } >>"$log"
  "$@" </dev/null >>"$log" 2>&1
}

# One set-up at a time; the kernel lets go of the lock however we end.
setup_begin() {
  { mkdir -p "$root/build" && touch "$log"; } 2>/dev/null || stop "cannot write to $root/build; make the folder yours: sudo chown -R \$USER '$root'"
  exec 9>"$root/build/.lock"
  flock --nonblock 9 || { say "waiting for another set-up in this folder to finish"; flock 9; }
  : >"$log"
  trap '[[ ! -t 2 ]] || echo >&2; stop "interrupted while $doing; give the same command again, it carries on from there"' INT TERM HUP
}

setup_end() { trap - INT TERM HUP; exec 9>&-; }

# Sets `wanted` to the packages of these groups, and `missing` to those that are not installed. False: this is no Debian.
find_packages() {  # GROUP...
  local group words states name
  wanted=() missing=()
  while IFS=: read -r group words; do
    # shellcheck disable=SC2206  # the words of a line are the packages
    [[ " $* " != *" $group "* ]] || wanted+=($words)
  done <"$root/cmake/packages.txt"
  command -v dpkg-query >/dev/null || return 1
  # shellcheck disable=SC2016  # dpkg-query's own ${...}
  states=$'\n'$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)$'\n'
  for name in "${wanted[@]}"; do [[ $states == *$'\n'"$name installed"$'\n'* ]] || missing+=("$name"); done
}

setup_packages() {  # GROUP...
  local wanted missing as_root=()
  if ! find_packages "$@"; then
    say "this is no Debian; going on in the hope that these are installed in some form: ${wanted[*]}"
    return
  fi
  [[ ${#missing[@]} -gt 0 ]] || return 0

  local line="apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
  if [[ $EUID -ne 0 ]]; then
    # Asks for a password only where somebody can type one.
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [[ -t 0 ]] && sudo -v; }; }; then as_root=(sudo); fi
    [[ ${#as_root[@]} -gt 0 ]] || stop "some Debian packages are missing; run this as root, then give the same command again: $line"
  fi
  doing="installing Debian packages"
  say "installing ${#missing[@]} Debian packages and what they need (log: build/setup.log)"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -o Acquire::Retries=2)
  # An earlier installation that was cut off is finished first. Old package lists may still do, so update may fail.
  logged "${as_root[@]}" dpkg --configure -a || true
  logged "${apt[@]}" update || true
  logged "${apt[@]}" install -y --fix-broken --no-install-recommends "${missing[@]}" || {
    tail -n 2 "$log" >&2
    stop "these Debian packages are missing and could not be installed: ${missing[*]}; see that this machine is online, then give the same command again (log: build/setup.log)"
  }
}

# MuJoCo 4.0.0 factors a wrong Hessian where the constraint Jacobian is sparse (its issue 3767, mended in 4.0.1).
bad_mujoco() { grep -qsE 'define mjVERSION_HEADER +4000000\b' "$@"; }

mujoco_4() { grep -qsE 'define mjVERSION_HEADER +4[0-9]{6}' "$@"; }

# The system has a MuJoCo 4 of its own that Encounter can use.
system_mujoco() {
  local headers=(/usr/local/include/mujoco/mujoco.h /usr/include/mujoco/mujoco.h)
  mujoco_4 "${headers[@]}" && ! bad_mujoco "${headers[@]}"
}

# A Python wheel as a file, pinned by version and hash, without installing it.
fetch_wheel() {  # NAME==VERSION SHA256 INTO OPTION...: options of pip
  local wheel=$1 hash=$2 into=$3; shift 3
  rm -rf "$into" && mkdir -p "$into" || return 1
  echo "$wheel --hash=sha256:$hash" >"$into/requirements.txt"
  # Debian's python3 by its path, because it is the one that python3-pip belongs to.
  logged env PIP_REQUIRE_VIRTUALENV=0 PIP_NO_INPUT=1 PIP_DISABLE_PIP_VERSION_CHECK=1 /usr/bin/python3 -m pip download \
    --retries 2 --no-deps --only-binary=:all: "$@" --require-hashes -r "$into/requirements.txt" -d "$into"
}

# Debian's MuJoCo is too old, so we take library and headers out of the Python wheel, pinned by version and hash.
setup_mujoco() {
  local home=$root/.deps/mujoco-$mujoco_version work=$root/.deps/unfinished
  ! bad_mujoco "${ENCOUNTER_MUJOCO:-}"/{include/,}mujoco/mujoco.h ||
    stop "ENCOUNTER_MUJOCO=$ENCOUNTER_MUJOCO is MuJoCo 4.0.0, whose solver factors a wrong Hessian (mended in 4.0.1); set it to the folder of a MuJoCo 4.0.1 or later, or unset it and give the same command again"
  [[ -z ${ENCOUNTER_MUJOCO:-} && ! -d $home ]] && ! system_mujoco || return 0
  [[ $(uname -m) == x86_64 ]] || stop "MuJoCo $mujoco_version is fetched for x86_64 only; install MuJoCo $mujoco_version or later and set ENCOUNTER_MUJOCO to its folder"
  doing="fetching MuJoCo $mujoco_version"
  say "fetching MuJoCo $mujoco_version (10 MB)"
  fetch_wheel "mujoco-core==$mujoco_version" "$mujoco_sha256" "$work" --python-version 3.11 --platform manylinux_2_28_x86_64 || {
    tail -n 3 "$log" >&2
    stop "MuJoCo $mujoco_version is missing and could not be fetched; see that this machine is online (or set ENCOUNTER_MUJOCO to the folder of a MuJoCo 4.0.1 or later), then give the same command again"
  }
  logged /usr/bin/python3 -c '
import pathlib, sys, zipfile
work = pathlib.Path(sys.argv[1])
wheel = zipfile.ZipFile(next(work.glob("*.whl")))
for name in wheel.namelist():
    parts = name.split("/")
    if parts[:2] == ["mujoco", "include"]: to = work / "home" / "/".join(parts[1:])
    elif parts[1].startswith("libmujoco.so."): to = work / "home" / "lib" / parts[1]
    elif "licenses" in parts: to = work / "home" / parts[-1]
    else: continue
    if name.endswith("/"): continue
    to.parent.mkdir(parents=True, exist_ok=True)
    to.write_bytes(wheel.read(name))
' "$work" || stop "MuJoCo $mujoco_version could not be unpacked (is the disk full?); give the same command again (log: build/setup.log)"
  mv "$work/home" "$home"  # only a whole one ever gets this name
  rm -rf "$work"
}

# Files out of a Debian package, without installing it and what it would bring.
unpack() {  # PACKAGE INTO LEVELS PATTERN...: those that fit, without the first levels of their paths
  local package=$1 into=$2 levels=$3 work=$root/.deps/unpacked; shift 3
  rm -rf "$work" && mkdir -p "$work" "$into" || return 1
  (cd "$work" && logged apt-get -o Acquire::Retries=2 download "$package") || return 1
  dpkg-deb --fsys-tarfile "$work"/*.deb | tar -x -C "$into" --strip-components="$levels" --wildcards "$@" 2>>"$log" || return 1
  rm -rf "$work"
}

# Headers of the OpenCV that the group opencv installed (cmake/FindOpenCVParts.cmake).
setup_opencv_headers() {
  local home=$root/.deps/opencv-headers part
  [[ ! -d $home && ! -e /usr/include/opencv4/opencv2/calib3d.hpp ]] && command -v apt-get >/dev/null || return 0
  doing="fetching headers of OpenCV"
  say "fetching headers of OpenCV (2 MB)"
  rm -rf "$home.part"
  for part in calib3d features2d flann; do  # each includes the next
    unpack "libopencv-$part-dev" "$home.part" 4 './usr/include/opencv4/*' || {
      tail -n 2 "$log" >&2
      stop "headers of OpenCV are missing and could not be fetched; see that this machine is online and run apt-get update, then give the same command again (log: build/setup.log)"
    }
  done
  mv "$home.part" "$home"  # only a whole one ever gets this name
}

# Real pairs of chessboards, for tests, which are skipped without them.
setup_chessboards() {
  local home=$root/.deps/chessboards data=./usr/share/doc/opencv-doc/examples/data
  [[ ! -d $home ]] && command -v apt-get >/dev/null || return 0
  doing="fetching pairs of chessboards"
  say "fetching pairs of chessboards (out of 96 MB)"
  rm -rf "$home.part"
  if unpack opencv-doc "$home.part" 7 "$data/left??.jpg" "$data/right??.jpg"; then mv "$home.part" "$home"
  else say "pairs of chessboards could not be fetched; their tests are skipped"; fi
}

# A foreign client or server, for tests, which are skipped without it. Nothing else reads it. It is kept where Python can run
# the code with it.
setup_judge() {  # FOLDER NAME==VERSION SHA256 SIZE CODE OPTION...: options of pip
  local folder=$1 wheel=$2 hash=$3 size=$4 code=$5; shift 5
  local home=$root/.deps/$folder work=$root/.deps/unpacked
  [[ ! -d $home ]] || return 0
  doing="fetching ${wheel%%=*}"
  say "fetching ${wheel/==/ } ($size)"
  rm -rf "$home.part"
  if fetch_wheel "$wheel" "$hash" "$work" "$@" && logged /usr/bin/python3 -m zipfile -e "$work"/*.whl "$home.part" &&
    logged env PYTHONPATH="$home.part" /usr/bin/python3 -B -c "$code"; then mv "$home.part" "$home"
  else say "${wheel%%=*} could not be fetched or does not load here; its tests are skipped"; fi
  rm -rf "$work" "$home.part"
}

# PIPython is PI's own client and server of GCS.
setup_pipython() {
  # Its tests import it without what USB and RS-232 need (tests/conformance/foreign/pipython_parts.py).
  setup_judge pipython PIPython==2.11.0.6 3998a10a6318b7a00e43b37a97cffafef6900cc2a7a80acb531329b43b27c3c2 "0.2 MB" pass
}

# pynetft, a client of the Net F/T, is for one version of Python, Debian's 3.11, and one kind of processor.
setup_pynetft() {
  setup_judge pynetft pynetft==2.1.3 8b38a2e9b0dc7fbbbe63c21b9fb29258d4d62e29997fb5dfcaff9f05e61203a9 "0.5 MB" "import pynetft" \
    --python-version 3.11 --platform manylinux2014_x86_64
}

# pyigtl is a client and a server of OpenIGTLink.
setup_pyigtl() {
  setup_judge pyigtl pyigtl==0.3.4 80cdefca7f98ee93c4c42ff1560a914244963df45495dde1784720ac9f28fe29 "0.1 MB" "import pyigtl"
}

# pyOpenHaptics is a client of OpenHaptics HD. It loads libHD.so with its first import, so only its test can do that.
setup_pyopenhaptics() {
  setup_judge pyopenhaptics pyOpenHaptics==1.0.1 13975e926723dd54b5def5038e29f0b23ca9b4b6d5f7b22962d70c55178c14ef "10 kB" pass
}

# forcedimension-core is a client of Force Dimension's DHD. It loads the library with its first import, so only its test can
# do that.
setup_forcedimension() {
  setup_judge forcedimension_core forcedimension-core==1.0.0 1b6b8e271a24c03a0fbc70164119b1ddd7dd7d70e1870eaf3a77e3d99b2822c5 \
    "0.1 MB" pass
}

# mcap is the reader of MCAP files of those who made the format. It takes Debian's zstandard for chunks that are compressed.
setup_mcap() {
  setup_judge mcap mcap==1.6.0 7cd37fba2cf51d033f2139ca837d2ed3024dcec3cd9f8ecdf3d4d15930df6e17 "20 kB" "import mcap.reader"
}

# mcap-ros2-support reads messages of ROS 2 in these files; it imports mcap.
setup_mcap_ros2() {
  setup_judge mcap_ros2 mcap-ros2-support==0.6.0 0b5f86c88432a1370b6c8f0e8a26d1403dc02495d751052e3dd9f9a0679645ef "20 kB" pass
}

# websockets is a viewer of a run that is served live.
setup_websockets() {
  setup_judge websockets websockets==13.1 a9a396a6ad26130cdae92ae10c36af09d9bfe6cafe69670fd3b6da9b07b4044f "0.2 MB" "import websockets" \
    --python-version 3.11 --platform any
}

# rosbags reads bags of ROS 2 without ROS. Its test imports it without what other bags need.
setup_rosbags() {
  setup_judge rosbags rosbags==0.11.9 010c5a48b326e4dad6a79183db243c7b59188121d37b629d8c166ecaed3fc890 "0.2 MB" pass
}

# pymodbus is a client and a server of Modbus TCP.
setup_pymodbus() {
  setup_judge pymodbus pymodbus==3.16.1 bb433f7417280bdea1190d95495aa6fb8e1fa8e0d720c436922b270bc378024c "0.2 MB" \
    "import pymodbus.client, pymodbus.server, pymodbus.simulator"
}

# hand-tracking-sdk receives and parses hands of a headset.
setup_hand_sdk() {
  setup_judge hand_tracking_sdk hand-tracking-sdk==1.1.0 2f0118023c964b7f2b650956bb1b4881145363bc28e9fc4d48a9bbe63eb3c364 "50 kB" \
    "import hand_tracking_sdk"
}

# CPU seconds that this machine needs for a piece of work that all know: a header of the standard library, compiled.
yardstick() {
  local LC_ALL=C TIMEFORMAT='%U %S' user system
  read -r user system < <({ time g++ -std=c++20 -O2 -fsyntax-only -x c++ -include regex -include functional /dev/null \
    >/dev/null 2>&1; } 2>&1 | tail -n 1)
  awk -v a="$user" -v b="$system" 'BEGIN { print a + b }'
}

# Minutes that a build will take: what each file takes (measured, in yardsticks), by kind, shared by the processors.
estimate() {  # the commands of `ninja -t commands` on standard input
  LC_ALL=C awk -v yard="$(yardstick)" -v cores="$(nproc)" '
    { sanitized = /-fsanitize/ ? 1.4 : 1; n += sanitized * (/unity_(benchmarks|tests)/ ? 12 : /[\/]tests[\/]/ ? 7.4 : 4.5) }
    END { print yard * n / cores / 60 }'
}

minutes() { LC_ALL=C awk -v m="$1" 'BEGIN { if (m < 0.75) print "less than a minute"; else printf "about %d minute%s\n", m + 0.5, m < 1.5 ? "" : "s" }'; }

# Reads what ninja says: all of it goes to the log; people see how far it is, a line that renews itself in a terminal,
# else a line a minute.
show_progress() {
  local line began=$SECONDS told=$SECONDS done_ all left
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$log"
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    done_=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]}
    left=$(((SECONDS - began) * (all - done_) / (done_ > 0 ? done_ : 1)))
    ((SECONDS - began >= 3)) || continue
    if [[ -t 2 ]]; then
      printf '\r  %d of %d steps, %d:%02d left ' "$done_" "$all" $((left / 60)) $((left % 60)) >&2
    elif ((SECONDS - told >= 60)); then
      told=$SECONDS
      say "$done_ of $all steps, about $(((left + 59) / 60)) min left"
    fi
  done
  [[ ! -t 2 ]] || printf '\r%40s\r' "" >&2
}

# A build folder that was moved or copied here points to where it came from.
was_moved() { [[ -e $1/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$1/CMakeCache.txt"; }
drop_moved() { ! was_moved "$1" || rm -rf "$1"; }

# The folder of the compiler cache: CCACHE_DIR where it is set, else one folder for all clones of this user. It is the only
# place outside the project that a build writes to. Its size is ccache's own limit (5 GB), or `ccache -M` of that folder.
compiler_cache() {
  local shared=${XDG_CACHE_HOME:-${HOME:+$HOME/.cache}}
  if [[ -n ${CCACHE_DIR:-} ]]; then echo "$CCACHE_DIR"
  elif [[ $shared == /* ]] && mkdir -p "$shared/encounter/ccache" 2>/dev/null && [[ -w $shared/encounter/ccache ]]; then
    echo "$shared/encounter/ccache"
  else echo "$root/build/ccache"; fi
}

# Configures and builds. Configuring again takes half a second and sees edited presets and newly installed packages.
build_preset() {  # PRESET TARGET...
  local preset=$1 todo
  shift
  drop_moved "$root/build/$preset"
  # Presets, commits and clones differ in few objects: ccache, where it is installed, compiles each once.
  local launcher=""
  if command -v ccache >/dev/null; then
    launcher=ccache
    local cache; cache=$(compiler_cache)
    local -x CCACHE_DIR=$cache CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
    local -x CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
  fi
  cd "$root" || exit 2  # presets are found from here; callers that care use a subshell
  if logged cmake --preset "$preset" -DMUJOCO_ROOT="${ENCOUNTER_MUJOCO:-}" -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"; then
    if [[ -e build/$preset/.ninja_log ]]; then
      say "building what changed ($preset)"
    else
      todo=$(ninja -C "build/$preset" -t commands "$@" | grep -- ' -c ' || true)
      say "building ($preset, $(grep -c . <<<"$todo") files), $(minutes "$(estimate <<<"$todo")")"
    fi
    { echo; echo "== $(date '+%F %T') ninja $preset $*"; } >>"$log"
    if (set -o pipefail; ninja -C "build/$preset" "$@" </dev/null 2>&1 | show_progress); then return 0; fi
  fi
  local errors; errors=$(grep -A 4 -E 'error:|CMake Error|undefined reference' "$log" | head -n 40)
  if [[ -n $errors ]]; then echo "$errors" >&2; else tail -n 15 "$log" >&2; fi
  return 1
}
