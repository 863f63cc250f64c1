# shellcheck shell=bash
# Answers `encounter doctor` before anything is built: what the first build needs, and for each part that is missing or wrong
# the command that helps. It changes nothing. Sourced by `encounter`, which sets $root and $build. The program's own
# doctor (app/doctor.cpp) adds what only a program can try: modules, renderers, drivers.

: "${root:?is set by the caller}" "${build:?is set by the caller}"
# shellcheck disable=SC2154  # mujoco_version: of setup.sh
fit=true  # false: the first build would fail
line() { printf '%-8s%s\n' "$1" "$2"; }
missing() { line MISSING "$1"; fit=false; }

cpu() {
  local kind; kind=$(uname -m)
  if [[ $kind != x86_64 ]]; then
    [[ -n ${ENCOUNTER_MUJOCO:-} ]] || missing "MuJoCo for $kind: it is fetched for x86_64 only; install MuJoCo $mujoco_version and set ENCOUNTER_MUJOCO to its folder"
  elif ! lscpu | grep -wi avx >/dev/null; then  # -q would end the pipe early
    missing "AVX: this processor has none, and MuJoCo's library needs it; use a processor of 2011 or later (in a virtual machine: pass the host's CPU through)"
  fi
  (($(nproc) >= 2)) || line note "1 core: builds take twice as long; hardware wants two cores"
  local pages; pages=$(getconf _PHYS_PAGES)
  ((pages == 0 || pages * $(getconf PAGE_SIZE) >= 2000000000)) || line note "less than 2 GB of memory: a build may be killed; add swap, or build with CMAKE_BUILD_PARALLEL_LEVEL=1"
}

folder() {
  if [[ -e $root/build && ! -d $root/build ]]; then missing "$root/build is a file: move it away; the build needs a folder of that name"
  elif [[ ! -w $root || (-e $root/build && ! -w $root/build) ]]; then missing "$root cannot be written to: sudo chown -R \$USER '$root'"; fi
  [[ ",$(findmnt -no OPTIONS -T "$root" 2>/dev/null || true)," != *,noexec,* ]] || missing "$root is on a file system that runs no programs (noexec): clone to another one, or mount -o remount,exec"
  local free; free=$(df -Pk "$root" | awk 'NR == 2 { print int($4 / 1e6) }')
  if ((free < 1)); then missing "disk space at $root: less than 1 GB is free; the program needs 1 GB, ./check 6 GB"
  elif ((free < 6)); then line note "disk space at $root: $free GB; enough for the program, ./check needs 6 GB"; fi
  [[ -d ${TMPDIR:-/tmp} && -w ${TMPDIR:-/tmp} ]] || missing "TMPDIR=${TMPDIR:-/tmp} cannot be written to, and the compiler needs it: unset TMPDIR, or make the folder"
  if [[ -e $root/build/.lock ]] && ! flock --nonblock "$root/build/.lock" true; then line note "another set-up is at work in this folder; the next call waits for it"; fi
}

# Nobody could fetch a wheel or a package with a clock that is behind the project: certificates would not be valid yet.
clock() {
  local newest; newest=$(stat -c %Y "$root/CMakeLists.txt")
  (($(date +%s) + 86400 >= newest)) || missing "this machine's clock ($(date +%F)) is older than the project's files: set it (timedatectl set-ntp true)"
}

packages() {
  local wanted missing
  if ! find_packages build; then line note "this is no Debian: the names in cmake/packages.txt have to be installed in some form"; return; fi
  [[ -z $(dpkg --audit 2>/dev/null) ]] || missing "an installation was cut off: dpkg --configure -a (as root)"
  if [[ ${#missing[@]} == 0 ]]; then line ok "Debian packages of a build"; return; fi
  fetches=true
  if [[ $(id -u) == 0 ]]; then line note "Debian packages: ${missing[*]}; the first call installs them"
  elif command -v sudo >/dev/null; then line note "Debian packages: ${missing[*]}; the first call installs them, and asks for sudo's password"
  else missing "Debian packages: as root, apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"; fi
}

# A tool that is installed, but is another one than Debian's.
tools() {
  local version compiler; read -ra compiler <<<"${CXX:-g++}"
  if [[ -n ${CXX:-} ]] && ! command -v "${CXX%% *}" >/dev/null; then missing "CXX=$CXX does not exist: unset CXX"; fi
  version=$("${compiler[@]}" -dumpversion 2>/dev/null || true)
  [[ -z $version ]] || ((${version%%.*} >= 12)) || missing "${CXX:-g++} $version is too old: C++20 needs 12; apt-get install g++-12, then CXX=g++-12"
  version=$(cmake --version 2>/dev/null | awk 'NR == 1 { print $3 }' || true)
  if [[ -n $version ]] && ! printf '3.25\n%s\n' "$version" | sort -VC; then
    missing "cmake $version at $(command -v cmake) is too old: 3.25 is needed; Debian 12 has it, so take the other one out of PATH"
  fi
  [[ " ${CXXFLAGS:-} " != *-ffast-math* && " ${CXXFLAGS:-} " != *-march=* ]] || missing "CXXFLAGS=$CXXFLAGS changes the bits of a run: unset CXXFLAGS"
  command -v git >/dev/null || line note "git: results will not have a commit; apt-get install git"
}

mujoco() {
  local own=${ENCOUNTER_MUJOCO:-} header=() part
  if [[ -n $own ]]; then
    for part in "$own"/{include/,}mujoco/mujoco.h; do [[ ! -e $part ]] || header=("$part"); done
    if [[ ${#header[@]} == 0 ]]; then missing "ENCOUNTER_MUJOCO=$own has no mujoco/mujoco.h: set it to the folder of MuJoCo $mujoco_version, or unset it"
    elif bad_mujoco "${header[@]}"; then missing "ENCOUNTER_MUJOCO=$own is MuJoCo 4.0.0, whose solver factors a wrong Hessian: take 4.0.1, or unset it"
    elif ! mujoco_4 "${header[@]}"; then missing "ENCOUNTER_MUJOCO=$own is not MuJoCo 4: set it to the folder of MuJoCo $mujoco_version, or unset it"
    else line ok "MuJoCo in $own"; fi
  elif [[ -d $root/.deps/mujoco-$mujoco_version ]] || system_mujoco; then line ok "MuJoCo for a build"
  else fetches=true; line note "MuJoCo $mujoco_version: the first call fetches it (10 MB)"; fi
  local IFS=:
  for part in ${LD_LIBRARY_PATH:-}; do
    [[ -z $part || $part -ef $own/lib ]] || ! compgen -G "$part/libmujoco.so*" >/dev/null ||
      missing "LD_LIBRARY_PATH has another MuJoCo, in $part, which would be loaded in place of ours: take that folder out of it"
  done
}

# Asked only where something has to be fetched.
network() {
  $fetches || return 0
  [[ -z ${http_proxy:-}${https_proxy:-}${HTTP_PROXY:-}${HTTPS_PROXY:-}${PIP_INDEX_URL:-} &&
    -z $(apt-config dump Acquire::http::Proxy 2>/dev/null || true) ]] || return 0  # not ours to judge
  local host
  # shellcheck disable=SC2016  # apt-get's own $(...)
  host=$(apt-get indextargets --format '$(URI)' 2>/dev/null | sed -nE '1s#^[a-z]+://([^/:]+).*#\1#p' || true)
  [[ -z $host ]] || getent hosts "$host" >/dev/null || missing "$host, from which packages come, has no address: this machine is offline, or its DNS is; connect it"
}

earlier_build() {
  if was_moved "$build"; then
    line note "$build was made in another folder: the next call deletes it and builds anew"
  elif [[ -e $build/.ninja_log && ! -x $build/encounter ]]; then line note "a build was cut off; the next call carries on from there"
  elif [[ -x $build/encounter ]] && ldd "$build/encounter" 2>/dev/null | grep 'not found' >/dev/null; then
    missing "$(ldd "$build/encounter" | awk '/not found/ { print $1; exit }'), which the program needs, is gone: rm $build/.ready-*, then give your command again; it installs what is missing"
  fi
}

# What a person may want and a build does not need.
extras() {
  PATH=$PATH:/usr/sbin:/sbin ldconfig -p 2>/dev/null | grep 'libEGL\.so\.1' >/dev/null || line note "EGL for pictures: ./encounter view installs it"
  command -v gnuplot >/dev/null || line note "gnuplot for the plots of a report: ./encounter bench installs it"
  [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]] || line note "no screen here: view opens no window; --shot and --video draw without one"
  chrt -f 40 true 2>/dev/null || line note "real-time priority: not allowed here, and only real devices need it; 'rtprio 40' in /etc/security/limits.conf (in a container: --cap-add SYS_NICE --ulimit rtprio=40)"
}

examine() {
  # shellcheck source=cmake/setup.sh
  source "$root/cmake/setup.sh"
  local fetches=false code=0
  cpu; folder; clock; packages; tools; mujoco; network; earlier_build
  if [[ -x $build/encounter ]] && $fit; then
    "$build/encounter" doctor || code=$?
    exit "$code"
  fi
  extras
  $fit || { echo "not ready"; exit 1; }
  line note "not built yet: ./encounter run models/scenes/plane.toml builds it, once, in about five minutes"
  echo "ready to build"
  exit 0
}
