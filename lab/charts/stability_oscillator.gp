# Growth per step of an oscillator against dt omega and dt gamma, a panel for a
# method; the line is the boundary by theory.
#   gnuplot -e "csv='FILE.csv'; scene=''; out='stability_oscillator.svg'" \
#     lab/charts/stability_oscillator.gp
key = 1
key_is_method = 1
height = 660
load 'lab/charts/style.gp'
load 'lab/charts/palette.gp'

# Columns: 1 method, 2 dt omega, 3 dt gamma, 4 measured, empty on the boundary.
measured(m) = data(sprintf('$1 == "%s" && $4 != "" '. \
  '{print $2 "," $3 "," $4}', m))
boundary(m) = data(sprintf('$1 == "%s" && $4 == "" {print $2 "," $3}', m))
widest(m) = real(system(rows(sprintf('$1 == "%s" && $4 != "" {x = $2} '. \
  'END {print x}', m))))

set multiplot
set label 1 '{/:Bold Growth per step} of an oscillator with drag: white is '. \
  'bounded; line: where theory says that it is 1' at screen 0.5, 0.965 center
eval "set palette defined (0 'white', 0.02 'white', ".viridis.")"
shade(g) = g > 1 ? log10(g) : -1
set cbrange [-0.02:1]
set cbtics ('1' 0, '2' log10(2), '5' log10(5), '10' 1) scale 0.5
unset key
unset grid
set yrange [0:4]
set ytics 1
left = 0.065
step_x = 0.222
do for [k = 1:words(names)] {
  m = word(names, k)
  row = (k - 1) / 4
  col = (k - 1) % 4
  set lmargin at screen left + step_x * col
  set rmargin at screen left + step_x * col + 0.195
  set tmargin at screen row == 0 ? 0.88 : 0.45
  set bmargin at screen row == 0 ? 0.55 : 0.12
  set title m offset 0, -0.6 noenhanced
  set xlabel row == 1 ? 'dt omega' : '' offset 0, 0.4
  set ylabel col == 0 ? 'dt gamma' : '' offset 0.5, 0
  set format y col == 0 ? '%g' : ''
  set xrange [0:widest(m)]
  apart = widest(m) < 4 ? 1 : 2
  set xtics apart
  if (k == words(names)) {
    set colorbox user origin 0.942, 0.12 size 0.014, 0.76
    set label 2 footer at screen 0.985, 0.025 right font small \
      textcolor rgb '#666666' noenhanced
    set label 4 'growth' at screen 0.985, 0.905 right font small
  } else {
    unset colorbox
  }
  plot measured(m) using 1:2:(shade($3)) with image, \
       boundary(m) using 1:2 with points pt 7 ps 0.6 lc rgb 'white', \
       boundary(m) using 1:2 with points pt 7 ps 0.25 lc rgb 'black'
  unset label 1
}
unset multiplot
