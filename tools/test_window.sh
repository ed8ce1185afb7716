#!/usr/bin/env bash
# Run mass_spring and cloth in a real window under Xvfb, press keys, and look at
# what is seen and said. They are taken from the folder BUILD, or from here.
# Needs: Xvfb, xdotool, ffmpeg, and both built with a viewer.
# Nothing is decided by a wait: what a key does is waited for where it is seen.
set -Eeuo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=tools/cases.sh
. tools/cases.sh
folder=${BUILD:-.}
mark='ff \(3f\|40\) b[23]'  # Color::make_mark()
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
  env --default-signal "$folder/$1" "${@:2}" >"$tmp/out" 2>&1 &
  run=$!
  # SDL tries windows that go again; xdotool ends where it meets such a one.
  for _ in {1..20}; do
    window=$(timeout 30 xdotool search --sync --onlyvisible --name "$1" \
      2>/dev/null | head -n 1) && [ -n "$window" ] &&
      xdotool windowfocus --sync "$window" && return 0
    sleep 0.1
  done
  echo "no window of $1"; cat "$tmp/out"
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
  ever label >/dev/null
}
driver() {  # GRID ARGUMENTS...: the assignment's program
  start mass_spring "data/grid$1.nodes" "data/grid$1.tets" "${@:2}"
}
press() { local key; for key; do xdotool key "$key"; done; }
is() { "${@:2}" || why=" it is not so;"; ok "$1"; }  # NAME CONDITION...
said() { [ "$(grep -c "$1" "$tmp/out")" -ge "$2" ]; }  # PATTERN TIMES
more_lines() { ever said '' $(($(wc -l <"$tmp/out") + 1)); }
picture() {  # of the screen in hexadecimal, one pixel a line
  ffmpeg -v error -f x11grab -video_size 1280x1024 -i "$DISPLAY" -frames:v 1 \
    -f rawvideo -pix_fmt rgb24 - | od -An -v -tx1 -w3
}
title() { xdotool getwindowname "$window"; }
label() { title | grep -o 't = [0-9.]* s'; }  # in the title bar
titled() { [[ $(title) == *$1* ]]; }
differs() { [ "$("$1" | md5sum)" != "$2" ]; }  # COMMAND SUM
steps() {  # NUMBER: presses of n, each seen
  local before
  for _ in $(seq "$1"); do
    before=$(label | md5sum)
    press n
    ever differs label "$before"
  done
}
# The message of a failure has a bar in the color of marks.
message() { [ "$(picture | grep -c "$mark")" -ge 100 ]; }
ends() {  # NAME STATUS WORDS, that it said
  wait "$run" && status=0 || status=$?
  run="" out=$(tr '\n' ' ' <"$tmp/out" | tr -s ' ')
  expect "$2"; says "$3"; ok "$1"
}

# The assignment's program: a line every 2 s of its 20 s.
driver 0 0.001 20
is "the driver steps" more_lines
press space; is "space pauses" ever titled paused
press space; is "space goes on" more_lines
is "there is no message" eval '! message'
press q; ends "q quits the driver" 0 nodes
driver 3
is "a run that diverges says so in the picture" ever message
press q; ends "and stays, and ends with 3" 3 "diverged: at t = "

# The laboratory's program.
cloth --paused; zero=$(label); steps 2; press r; ever titled "$zero"
press s c s; steps 3; press Escape
ends "r goes back, s and c change no step, n makes one" 0 ": 3 steps to t = 0.003 s"
cloth --paused --t-end 0.05; before=$(picture | md5sum); press space
ever titled "t = 0.050 s"; is "the outcome is shown" differs picture "$before"
press r; ever titled "t = 0.050 s"; press q
ends "the window stays at the end, r runs it again" 0 ": 50 steps to t = 0.05 s"
# On grid0 every step beyond 0.0123 s diverges.
cloth --dt 0.05
for k in 1 2; do ever said 'diverged: ' $k; press r; done
ever said 'diverged: ' 3; press q
ends "a run that diverges says so and stays; r runs it again" 3 "diverged: "
cloth --paused --csv "$tmp/w.csv"; kill -TERM "$run"
ends "SIGTERM ends a paused window" 143 "SIGTERM ended the run at t = 0 s of 5 s; kept: $tmp/w.csv (1 row)"

# A run with a change, and again.
cloth --t-end 0.005 --at '0.002 gravity 3'
ever titled "t = 0.005 s"; press r; ever titled "t = 0.005 s"; press q
ends "a change is made again" 0 ": 5 steps to t = 0.005 s"

attempt env DISPLAY=:12345 "$folder/cloth" data/grid0.nodes data/grid0.tets --window
expect 4; says "cloth: "; ok "a dead display is an error"
all_passed
