#!/usr/bin/env bash
# Make pictures fit for a page: 800 pixels wide and of 128 colors, a third of
# the bytes. Those that are no wider stay as they are.
#   tools/shrink_pictures.sh FILE.png...
set -euo pipefail

width=800 colors=128
small=$(mktemp --suffix=.png)
trap 'rm -f "$small"' EXIT

for picture; do
  wide=$(ffprobe -v error -show_entries stream=width -of csv=p=0 "$picture")
  [ "$wide" -gt "$width" ] || continue
  palette="palettegen=max_colors=$colors:reserve_transparent=0"
  ffmpeg -v error -y -i "$picture" -vf "
    scale=$width:-2:flags=lanczos, split[a][b];
    [a]${palette}[p]; [b][p]paletteuse=dither=sierra2_4a" \
    -pred none -compression_level 9 -update 1 "$small" </dev/null
  cp "$small" "$picture"
done
