# What suite.py found: real against predicted error, and chosen against best
# cost, a dot a scene that brute force answers and that got advice.
key = 0
key_is_method = 0
height = 470
load 'lab/charts/style.gp'

advised = "< awk -F, '$6 == \"advised\" && $17 > 0' ".csv
count(condition) = int(system(sprintf("awk -F, '$6 == \"advised\" && " \
  ."$17 > 0 && (%s) {++n} END {print n + 0}' %s", condition, csv)))
all = count('1')
met = count('$11 <= $4')
cheap = count('$16 <= 1.5 * $17')
eval headline(sprintf('Advice keeps its tolerance in %d of %d scenes, '. \
  'and costs at most 1.5 times the best choice in %d', met, all, cheap), \
  'A dot is a random scene that got advice; the best choice is the cheapest '. \
  'robust one of all grids, methods and steps.')
at_least(x) = x < 1e-3 ? 1e-3 : x
set multiplot
set logscale xy
set format xy '10^{%L}'
unset key
set tmargin at screen 0.84
set bmargin at screen 0.19
set lmargin at screen 0.085
set rmargin at screen 0.48
set xlabel 'predicted error/tolerance'
set ylabel 'real error/tolerance'
set xrange [1e-3:3]
set yrange [1e-3:30]
set label 1 'more than the tolerance' at 1.3e-3, 2.3 left \
  textcolor rgb '#D55E00'
set label 2 'as predicted' at 3e-3, 1.6e-3 left rotate by 36 \
  textcolor rgb '#777777'
plot 1 lc rgb '#D55E00' lw 2, x lc rgb '#999999' dt 2, \
     advised using (at_least($9/$4)):(at_least($11/$4)) with points pt 7 \
       ps 0.5 lc rgb '#0072B2'
unset label
set lmargin at screen 0.575
set rmargin at screen 0.97
set xlabel 'spring evaluations (springs x force evaluations) of the best choice'
set ylabel 'spring evaluations of the advised run'
set autoscale xy
set label 1 '1.5 times the best' at graph 0.53, 0.68 right \
  textcolor rgb '#D55E00'
set label 2 'as the best' at graph 0.6, 0.48 left textcolor rgb '#777777'
plot x lc rgb '#999999' dt 2, 1.5*x lc rgb '#D55E00' lw 2, \
     advised using 17:16 with points pt 7 ps 0.5 lc rgb '#0072B2'
unset multiplot
