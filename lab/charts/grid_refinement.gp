# Cost against error when the grid, the step, or both are refined.
key = 1
key_is_method = 0
height = 440
load 'lab/charts/style.gp'

of(what) = data(sprintf('$1 == "%s" {print $6 "," $5 "," $2}', what))
fixed = system(rows('$1 == "step" {print $2; exit}'))
finest = system(rows('$1 == "grid" {n = $2} END {print n}'))
# The point of a curve, counted from its end, at which its name stands.
named(what, n) = data(sprintf('$1 == "%s" {p[++k] = $6 "," $5} '. \
  'END {print p[k - %d]}', what, n))
eval headline('Refine grid and step together; the step alone gains nothing', \
  comment('scene'))
set logscale xy
set format y '1e%T'
set lmargin at screen 0.085
set rmargin at screen 0.95
set tmargin at screen 0.84
set bmargin at screen 0.2
set xtics (0.05, 0.02, 0.01, 0.005, 0.002)
set xlabel 'error of the height of the center of mass [m], smaller to the right'
set ylabel 'time of a run [s]'
set xrange [0.06:0.002]
set yrange [1e-5:1]
unset key
plot of('grid') using 1:2 with linespoints lc rgb '#0072B2' pt 7 ps 0.7 \
       lw 1.8, \
     of('step') using 1:2 with linespoints lc rgb '#D55E00' pt 7 ps 0.7 lw 1.8, \
     of('both') using 1:2 with linespoints lc rgb '#000000' pt 7 ps 0.7 lw 1.8, \
     of('both') using 1:2:(sprintf('%d x %d', $3, $3)) with labels left \
       offset 0.8, -0.6 font small textcolor rgb '#666666', \
     named('step', 0) using 1:2:('step alone, '.fixed.' x '.fixed.' nodes') \
       with labels right offset -1, 0 textcolor rgb '#D55E00', \
     named('grid', 1) using 1:2:('grid alone, at the step that '. \
       finest.' x '.finest.' needs') with labels right offset -1, 0.8 \
       textcolor rgb '#0072B2', \
     named('both', 1) using 1:2:('both: each grid at its limit') \
       with labels left offset 0, -2.2 textcolor rgb '#000000'
