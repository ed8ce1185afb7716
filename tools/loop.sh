#!/usr/bin/env bash
# Make a film a picture that moves for ever: without its end, of half the
# frames, 480 pixels wide. At most 1.5 MB, as a page loads it each time.
#   tools/loop.sh FILM.mp4 LOOP.gif
set -euo pipefail

rate=30 most=1500000  # frames a second, bytes
frames=$(ffprobe -v error -show_entries stream=nb_frames -of csv=p=0 "$1")
end=$(((frames + 8) / 9)) # frames of the card: lab/run/Film.cpp
last=$((frames - (end < 45 ? end : 45)))
part=$(mktemp --suffix=.gif)
trap 'rm -f "$part"' EXIT

# The last frame stays for a second.
ffmpeg -v error -y -i "$1" -vf "
  trim=end_frame=$last, setpts=PTS-STARTPTS, fps=$rate/2,
  tpad=stop_mode=clone:stop_duration=1, scale=480:-2:flags=lanczos, split[a][b];
  [a]palettegen=max_colors=192[p]; [b][p]paletteuse=dither=bayer:bayer_scale=4
  " "$part" </dev/null
size=$(stat -c %s "$part")
[ "$size" -le "$most" ] ||
  { echo "$2: $size bytes, expected at most $most" >&2; exit 1; }
cp "$part" "$2"
