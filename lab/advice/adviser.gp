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
eval headline(sprintf('Advice: %d of %d scenes within their tolerance, '. \
  '%d near the least work', met, all, cheap), \
  'A dot is a random scene that got advice. The best choice: the cheapest '. \
  'robust one of all grids, methods and steps.')
at_least(x) = x < 1e-3 ? 1e-3 : x
set multiplot
set logscale xy
set format xy '1e%T'
unset key
set tmargin at screen 0.85
set bmargin at screen 0.19
set lmargin at screen 0.095
set rmargin at screen 0.48
set xlabel 'predicted error/tolerance'
set ylabel 'real error/tolerance' offset 1, 0
set xrange [1e-3:3]
set yrange [1e-3:30]
set label 1 'misses its tolerance' at 1.3e-3, 2.3 left \
  textcolor rgb '#D55E00'
set label 2 'as predicted' at 3e-3, 1.6e-3 left rotate by 36 \
  textcolor rgb '#777777'
plot 1 lc rgb '#D55E00' lw 2, x lc rgb '#999999' dt 2, \
     advised using (at_least($9/$4)):(at_least($11/$4)) with points pt 7 \
       ps 0.5 lc rgb '#0072B2'
unset label
set lmargin at screen 0.6
set rmargin at screen 0.97
set xlabel 'work of the best choice [spring evaluations]'
set ylabel 'work of the advice/of the best choice'
set autoscale x
set yrange [0.01:100]  # what lies beyond is drawn on the edge
set ytics (0.01, 0.1, 0.5, 1, 2, 10, 100)
inside(x) = x < 0.01 ? 0.01 : x > 100 ? 100 : x
set format y '%g'
set label 1 'more than 1.5 times the least work' at graph 0.97, 0.97 right \
  textcolor rgb '#D55E00'
plot 1 lc rgb '#999999' dt 2, 1.5 lc rgb '#D55E00' lw 2, \
     advised using 17:(inside($16/$17)) with points pt 7 ps 0.5 lc rgb '#0072B2'
unset multiplot
