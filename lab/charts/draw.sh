# How a chart is drawn; for the scripts beside this one.
# shellcheck shell=bash
draw() {  # SCRIPT CSV SCENE PICTURE
  gnuplot -e "csv='$2'; scene='$3'; out='$4.svg'" "lab/charts/$1.gp" \
    2> >(grep -v -e 'Skipping data file with no valid points' -e '^$' >&2)
  # Cells of a map stay cells when they are magnified.
  sed -i "s/<image /<image style='image-rendering:pixelated' /" "$4.svg"
  echo "$4.svg"
}
