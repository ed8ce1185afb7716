#!/usr/bin/env bash
# Test tools/deps.sh on make-believe systems: a PATH of stubs, no network.
set -euo pipefail

script=${DEPS_SCRIPT:-$(cd "$(dirname "$0")" && pwd)/deps.sh}
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0
everything="g++ make pkgconf git libsdl2-dev libgl-dev libegl1 libgl1-mesa-dri
  libpng-dev ffmpeg libcli11-dev libeigen3-dev libtomlplusplus-dev
  python3-matplotlib python3
  fonts-dejavu-core libgtest-dev gdb clang clang-format libclang-rt-dev
  libomp-dev libspectra-dev librapidcheck-dev libbenchmark-dev xvfb xauth
  xdotool valgrind shellcheck pyflakes3 mypy"

stub() { cat >"$tmp/bin/$1"; chmod +x "$tmp/bin/$1"; }

# A system: who one is, and the packages that are installed. Stubs write
# every call to $tmp/calls; apt-get does what the files in $tmp say.
system() {
  rm -rf "${tmp:?}"/*
  mkdir "$tmp/bin"
  local tool
  for tool in bash cat env grep mktemp rm sed sleep sort tail tr; do
    ln -s "$(command -v "$tool")" "$tmp/bin/$tool"
  done
  : >"$tmp/calls"
  # shellcheck disable=SC2086  # one word a package
  printf 'installed %s, \n' $2 >"$tmp/dpkg"
  stub id <<<"#!/bin/sh
echo $1"
  stub dpkg-query <<<"#!/bin/sh
echo dpkg-query >>'$tmp/calls'
case \"\$*\" in *Provides*) cat '$tmp/dpkg';; *) sed 's/,.*//' '$tmp/dpkg';; esac"
  stub apt-get <<<"#!/bin/sh
echo \"apt-get \$DEBIAN_FRONTEND \$*\" >>'$tmp/calls'
case \"\$*\" in *update*) test ! -e '$tmp/no_update' ||
  { echo 'E: a source is gone'; exit 100; }; exit 0;; esac
test ! -e '$tmp/broken' || { echo 'E: Unable to locate package x'; exit 100; }
test ! -e '$tmp/offline' || { cat '$tmp/offline'; exit 100; }
test ! -e '$tmp/flaky' ||
  { rm '$tmp/flaky'; echo 'E: Failed to fetch http://x'; exit 100; }"
}
# Packages that apt-get could install: one a line in $tmp/names.
apt_cache() { stub apt-cache <<<"#!/bin/sh
cat '$tmp/names'"; }
no_apt() { rm "$tmp/bin/apt-get" "$tmp/bin/dpkg-query"; }
# Homebrew or Fedora, with these packages.
other() {  # brew|dnf PACKAGES
  no_apt
  printf '%s\n' $2 >"$tmp/there"
  stub "$1" <<<"#!/bin/sh
case \$1 in list) cat '$tmp/there';; *) echo \"$1 \$*\" >>'$tmp/calls';; esac"
  [ "$1" = brew ] || stub rpm <<<"#!/bin/sh
cat '$tmp/there'"
}
with_sudo() { stub sudo <<<"#!/bin/sh
echo sudo >>'$tmp/calls'; exec \"\$@\""; }

run() {  # run the script there; sets out, status
  status=0
  out=$(unset DEBIAN_FRONTEND
        PATH=$tmp/bin DEPS_WAIT=0 bash "$script" "$@" 2>&1) || status=$?
}

# Checks of one case; `ok NAME` ends it.
why=""
expect_status() { [ "$status" = "$1" ] || why+=" status is $status, not $1;"; }
says()    { grep -qE -- "$1" <<<"$out" || why+=" does not say '$1';"; }
silent()  { [ -z "$out" ] || why+=" says something;"; }
not_say() { ! grep -qE -- "$1" <<<"$out" || why+=" says '$1';"; }
calls()   { [ "$(grep -c -- "$1" "$tmp/calls")" = "$2" ] ||
              why+=" calls of '$1' are not $2;"; }
ok() {
  if [ -z "$why" ]; then
    echo "ok    $1"; passed=$((passed + 1))
  else
    printf 'FAIL  %s:%s\n%s\n' "$1" "$why" "$out"
    failed=$((failed + 1))
  fi
  why=""
}

system 0 "$everything"; run
expect_status 0; silent; calls dpkg-query 1; calls apt-get 0
ok "all there: silent, one query, no apt"

system 0 "${everything/pkgconf/pkg-config}"; run
expect_status 0; silent; calls apt-get 0
ok "an alternative is there"

system 0 "${everything/python3-matplotlib/}"
echo 'installed other, matplotlib (= 5), python3-matplotlib (= 5)' >>"$tmp/dpkg"; run
expect_status 0; silent; calls apt-get 0
ok "a package is provided by another one"

system 0 "${everything/ffmpeg/}"
echo 'config-files ffmpeg, ' >>"$tmp/dpkg"; run
expect_status 0; says 'installing ffmpeg'; calls 'install .*ffmpeg' 1
ok "a removed package is missing, though dpkg remembers it"

system 0 "${everything/git/} libgit"; run
expect_status 0; says 'installing git'
ok "a name inside another one is not it"

system 0 "${everything/libsdl2-dev/}"; run
expect_status 0; says 'installing libsdl2-dev *$'
calls 'apt-get noninteractive .* update' 1; calls sudo 0
calls 'apt-get noninteractive .* install --no-install-recommends libsdl2-dev$' 1
ok "one missing, root"

system 0 "${everything/libsdl2-dev/}"; run build
expect_status 0; silent; calls apt-get 0
ok "only the groups that are asked for"

system 0 "$everything"; run peers
expect_status 0; says 'installing libboost-dev .*libsundials-dev'
ok "group peers"

system 0 "$everything"; run grade
expect_status 0; says 'installing libseccomp-dev python3-tomli'
ok "group grade, with a Python that has no tomllib"

system 0 "$everything"; stub python3 <<<"#!/bin/sh"; run grade
expect_status 0; says 'installing libseccomp-dev *$'
ok "group grade, with a Python that has it"

for group in web page; do
  system 0 "$everything"; apt_cache
  printf 'libclang-rt-%s-dev-wasm32\n' 9 19 21 14 >"$tmp/names"; run $group
  expect_status 0; calls 'install .*clang-21 .*libclang-rt-21-dev-wasm32' 1
  not_say 'clang-N|clang-19|chromium'
  ok "group $group: the newest clang for WebAssembly"
done

system 0 "$everything clang-19 lld-19 wasi-libc libc++-19-dev-wasm32
  libclang-rt-19-dev-wasm32"; run web
expect_status 0; silent; calls apt-get 0
ok "group web: the clang that is there"

system 0 "$everything"; run browser
expect_status 0; says 'installing chromium python3-websocket'
ok "group browser"

system 0 "$everything"; run build toys
expect_status 2; says "no group 'toys'.*build window film lab draw test check peers grade web"; calls apt 0
ok "a group that there is not"

system 1000 "${everything/xvfb/}"; with_sudo; run
expect_status 0; says 'installing xvfb'; calls sudo 2
calls 'apt-get noninteractive .* install .*xvfb' 1
ok "not root, with sudo"

system 1000 "$(echo "$everything" | sed 's/xvfb//; s/make//')"; run
expect_status 1; says 'you must be root'
says '^  build +make *$'; says '^  check +xvfb *$'
not_say '  draw'; not_say ffmpeg; calls apt-get 0
says 'As root: tools/deps.sh build window film lab draw test check'
ok "not root, without sudo: lists what is missing, by group"

system 1000 "$everything"; run
expect_status 0; silent
ok "not root, without sudo, all there"

system 0 ""; no_apt; run
expect_status 1; says 'no apt-get'; says '^  build +g\+\+ make pkgconf git'
says '^  window .*libsdl2-dev'; says '^  check .*clang'; says 'DEPS=skip'
not_say libsundials
ok "no apt-get: lists all, by group"

system 1000 ""; other brew "make git"; run build window test
expect_status 0; calls 'brew install googletest libpng pkgconf sdl2-compat$' 1
calls sudo 0
ok "Homebrew: what is missing, in its names, without sudo"

system 1000 ""; other brew "make git pkgconf"; run build
expect_status 0; silent
ok "Homebrew: all there"

system 1000 ""; other dnf "make git pkgconf-pkg-config"; with_sudo
run build window
expect_status 0; calls 'dnf install -y .*SDL2-devel gcc-c++ .*mesa-libGL-devel' 1
not_say 'libsdl2|pkgconf'; calls sudo 1
ok "Fedora: what is missing, in its names, by sudo"

system 0 ""; no_apt
DEPS=skip run
expect_status 0; silent
ok "no apt-get, DEPS=skip"

system 0 "${everything/clang /}"; touch "$tmp/broken"; run
expect_status 1; says 'E: Unable to locate package'; says 'could not install'
says '^  check +clang *$'; calls ' install ' 1; not_say 'once more'
ok "install fails: the reason, no second try"

system 0 "${everything/clang /}"; touch "$tmp/flaky"; run
expect_status 0; says 'trying once more'; calls ' install ' 2
ok "a download fails once"

system 0 "${everything/clang /}"
echo 'E: Failed to fetch http://x' >"$tmp/offline"; run
expect_status 1; says 'E: Failed to fetch'; calls ' install ' 2
ok "a download fails twice"

system 0 "${everything/clang /}"; touch "$tmp/no_update"; run
expect_status 0; says 'E: a source is gone'; calls ' install ' 1
ok "update fails, install works"

system 1000 "${everything/xvfb/}"
stub sudo <<<"#!/bin/sh
echo 'sudo: a password is required'; exit 1"; run
expect_status 1; says 'a password is required'; says 'could not install'
ok "sudo refuses"

echo
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
