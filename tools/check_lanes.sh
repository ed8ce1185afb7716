#!/usr/bin/env bash
# The kernel of the forces is what lab/fast/README.md says. One vector square
# root and one vector division for a register full of springs, no scalar one.
# No number is stored alone, which takes several times as long as the rest. No
# product and sum are rounded at once: other processors would give other bits.
# By both compilers; for ARM by g++, if it is installed.
set -euo pipefail
cd "$(dirname "$0")/.."

[ "$(uname -m)" = x86_64 ] || exit 0
passed=0 failed=0
contract=$(grep -oe '-ffp-contract=[a-z]*' lab/lab.mk)

# What COMPILER makes of the kernel for CPU; the plain one may be inlined.
kernel() {  # COMPILER CPU
  local name="on_$2.*KickTiles"
  [ "$2" != plain ] || name="(on_plain.*KickTiles|5sweep)"
  echo '#include "lab/fast/FlatKernels.hpp"
    using namespace lab;
    void sweep(const kernels::KickTask& task, unsigned n) {
      lanes::run<kernels::KickTiles>(task, 0u, n);
    }' |
    "$1" -std=c++20 -O3 -DNDEBUG -fno-math-errno "$contract" -I. -x c++ -S -o - - |
    sed -nE "/^_Z.*$name.*:/,/^[[:space:]]*\.cfi_endproc/p"
}

expect() {  # COMPILER CPU ROOT DIVISION REGISTER
  local text
  text=$(kernel "$1" "$2")
  if grep -qE "[[:space:]]$3[[:space:]].*$5" <<<"$text" &&
    grep -qE "[[:space:]]$4[[:space:]].*$5" <<<"$text" &&
    ! grep -qE '[[:space:]](v?(sqrt|div)sd|f(sqrt|div)[[:space:]]+d[0-9])' <<<"$text" &&
    ! grep -qE '[[:space:]]vmov[slh]p?d[[:space:]]+%xmm[0-9]+, ' <<<"$text" &&
    ! grep -qE '[[:space:]](vfn?m(add|sub)|fml[as]|fn?m(add|sub)[[:space:]])' <<<"$text"; then
    passed=$((passed + 1))
  else
    echo "$1 does not keep the springs in vectors for $2"
    failed=$((failed + 1))
  fi
}

for compiler in g++ clang++; do
  expect $compiler avx512 vsqrtpd vdivpd zmm
  expect $compiler avx2 vsqrtpd vdivpd ymm
  expect $compiler plain sqrtpd divpd xmm
done
if command -v aarch64-linux-gnu-g++ >/dev/null; then
  expect aarch64-linux-gnu-g++ plain fsqrt fdiv 'v[0-9]+\.2d'
else
  echo 'skipped: ARM: apt-get install g++-aarch64-linux-gnu'
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
