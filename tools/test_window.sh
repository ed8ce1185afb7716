#!/usr/bin/env bash
# Run mass_spring and cloth in a real window under Xvfb, press keys, and look at
# what is seen and said. They are taken from the folder BUILD, or from here.
# Needs: Xvfb, xdotool, ffmpeg, and both built with a viewer.
# Nothing is decided by a wait: what a key does is waited for where it is seen.
set -Eeuo pipefail
cd "$(dirname "$0")/.."

folder=${BUILD:-.}
mark='ff \(3f\|40\) b[23]'  # Color::make_mark()
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

start() {  # PROGRAM ARGUMENTS...: launch, and wait for the window
  env --default-signal "$folder/$1" "${@:2}" >"$tmp/out" 2>"$tmp/err" &
  run=$!
  # SDL tries windows that go again; xdotool ends where it meets such a one.
  for _ in {1..20}; do
    window=$(timeout 30 xdotool search --sync --onlyvisible --name "$1" \
      2>/dev/null | head -n 1) && [ -n "$window" ] &&
      xdotool windowfocus --sync "$window" && return 0
    sleep 0.1
  done
  echo "no window of $1"; cat "$tmp/err"
  return 1
}
ever() {  # CONDITION...: within a minute
  local end=$((SECONDS + 60))
  until "$@"; do
    [ $SECONDS -lt $end ] || { echo "never: $*"; return 1; }
    sleep 0.1
  done
}
cloth() {
  start cloth data/grid0.nodes data/grid0.tets --window --speed 0 "$@"
  ever labelled
}
driver() {  # GRID ARGUMENTS...: the assignment's program
  start mass_spring "data/grid$1.nodes" "data/grid$1.tets" "${@:2}"
}
press() {
  local key
  for key in "$@"; do xdotool key "$key"; done
}
ok() {  # NAME CONDITION...
  if "${@:2}"; then
    passed=$((passed + 1)); echo "ok    $1"
  else
    failed=$((failed + 1)); echo "FAIL  $1"
  fi
}
lines() { wc -l <"$tmp/out"; }
has_lines() { [ "$(lines)" -ge "$1" ]; }
more_lines() { ever has_lines $(($(lines) + $1)); }  # it says so many more
quiet() { local n; n=$(lines); sleep 2.5; [ "$(lines)" = "$n" ]; }
picture() {  # of the screen in hexadecimal, one pixel a line
  ffmpeg -v error -f x11grab -video_size 1280x1024 -i "$DISPLAY" -frames:v 1 \
    -f rawvideo -pix_fmt rgb24 - | od -An -v -tx1 -w3
}
title() { xdotool getwindowname "$window"; }
label() { title | grep -o 't = [0-9.]* s'; }  # in the title bar
labelled() { label >/dev/null; }
says() { [[ $(title) == *$1* ]]; }
shows() { [ "$(label)" = "$1" ]; }  # a label
differs() { [ "$("$1" | md5sum)" != "$2" ]; }
changes() { ever differs "$1" "$("$1" | md5sum)"; }
steps() {  # COMMAND...: which shows another time
  local before
  before=$(label | md5sum)
  "$@"
  ever differs label "$before"
}
# The message of a failure has a bar in the color of marks.
no_message() { [ "$(picture | grep -c "$mark")" -lt 100 ]; }
message() { ! no_message; }
said() { [ "$(grep -c 'diverged in step' "$tmp/err")" -ge "$1" ]; }
told() { ever said "$1"; }  # so many times that it failed
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

# The assignment's program: a line every 2 s of its 20 s.
driver 0 0.001 20
ok "the driver steps" more_lines 1
ok "and draws meanwhile" changes picture
ok "and has no message" no_message
press space
ok "space pauses" ever quiet
ok "the title says so" says paused
press r s
ok "r and s do nothing" quiet
press space
ok "space goes on" more_lines 1
press q
ends "q quits the driver" 0 "nodes"
driver 0 0.001 0.1
ok "a run of 0.1 s ends" ever grep -q '^t = 0.1 s' "$tmp/out"
ok "the window stays at the end" kill -0 "$run"
press Escape
ends "Escape quits the driver" 0 "t = 0.1 s"
driver 3
ok "a run that diverges says so in the picture" ever message
ok "and stays" kill -0 "$run"
press q
ends "and ends with 3" 3 "diverged: at t = "

# The laboratory's program.
cloth --paused; zero=$(label); press q
ends "q quits, and nothing moves while paused" 0 ": 0 steps to t = 0 s"
cloth --paused
for _ in 1 2 3; do steps press n; done; press Escape
ends "n makes one step, Escape quits" 0 ": 3 steps to t = 0.003 s"
cloth --paused
for _ in 1 2 3; do steps press n; done
press r; ever shows "$zero"; steps press n; press q
ends "r goes back to the start" 0 ": 1 steps to t = 0.001 s"
cloth --paused --dt 0.01
for _ in {1..5}; do steps press n; done; press q
ends "five long steps" 0 ": 5 steps to t = 0.05 s"
cloth --paused --t-end 0.05; before=$(picture | md5sum); press space
ever shows "t = 0.050 s"; ok "the outcome is shown" differs picture "$before"
press r; ever shows "t = 0.050 s"; press q
ends "the window stays at the end, r runs it again" 0 ": 50 steps to t = 0.05 s"
cloth --paused; press s c s; steps press n; press q
ends "coloring and centering change no step" 0 ": 1 steps"
cloth --t-end 1e6; changes label; press q
ends "q ends a running simulation" 0 "nodes and"
# On grid0 every step beyond 0.0123 s diverges.
cloth --dt 0.05; told 1; press space n s; kill -0 "$run"; press q
ends "a run that diverges is told at once and stays; q quits" 3 "diverged in step"
cloth --dt 0.05; told 1; press r; told 2; press r; told 3; press q
ends "r runs it again" 3 "diverged in step"
cloth --dt 0.05 --paused; press q
ends "nothing has failed before it runs" 0 ": 0 steps to t = 0 s"
cloth --paused --csv "$tmp/w.csv"; kill -TERM "$run"
ends "SIGTERM ends a paused window" 143 "SIGTERM ended the run at t = 0 s of 5 s; kept: $tmp/w.csv (1 row)"
cloth --t-end 1e6; changes label; kill -HUP "$run"
ends "SIGHUP ends a running one" 129 "SIGHUP ended the run at t = "

# A recording is played, and again.
printf '%s\n' 'mass_spring input 1' '0 scene 0 0 "net"' '| sheet = "nodes 9 9"' \
  '| pin = "x 0"' '2 gravity 3' '5 end' >"$tmp/in.txt"
start cloth --replay "$tmp/in.txt" --window --speed 0
ever shows "t = 0.005 s"; press r; ever shows "t = 0.005 s"; press q
ends "a recording is played in a window" 0 "2 requests, 5 steps to t = 0.005 s"

# DISPLAY leads nowhere.
run_dead() { DISPLAY=:12345 "$folder/cloth" data/grid0.nodes data/grid0.tets --window; }
run_dead >"$tmp/out" 2>"$tmp/err" & run=$!
ends "a dead display is an error" 4 "cloth: "

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
