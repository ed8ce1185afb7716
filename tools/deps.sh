#!/usr/bin/env bash
# Install what is missing:  tools/deps.sh [build] [draw] [check] [peers] [grade]
# [page]
# Without arguments: build draw check. When all is there it says nothing and
# asks no network. DEPS=skip does nothing: for systems without apt;
# with Homebrew or Fedora it prints the command that installs all.
set -euo pipefail

# Debian and Ubuntu packages of a group. A|B: either will do, A is installed.
packages() {
  case $1 in
    build) echo "g++ make pkgconf|pkg-config git" \
                "libcli11-dev libeigen3-dev libspectra-dev" ;;
    draw)  echo "libsdl2-dev libgl-dev libegl1 libgl1-mesa-dri" \
                "libimgui-dev libpng-dev ffmpeg gnuplot-nox python3 fonts-dejavu-core" ;;
    check) echo "clang clang-format libclang-rt-dev libomp-dev libgtest-dev" \
                "librapidcheck-dev libbenchmark-dev xvfb xauth xdotool valgrind" \
                "shellcheck pyflakes3 mypy" ;;
    peers) echo "libsundials-dev libboost-dev liblemon-dev libgsl-dev" \
                "python3-scipy" ;;
    grade) echo "g++ git make python3 libseccomp-dev" ;;
    page)  echo "clang-19 lld-19 wasi-libc libc++-19-dev-wasm32" \
                "libclang-rt-19-dev-wasm32 libeigen3-dev python3 ffmpeg" \
                "pandoc git chromium python3-websocket" ;;
    *) echo "deps: no group '$1'; there are: build draw check peers grade page" >&2
       exit 2 ;;
  esac
}

# What others call them: Debian's name, Homebrew's, Fedora's. One with - comes
# with macOS or is not there, as one that is not listed, and what needs it is
# skipped or says so.
names="
g++ - gcc-c++                     make make make
pkgconf pkgconf pkgconf-pkg-config          git git git
libcli11-dev cli11 cli11-devel    libeigen3-dev eigen eigen3-devel
libspectra-dev spectra spectra-devel        libsdl2-dev sdl2-compat SDL2-devel
libgl-dev - mesa-libGL-devel      libegl1 - mesa-libEGL
libgl1-mesa-dri - mesa-dri-drivers          libimgui-dev imgui -
libpng-dev libpng libpng-devel    ffmpeg ffmpeg ffmpeg-free
gnuplot-nox gnuplot gnuplot       python3 python python3
fonts-dejavu-core font-dejavu dejavu-sans-fonts
clang llvm clang                  clang-format clang-format clang-tools-extra
libclang-rt-dev - compiler-rt     libomp-dev libomp libomp-devel
libgtest-dev googletest gtest-devel
librapidcheck-dev - rapidcheck-devel
libbenchmark-dev google-benchmark google-benchmark-devel
xvfb - xorg-x11-server-Xvfb       xauth - xorg-x11-xauth
xdotool - xdotool                 libseccomp-dev - libseccomp-devel
valgrind - valgrind               pandoc pandoc pandoc
shellcheck shellcheck ShellCheck  pyflakes3 pyflakes python3-pyflakes
mypy mypy python3-mypy
"
renamed() {  # COLUMN: all that is wanted, in the names of another system
  local group debian found
  for group in $groups; do
    for debian in $(missing "$group"); do
      # shellcheck disable=SC2086  # a list of words
      found=$(printf '%s %s %s\n' $names | sed -n "s/^$debian //p")
      case $1 in brew) found=${found% *} ;; dnf) found=${found#* } ;; esac
      [ "${found:--}" = - ] || printf ' %s' "$found"
    done
  done
}

title() {
  case $1 in
    build) echo "needed to build" ;;
    draw)  echo "to draw, record and chart" ;;
    check) echo "to test and check" ;;
    peers) echo "to compare with other libraries" ;;
    grade) echo "to grade submissions" ;;
    page)  echo "to build the web page and the site, and to test them" ;;
  esac
}

# The packages of a group that are not in $have.
missing() {
  local all entry
  all=$(packages "$1")
  for entry in $all; do
    case $have in
      *" ${entry%%|*} "* | *" ${entry##*|} "*) ;;
      *) echo "${entry%%|*}" ;;
    esac
  done
}

by_hand() {  # say what to install, by group, and fail
  local group list
  echo "deps: $1"
  for group in $groups; do
    list=$(missing "$group")
    [ -z "$list" ] || printf '  %s:\n    %s\n' "$(title "$group")" \
      "$(echo "$list" | tr '\n' ' ')"
  done
  echo "$2"
  exit 1
} >&2

groups=${*:-build draw check}
for group in $groups; do packages "$group" >/dev/null; done
[ "${DEPS:-}" != skip ] || exit 0

have=" "
if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  for other in "brew brew install" "dnf sudo dnf install"; do
    command -v "${other%% *}" >/dev/null || continue
    echo "deps: install, unless it is there:"
    echo "  ${other#* }$(renamed "${other%% *}")"
    echo "What has no package there is left out: without SDL2 and Dear ImGui"
    echo "there is no window, and some checks are skipped."
    echo "Then tell make that all is there: make DEPS=skip ..."
    exit 1
  done >&2
  by_hand "there is no apt-get here. Install by hand (names as in Debian):" \
    "Then tell make that all is there: make DEPS=skip ..."
fi

# All that is installed, and what it provides: " g++ gnuplot-qt gnuplot ... "
# shellcheck disable=SC2016  # for dpkg-query to expand
format='${db:Status-Status} ${Package}, ${Provides}\n'
have=" $(dpkg-query -W -f "$format" |
  sed -n 's/^installed //p' | tr -s ', \n' ' ') "
wanted=$(for group in $groups; do missing "$group"; done | tr '\n' ' ')
[ -n "$wanted" ] || exit 0

as_root="env"
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || by_hand \
    "packages are missing, and to install them you must be root. Missing:" \
    "As root: apt-get install --no-install-recommends $wanted"
  as_root="sudo env"
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  $as_root DEBIAN_FRONTEND=noninteractive apt-get -q -y \
    -o DPkg::Lock::Timeout=120 "$@" >"$log" 2>&1 </dev/null
}
install() {  # an update may fail for a source that is not needed here
  apt update || grep -E '^[EW]:' "$log" >&2 || true
  # shellcheck disable=SC2086  # one word a package
  apt install --no-install-recommends $wanted
}

echo "deps: installing $wanted"
if ! install; then
  if grep -qiE 'failed to fetch|unable to fetch|could not resolve' "$log"; then
    echo "deps: a download failed; trying once more"
    sleep "${DEPS_WAIT:-3}"
    install && exit 0
  fi
  grep -E '^E:' "$log" >&2 || tail -n 20 "$log" >&2
  by_hand "apt-get could not install (its reason is above):" \
    "As root: apt-get install --no-install-recommends $wanted"
fi
