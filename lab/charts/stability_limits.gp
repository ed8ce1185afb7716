# The largest stable step against the number of nodes: measured, predicted and
# safe; below, how far measured and predicted are apart.
key = 3
key_is_method = 1
height = 640
load 'lab/charts/style.gp'

# Columns: 1 side, 2 mesh, 3 method, 4 predicted, 5 measured, 6 safe [s].
of(m, mesh) = data(sprintf('$3 == "%s" && $2 == "%s" ' . \
  '{print $1 * $1 "," $4 "," $5 "," $6}', m, mesh))
# The nodes and the predicted limit of the smallest sheet, where names stand.
first(m, mesh) = system(rows(sprintf('$3 == "%s" && $2 == "%s" && '. \
  '!n++ {print $1 * $1, $4}', m, mesh)))
# symplectic-euler's points are drawn larger, below verlet's: they are the same.
size_of(m) = m eq 'symplectic-euler' ? 1.5 : 0.8

eval headline('Four times the nodes halve the stable step; prediction and '. \
  'measurement agree to 0.5 %', 'A sheet stretched to 1.5 times its size, '. \
  'drag 1/s. Points: measured by halving to 1 %, hence jumps below; lines: '. \
  'predicted; dashed: safe for verlet.')
set multiplot
unset key
set logscale x
set format x '10^{%T}'
set xrange [15:2e6]
do for [col = 0:1] {
  mesh = col == 0 ? 'plain' : 'diagonals'
  bound = col == 0 ? 0.0707 : 0.0577
  set lmargin at screen col == 0 ? 0.085 : 0.57
  set rmargin at screen col == 0 ? 0.495 : 0.98
  set tmargin at screen 0.85
  set bmargin at screen 0.43
  set title col == 0 ? 'plain mesh' : 'with diagonals' offset 0, -0.6
  set xlabel ''
  set logscale y
  set format y '10^{%T}'
  set yrange [3e-5:0.05]
  if (col == 0) {
    set ylabel 'largest stable step [s]' offset 1, 0
  } else {
    unset ylabel
  }
  set label 2 sprintf('dashed: %.4f/sqrt(nodes) s', bound) \
    at graph 0.04, 0.06 left font small
  set label 3 'slope -1/2' at 2e4, bound / sqrt(2e4) * 4.5 left font small
  set arrow 1 from 1e3, bound / sqrt(1e3) * 3.5 \
    to 1e5, bound / sqrt(1e5) * 3.5 nohead lc rgb '#777777' dt 1 lw 1.5
  above = first('rk4', mesh)
  below = first('verlet', mesh)
  eval sprintf("set label 4 'rk4' at %s, %s left offset 1, 0.6 ". \
    "textcolor rgb '%s' font ',11'", word(above, 1), word(above, 2), \
    color('rk4'))
  eval sprintf("set arrow 2 from %s, 1.4e-3 to %s, %s * 0.85 lc rgb '%s' ". \
    'head filled size screen 0.008, 20', word(below, 1), word(below, 1), \
    word(below, 2), color('verlet'))
  set label 5 'verlet' at 20, 1e-3 left textcolor rgb color('verlet') \
    font ',11'
  set label 6 'on top of symplectic-euler' at 20, 0.6e-3 left font ',11'
  plot for [m in names] of(m, mesh) using 1:2 with lines lc rgb color(m) \
         lw 1.8, \
       for [m in names] of(m, mesh) using 1:3 with points lc rgb color(m) \
         pt marker(m) ps size_of(m), \
       bound / sqrt(x) with lines lc rgb '#777777' dt 2 lw 1.6
  unset label
  unset arrow
  if (col == 0) { set label 7 'colors as above' at graph 0.98, 0.08 right \
    font small textcolor rgb '#666666' }
  set tmargin at screen 0.37
  set bmargin at screen 0.12
  unset title
  unset logscale y
  set format y '%g'
  set yrange [-1:1]
  set ytics 0.5
  set xlabel 'nodes' offset 0, 0.4
  if (col == 0) {
    set ylabel "measured above\npredicted [%]" offset 0, 0
  } else {
    unset ylabel
  }
  plot 0 with lines lc rgb '#777777' lw 1, \
       for [m in names] of(m, mesh) using 1:(100 * ($3 / $2 - 1)) \
         with linespoints lc rgb color(m) pt marker(m) lw 1.6 ps size_of(m)
  unset label
  set ytics autofreq
}
unset multiplot
