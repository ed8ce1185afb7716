#!/usr/bin/env bash
# Test tools/deps.sh on make-believe systems: a PATH of stubs, no network.
set -euo pipefail
script=$(cd "$(dirname "$0")" && pwd)/deps.sh
# shellcheck source=tools/cases.sh
. "${script%/*}/cases.sh"

stub() { { echo '#!/bin/sh'; cat; } >"$tmp/bin/$1"; chmod +x "$tmp/bin/$1"; }
# A system: who one is, and the packages that are installed. Stubs write every
# call to $tmp/calls; apt-get fails where $tmp has a file of that name.
system() {  # USER-ID PACKAGES [brew|dnf|none]
  rm -rf "${tmp:?}"/*
  mkdir "$tmp/bin"
  local tool
  for tool in bash cat env grep mktemp rm sed sort tail tr; do
    ln -s "$(command -v "$tool")" "$tmp/bin/$tool"
  done
  # shellcheck disable=SC2086  # one word a package
  printf 'installed %s, \n' $2 >"$tmp/dpkg"
  printf '%s\n' "$2" >"$tmp/there"
  : >"$tmp/calls"
  stub id <<<"echo $1"
  stub sudo <<<"echo sudo >>'$tmp/calls'; exec \"\$@\""
  case ${3:-apt} in
    apt)
      stub dpkg-query <<<"case \"\$*\" in *Provides*) cat '$tmp/dpkg';;
        *) sed 's/,.*//' '$tmp/dpkg';; esac"
      stub apt-cache <<<"printf 'libclang-rt-%s-dev-wasm32\n' 9 19 21 14"
      stub apt-get <<<"echo \"\$DEBIAN_FRONTEND \$*\" >>'$tmp/calls'
        for file in update install; do case \"\$*\" in *\$file*)
          test ! -e '$tmp/'\$file || { echo \"E: no \$file\"; exit 100; }
        esac; done" ;;
    none) ;;
    *)
      stub rpm <<<"cat '$tmp/there'"
      stub "$3" <<<"case \$1 in list) cat '$tmp/there';;
        *) echo \"$3 \$*\" >>'$tmp/calls';; esac" ;;
  esac
}
run() { attempt env -u DEBIAN_FRONTEND PATH="$tmp/bin" bash "$script" "$@"; }
silent() { same "what it says" "$out" ""; same calls "$(cat "$tmp/calls")" ""; }
calls() {  # PATTERN TIMES
  same "calls of '$1'" "$(grep -cE -- "$1" "$tmp/calls" || true)" "$2"
}

system 0 "" none; run
expect 1; says 'no apt-get'; says '  build   g++ make pkgconf git'
says 'DEPS=skip'; not_say libsundials
ok "no apt-get: lists all, by group"
everything=$(sed -n 's/^  [a-z]* //p' <<<"$out" | tr '\n' ' ')

DEPS=skip run; expect 0; silent; ok "no apt-get, DEPS=skip"
system 0 "$everything"; run; expect 0; silent
ok "all there: silent, no apt"
some=${everything/pkgconf/pkg-config}
system 0 "${some/python3-matplotlib/}"
echo 'installed other, matplotlib (= 5), python3-matplotlib (= 5)' >>"$tmp/dpkg"
run; expect 0; silent
ok "an alternative, and a package that another one provides"
system 0 "${everything/ git/ libgit}"; run
expect 0; says 'installing git'; calls '^noninteractive .* update' 1; calls sudo 0
calls '^noninteractive .* install --no-install-recommends git$' 1
ok "one missing, root; a name inside another one is not it"
system 0 "$everything"; run grade
expect 0; says 'installing libseccomp-dev python3-tomli'
stub python3 <<<""; run grade; not_say tomli
ok "group grade, with a Python that has no tomllib, and one that has it"
system 0 "$everything"; run web
expect 0; calls 'install .*clang-21 .*libclang-rt-21-dev-wasm32' 1
not_say clang-N
system 0 "$everything clang-19 lld-19 wasi-libc libc++-19-dev-wasm32
  libclang-rt-19-dev-wasm32"; run web
expect 0; silent
ok "group web: the newest clang for WebAssembly, or the one that is there"
run build toys; expect 2; says "no group 'toys'"; ok "a group that there is not"

system 1000 "${everything/xvfb/}"; run
expect 0; says 'installing xvfb'; calls sudo 2; calls ' install .*xvfb$' 1
ok "not root, with sudo"
system 1000 "${everything/xvfb/}"; rm "$tmp/bin/sudo"; run
expect 1; says 'you must be root'; says '  check   xvfb'; not_say ffmpeg
says 'As root: tools/deps.sh build window film lab draw test check'; calls . 0
ok "not root, without sudo: lists what is missing, by group"
system 1000 "make git" brew; run build window test
expect 0; calls '^brew install googletest libpng pkgconf sdl2-compat$' 1
calls sudo 0
ok "Homebrew: what is missing, in its names, without sudo"
system 1000 "make git pkgconf-pkg-config" dnf; run build window
expect 0; calls '^dnf install -y .*SDL2-devel gcc-c\+\+ .*mesa-libGL-devel' 1
not_say libsdl2; calls sudo 1
ok "Fedora: what is missing, in its names, by sudo"

system 0 "${everything/clang /}"; touch "$tmp/install"; run
expect 1; says 'E: no install'; says 'could not install'; says '  check   clang'
ok "install fails: the reason, and what is missing"
all_passed
