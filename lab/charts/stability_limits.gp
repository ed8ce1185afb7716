# The largest stable step against the number of nodes: measured, predicted and
# safe, a panel for a mesh.
key = 3
key_is_method = 1
height = 430
load 'lab/charts/style.gp'

# Columns: 1 side, 2 mesh, 3 method, 4 predicted, 5 measured, 6 safe [s].
of(m, mesh) = data(sprintf('$3 == "%s" && $2 == "%s" ' . \
  '{print $1 * $1 "," $4 "," $5 "," $6}', m, mesh))
# How far measured and predicted limits are apart at most [%].
apart = real(system(rows('1 {d = 100 * ($5 / $4 - 1); if (d < 0) d = -d; '. \
  'if (d > x) x = d} END {print x + 0}')))

eval headline(sprintf('Four times the nodes halve the stable step; '. \
  'prediction is right to %.1f %%', apart), \
  'A sheet stretched to 1.5 times its size, drag 1/s. Points: measured; '. \
  'lines: predicted; dashed: safe, known before the run.')
set multiplot
unset key
set logscale xy
set format xy '1e%T'
set xrange [15:2e6]
set yrange [3e-5:0.05]
set tmargin at screen 0.82
set bmargin at screen 0.18
set xlabel 'nodes' offset 0, 0.4
shown = 'verlet rk4'
do for [col = 0:1] {
  mesh = col == 0 ? 'plain' : 'diagonals'
  bound = col == 0 ? 0.0707 : 0.0577
  set lmargin at screen col == 0 ? 0.09 : 0.57
  set rmargin at screen col == 0 ? 0.5 : 0.98
  set title col == 0 ? 'plain mesh' : 'with diagonals' offset 0, -0.6
  if (col == 0) {
    set ylabel 'largest stable step [s]' offset 1, 0
  } else {
    unset ylabel
  }
  set label 1 sprintf('safe for verlet: %.4f/sqrt(nodes) s', bound) \
    at graph 0.04, 0.07 left font small textcolor rgb '#666666'
  set label 2 'rk4' at 1e4, bound / 100 * 2.6 left textcolor rgb color('rk4')
  set label 3 'verlet = symplectic-euler' at graph 0.04, 0.17 left \
    textcolor rgb color('verlet')
  plot bound / sqrt(x) with lines lc rgb '#777777' dt 2 lw 1.6, \
       for [m in shown] of(m, mesh) using 1:2 with lines lc rgb color(m) \
         lw 1.8, \
       for [m in shown] of(m, mesh) using 1:3 with points lc rgb color(m) \
         pt 7 ps 0.7
  unset label
}
unset multiplot
