#!/usr/bin/env bash
# Install what is missing:  tools/deps.sh [GROUP...]
# Without arguments: build window film lab draw test check. When all is there it
# says nothing and asks no network. By apt-get, dnf or Homebrew; DEPS=skip does
# nothing: for systems without these.
set -euo pipefail
groups=${*:-build window film lab draw test check}

# Debian and Ubuntu packages of a group. A|B: either will do, A is installed.
# N is the newest version of clang that has a C++ library for WebAssembly.
packages() {
  case $1 in
    build)  echo "g++ make pkgconf|pkg-config git" ;;
    window) echo "libsdl2-dev libpng-dev libgl-dev libegl1 libgl1-mesa-dri" ;;
    film)   echo "ffmpeg" ;;
    lab)    echo "libcli11-dev libeigen3-dev libtomlplusplus-dev" ;;
    draw)   echo "python3-matplotlib python3 fonts-dejavu-core" ;;
    test)   echo "libgtest-dev gdb" ;;
    check)  echo "clang clang-format libclang-rt-dev libomp-dev libspectra-dev" \
                 "librapidcheck-dev libbenchmark-dev xvfb xauth xdotool" \
                 "shellcheck pyflakes3 mypy" ;;
    python) echo "python3-numpy python3-dev python3-pybind11 python3-pytest" \
                 "python3-scipy python3-setuptools python3-matplotlib mypy" \
                 "python3-build python3-pip python3-venv python3-wheel" ;;
    peers)  echo "libsundials-dev libboost-dev libgsl-dev" ;;
    grade)  echo "g++ git make python3 libseccomp-dev"
            python3 -c 'import tomllib' 2>/dev/null || echo "python3-tomli" ;;
    web)    [ ! -d course/kit ] || packages grade   # it compiles in the jail
            echo "clang-N lld-N wasi-libc libc++-N-dev-wasm32" \
                 "libclang-rt-N-dev-wasm32 python3" ;;
    page)   packages web
            echo "libeigen3-dev libtomlplusplus-dev ffmpeg pandoc git" ;;
    reference) echo "doxygen" ;;
    browser) echo "chromium-driver python3-selenium firefox-esr webkit2gtk-driver xvfb" ;;
    *) echo "deps: no group '$1'; there are: build window film lab draw test" \
            "check python peers grade web page browser reference" >&2
       exit 2 ;;
  esac
}

# What others call them: Debian's name, Homebrew's, Fedora's. One with -, or one
# that is not listed, comes with the system or is not there; what needs it is
# skipped or says so.
names="
g++ - gcc-c++                     make make make
pkgconf pkgconf pkgconf-pkg-config          git git git
libcli11-dev cli11 cli11-devel    libeigen3-dev eigen eigen3-devel
libspectra-dev spectra spectra-devel
libtomlplusplus-dev tomlplusplus tomlplusplus-devel
libsdl2-dev sdl2-compat SDL2-devel
libgl-dev - mesa-libGL-devel      libegl1 - mesa-libEGL
libgl1-mesa-dri - mesa-dri-drivers          libpng-dev libpng libpng-devel
ffmpeg ffmpeg ffmpeg-free         python3-matplotlib python-matplotlib python3-matplotlib
python3 python python3            gdb - gdb
fonts-dejavu-core - dejavu-sans-fonts
clang - clang                     clang-format clang-format clang-tools-extra
libclang-rt-dev - compiler-rt     libomp-dev libomp libomp-devel
libgtest-dev googletest gtest-devel
librapidcheck-dev - rapidcheck-devel
libbenchmark-dev google-benchmark google-benchmark-devel
xvfb - xorg-x11-server-Xvfb       xauth - xorg-x11-xauth
xdotool - xdotool                 libseccomp-dev - libseccomp-devel
pandoc pandoc pandoc              doxygen doxygen doxygen
shellcheck shellcheck ShellCheck  pyflakes3 pyflakes python3-pyflakes
mypy mypy python3-mypy
"
there() { command -v "$1" >/dev/null; }
if there apt-get && there dpkg-query; then
  system=apt
elif there brew; then
  system=brew
elif there dnf; then
  system=dnf
else
  system=none
fi

# All that is installed, and what it provides: " g++ libgl-dev libgl1-mesa-dev ... "
installed() {
  local format
  # shellcheck disable=SC2016  # for dpkg-query to expand
  format='${db:Status-Status} ${Package}, ${Provides}\n'
  case $system in
    apt) dpkg-query -W -f "$format" | sed -n 's/^installed //p' ;;
    brew) brew list --formula -1 ;;
    dnf) rpm -qa --qf '[%{PROVIDENAME} ]\n' ;;
  esac | tr -s ', \n' ' '
}

# The packages of a group that are not in $have, by their names here.
missing() {
  local entry name all
  all=$(packages "$1")
  for entry in $all; do
    if [ $system = brew ] || [ $system = dnf ]; then
      # shellcheck disable=SC2086  # a list of words
      name=$(printf '%s %s %s\n' $names | sed -n "s/^${entry%%|*} //p")
      case $system in
        brew) entry=${name% *} ;;
        dnf) entry=${name#* } ;;
      esac
      [ "${entry:--}" != - ] || continue
    fi
    case $entry in *-N*) entry=${entry/-N/-$newest} ;; esac
    case $have in
      *" ${entry%%|*} "* | *" ${entry##*|} "*) ;;
      *) echo "${entry%%|*}" ;;
    esac
  done
}
all_missing() { for group in $groups; do missing "$group"; done | sort -u | tr '\n' ' '; }
version() { sed -n 's/^libclang-rt-\([0-9]*\)-dev-wasm32$/\1/p' | sort -n | tail -n 1; }

by_hand() {  # say what to install, by group, and fail
  local group list
  echo "deps: $1"
  for group in $groups; do
    list=$(missing "$group" | tr '\n' ' ')
    [ -z "$list" ] || printf '  %-7s %s\n' "$group" "$list"
  done
  echo "$2"
  exit 1
} >&2

for group in $groups; do packages "$group" >/dev/null; done
[ "${DEPS:-}" != skip ] || exit 0
have=" " newest=N
[ $system != none ] || by_hand \
  "there is no apt-get here. Install by hand (names as in Debian):" \
  "Then tell make that all is there: make DEPS=skip ..."
have=" $(installed) "
newest=$(echo "$have" | tr ' ' '\n' | version)
newest=${newest:-N}
wanted=$(all_missing)
[ -n "$wanted" ] || exit 0

as_root="env"
if [ $system != brew ] && [ "$(id -u)" != 0 ]; then
  there sudo || by_hand \
    "packages are missing, and to install them you must be root. Missing:" \
    "As root: tools/deps.sh $groups"
  as_root="sudo env"
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  $as_root DEBIAN_FRONTEND=noninteractive apt-get -q -y \
    -o DPkg::Lock::Timeout=120 -o Acquire::Retries=3 "$@" >"$log" 2>&1 </dev/null
}
install() {
  if [ $system = apt ]; then  # it may fail for a source that is not needed
    apt update || grep -E '^[EW]:' "$log" >&2 || true
    if [[ $wanted == *-N* ]]; then
      newest=$(apt-cache pkgnames libclang-rt- | version)
      wanted=$(all_missing)
    fi
  fi
  echo "deps: installing $wanted"
  # shellcheck disable=SC2086  # one word a package
  case $system in
    apt) apt install --no-install-recommends $wanted ;;
    brew) brew install $wanted ;;
    dnf) $as_root dnf install -y $wanted ;;
  esac
}

install || {
  grep -E '^E:' "$log" >&2 || tail -n 20 "$log" >&2
  by_hand "could not install (the reason is above):" \
    "As root: tools/deps.sh $groups"
}
