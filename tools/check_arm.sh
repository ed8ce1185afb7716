#!/usr/bin/env bash
# Scenes give the same bits by an ARM processor (aarch64, in an emulator) as
# here: positions after some steps by each method that is offered. Needs
# g++-aarch64-linux-gnu and qemu-user.
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/check/arm
# The rooms that simulate; of the system's headers, those that are not there
# for ARM are taken from here: they are the same for all processors.
make --no-print-directory -j"${JOBS:-2}" B=build/check UNITY=1 \
  build/check/page_positions
make --no-print-directory -j"${JOBS:-2}" B=$build UNITY=1 VIEWER=0 \
  CXX=aarch64-linux-gnu-g++ CPPFLAGS='-idirafter /usr/include' LDLIBS=-static \
  lab_lib="$(echo lab/{fast,methods,stability,scenes,stepping}/*.cpp)" \
  $build/page_positions

passed=0 failed=0
same() {  # SCENE GRID STEPS [METHOD DT]...
  local here there
  here=$(build/check/page_positions "$@" | sha256sum)
  there=$(timeout 300 qemu-aarch64 $build/page_positions "$@" | sha256sum)
  if [ "$here" = "$there" ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1)); echo "other bits by ARM: $*"
  fi
}
methods=$(sed -n 's/^ *\.name = "\(.*\)",$/\1/p' lab/methods/*.hpp)
for method in $methods; do
  same data/scenes/forces.toml data/grid1 50 "$method" 0.0005
done
for scene in tear constraints curtain; do
  same data/scenes/$scene.toml data/grid1 300 verlet 0.0005
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
