#!/usr/bin/env bash
# Draw stages of the assignment side by side, at one time and from one place,
# each with its section and name.
#   tools/strip.sh CLOTH STRIP.png STAGE...
set -euo pipefail

cloth=$1 strip=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

inputs=() filter="" row=""
for stage in "${@:3}"; do
  scene=data/scenes/$stage.toml
  sed '/^view/d' "$scene" >"$folder/$stage.toml"
  "$cloth" --quiet --config "$folder/$stage.toml" data/grid1.* --t-end 0.45 \
    --view 'from 0 -0.3 -1 to 1 0.6 0' --size 320x400 \
    --screenshot "$folder/$stage.png"
  section=$(sed 's/^# \([0-9.]*\).*/\1/; q' "$scene")
  row+="[$stage]"
  filter+="[$((${#inputs[@]} / 2))]crop=320:330:0:40, drawtext=text='$section  \
$stage':font=DejaVu Sans:fontsize=24:fontcolor=white:x=12:y=8[$stage];"
  inputs+=(-i "$folder/$stage.png")
done
ffmpeg -v error -y "${inputs[@]}" -update 1 -frames:v 1 -filter_complex \
  "$filter${row}hstack=$(($# - 2))" "$strip" </dev/null
