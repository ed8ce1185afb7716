# Predicted over measured limit on the assignment's falling cloth: a column for
# a method, a point for a grid.
key = 3
key_is_method = 1
height = 480
load 'lab/charts/style.gp'

# Columns: 1 side, 2 mesh, 3 method, 8 predicted/measured.
sides = system(rows('!seen[$1]++ {print $1}'))
of(m, mesh) = data(sprintf('$3 == "%s" && $2 == "%s" '. \
  '{print $1 "," $8}', m, mesh))
side_at(side) = index_in(sides, sprintf('%g', side))
place(k, side, mesh) = k + 0.2 * (side_at(side) - (words(sides) + 1) / 2.0) + \
  (mesh eq 'plain' ? -0.03 : mesh eq 'diagonals' ? 0.03 : 0)
# How far the prediction is off at most [%].
off(condition) = real(system(rows(sprintf('%s {d = 100 * ($8 - 1); '. \
  'if (d < 0) d = -d; if (d > x) x = d} END {print x + 0}', condition))))
eval headline(sprintf('The predicted stability limit is right to %.1f %%', \
  off('1')), \
  'The falling cloth: predicted from the highest frequency of its run, '. \
  'measured by halving the step. Gray: as far as the worst point.')
set tmargin at screen 0.85
set lmargin at screen 0.085
set rmargin at screen 0.98
set xlabel 'numbers below the points: nodes a side' offset 0, 0.3 font small
set bmargin at screen 0.22
set xrange [0.5:words(names) + 0.5]
set yrange [-5:5]
set ylabel 'predicted above measured [%]' offset 1, 0
set xtics ()
do for [k = 1:words(names)] {
  set xtics add (word(names, k) k)
  worst = off(sprintf('$3 == "%s"', word(names, k)))
  set object k rectangle from k - 0.46, -worst to k + 0.46, worst \
    fc rgb '#ececec' fs solid noborder behind
  set label k + 1 sprintf('within %.1f %%', worst) at k, 4.6 center \
    font small textcolor rgb '#666666'
}
unset grid
set grid ytics lc rgb '#e4e4e4' lw 1 dt 1
set key at screen 0.5, 0.07 center maxrows 1 samplen 1 font small
plot 0 with lines lc rgb '#777777' lw 1 notitle, \
     for [k = 1:words(names)] of(word(names, k), 'plain') \
       using (place(k, $1, '')):(-4.7):(sprintf('%d', $1)) \
       with labels font small textcolor rgb '#666666' notitle, \
     for [k = 1:words(names)] of(word(names, k), 'plain') \
       using (place(k, $1, 'plain')):(100 * ($2 - 1)) with points \
       pt 6 ps 1.1 lw 1.6 lc rgb color(word(names, k)) \
       title k == 1 ? 'plain mesh' : '', \
     for [k = 1:words(names)] of(word(names, k), 'diagonals') \
       using (place(k, $1, 'diagonals')):(100 * ($2 - 1)) with points \
       pt 7 ps 1.1 lc rgb color(word(names, k)) \
       title k == 1 ? 'with diagonals' : ''
