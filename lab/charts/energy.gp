# Total energy against time, and how far it has been off so far: all methods on
# a cloth without drag, whose energy is 0 for ever.
#   gnuplot -e "csv='FILE.csv'; scene=''; out='energy.svg'" \
#     lab/charts/energy.gp
key = 1
key_is_method = 1
height = 640
load 'lab/charts/style.gp'

energy(m) = data(sprintf('$1 == "%s" {print $2 "," $3}', m))
so_far(m) = data(sprintf('$1 == "%s" && $2 > 0 {e = $3 < 0 ? -$3 : $3; '. \
  'if (e > w) w = e; print $2 "," w}', m))
ended(m) = data(sprintf('$1 == "%s" && $4 != "ok" {print $2 ",50"}', m))
lost = system(rows('$4 != "ok" {print $1}'))

about = comment('scene')
about = about[1:strstrt(about, ';') - 1]
set multiplot
set label 1 '{/:Bold Energy}: '.about. \
  '; explicit methods at equal cost, others at 5 times verlet''s limit' \
  at screen 0.5, 0.965 center
unset key
set tmargin at screen 0.925
set bmargin at screen 0.35
set xlabel 'time [s]' offset 0, 0.3
set xrange [0:5]
set lmargin at screen 0.075
set rmargin at screen 0.48
set yrange [-6:3]
set ylabel 'total energy [J]' offset 1, 0
plot for [m in names] energy(m) using 1:2 with linespoints lc rgb color(m) \
  pt marker(m) pi 30 dt dash(m) lw 1.6 ps 0.8
set lmargin at screen 0.57
set rmargin at screen 0.98
set logscale y
set format y '10^{%T}'
set yrange [1e-9:100]
set ylabel 'largest error of the energy so far [J]' offset 1, 0
unset label 1
plot for [m in names] so_far(m) using 1:2 with linespoints lc rgb color(m) \
       pt marker(m) pi 30 dt dash(m) lw 1.6 ps 0.8, \
     for [m in lost] ended(m) using 1:2 with points lc rgb color(m) pt 2 \
       lw 1.8 ps 1.1
entries = '2|#222222|diverged'
load 'lab/charts/legend.gp'
