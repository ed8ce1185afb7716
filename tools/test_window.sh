#!/usr/bin/env bash
# Run ./mass_spring in a real window under Xvfb, press keys, and look at what
# it says when it ends. Needs: Xvfb, xdotool, and mass_spring built.
set -Eeuo pipefail
cd "$(dirname "$0")/.."

program=${MASS_SPRING:-./mass_spring}
tmp=$(mktemp -d)
passed=0 failed=0
xvfb="" run=""
trap 'kill $xvfb $run 2>/dev/null || true; rm -rf "$tmp"' EXIT
trap 'echo "line $LINENO: failed"' ERR

# A display of our own; Xvfb writes its number when it is ready.
exec 3<> <(:)
Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp -noreset 2>/dev/null &
xvfb=$!
read -r -t 20 number <&3 || { echo "Xvfb does not start"; exit 1; }
export DISPLAY=:$number
unset WAYLAND_DISPLAY

launch() {  # on grid0, with options
  "$program" data/grid0.nodes data/grid0.tets --window --speed 0 "$@" \
    >"$tmp/out" 2>"$tmp/err" &
  run=$!
}
start() {  # launch, and wait for the window
  launch "$@"
  window=$(timeout 30 xdotool search --sync --onlyvisible --name mass_spring |
    head -n 1)
  xdotool windowfocus --sync "$window"
}
press() {
  local key
  for key in "$@"; do xdotool key "$key"; sleep 0.15; done
}
told() {  # wait until it has said $1 times that it failed
  for _ in {1..100}; do
    [ "$(grep -c 'diverged in step' "$tmp/err")" -lt "$1" ] || return 0
    sleep 0.1
  done
  echo "not told $1 times:"; cat "$tmp/err"
}
# Wait for the end; expect status $2 and the words $3 in what it said.
ends() {  # NAME STATUS WORDS
  local status=0
  wait "$run" || status=$?
  run=""
  if [ "$status" = "$2" ] && grep -qF -- "$3" "$tmp/out" "$tmp/err"; then
    passed=$((passed + 1)); echo "ok    $1"
  else
    failed=$((failed + 1)); echo "FAIL  $1: status $status, not $2, or no '$3' in"
    cat "$tmp/out" "$tmp/err"
  fi
}

start --paused; press q
ends "q quits, and nothing moves while paused" 0 ": 0 steps to t = 0 s"
start --paused; press n n n Escape
ends "n makes one step, Escape quits" 0 ": 3 steps to t = 0.003 s"
start --paused; press n n n r n q
ends "r goes back to the start" 0 ": 1 steps to t = 0.001 s"
start --paused --t-end 0.05; press space; sleep 1; press q
ends "space goes on to the end, and the window stays" 0 ": 50 steps to t = 0.05 s"
start --paused; press s c s n q
ends "coloring and centering change no step" 0 ": 1 steps"
start --t-end 1e6; sleep 0.5; press q
ends "q ends a running simulation" 0 "nodes and"
# On grid0 every step beyond 0.0123 s diverges.
start --dt 0.05; told 1; press space n s; kill -0 "$run"; press q
ends "a run that diverges is told at once and stays; q quits" 3 "diverged in step"
start --dt 0.05; told 1; press r; told 2; press r; told 3; press q
ends "r runs it again" 3 "diverged in step"
start --dt 0.05 --paused; press q
ends "nothing has failed before it runs" 0 ": 0 steps to t = 0 s"

# DISPLAY leads nowhere.
run_dead() { DISPLAY=:12345 "$program" data/grid0.nodes data/grid0.tets --window; }
run_dead >"$tmp/out" 2>"$tmp/err" & run=$!
ends "a dead display is an error" 4 "mass_spring: "

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
