# Error against cost when the grid, the step, or both are refined.
#   gnuplot -e "csv='FILE.csv'; scene=''; out='grid_refinement.svg'" \
#     lab/charts/grid_refinement.gp
key = 1
key_is_method = 0
height = 440
load 'lab/charts/style.gp'

of(what) = data(sprintf('$1 == "%s" {print $5 "," $6 "," $2}', what))
fixed = system(rows('$1 == "step" {print $2; exit}'))
finest = system(rows('$1 == "grid" {n = $2} END {print n}'))
set title '{/:Bold Refining}: verlet; '.comment('scene')
set label 1 footer at screen 0.98, 0.03 right font small \
  textcolor rgb '#666666' noenhanced
set logscale xy
set format '10^{%T}'
set xlabel 'time of a run [s]'
set ylabel 'error of the height [m]'
set bmargin 5
set key top right reverse Left samplen 3
set offsets graph 0.02, graph 0.06, graph 0.1, graph 0.05
plot of('step') using 1:2 with linespoints lc rgb '#D55E00' pt 9 dt 1 lw 1.6 \
       title 'the step only, on '.fixed.' x '.fixed.' nodes', \
     of('grid') using 1:2 with linespoints lc rgb '#0072B2' pt 4 dt 2 lw 1.6 \
       title 'the grid only, at the step of '.finest.' x '.finest, \
     of('both') using 1:2 with linespoints lc rgb '#000000' pt 7 dt 3 lw 1.6 \
       title 'both: each grid at its largest stable step', \
     of('both') using 1:2:(sprintf('%d', $3)) with labels left \
       offset 0.6, 0.5 font small notitle
