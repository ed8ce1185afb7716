# Predicted over measured limit on the assignment's falling cloth: a column for
# a method, a point for a grid.
key = 3
key_is_method = 1
height = 420
load 'lab/charts/style.gp'

# Columns: 1 side, 2 mesh, 3 method, 8 predicted/measured.
sides = system(rows('!seen[$1]++ {print $1}'))
of(m, mesh) = data(sprintf('$3 == "%s" && $2 == "%s" '. \
  '{print $1 "," $8}', m, mesh))
side_at(side) = index_in(sides, sprintf('%g', side))
place(k, side) = k + 0.2 * (side_at(side) - (words(sides) + 1) / 2.0)
# How far the prediction is off at most [%].
off(condition) = real(system(rows(sprintf('%s {d = 100 * ($8 - 1); '. \
  'if (d < 0) d = -d; if (d > x) x = d} END {print x + 0}', condition))))
meshes = 'plain diagonals'
shade(mesh) = mesh eq 'plain' ? '#0072B2' : '#D55E00'
eval headline(sprintf('The predicted stability limit is right to %.1f %%', \
  off('1')), \
  'The falling cloth of the assignment: predicted from the highest frequency '. \
  'of its run; measured by halving the step.')
set tmargin at screen 0.78
set lmargin at screen 0.085
set rmargin at screen 0.98
set bmargin at screen 0.15
set xrange [0.5:words(names) + 0.5]
set yrange [-5:5]
set ylabel 'predicted above measured [%]' offset 1, 0
set xtics ()
set label 1 'plain mesh' at graph 0, 1.08 textcolor rgb shade('plain')
set label 2 'with diagonals' at graph 0.15, 1.08 \
  textcolor rgb shade('diagonals')
set label 3 'numbers at the bottom: nodes a side' at graph 0.32, 1.08 \
  textcolor rgb '#666666'
do for [k = 1:words(names)] {
  set xtics add (word(names, k) k)
  set label k + 3 sprintf('within %.1f %%', \
    off(sprintf('$3 == "%s"', word(names, k)))) at k, 4.6 center \
    font small textcolor rgb '#666666'
}
unset grid
set grid ytics lc rgb '#e4e4e4' lw 1 dt 1
unset key
plot 0 with lines lc rgb '#777777' lw 1, \
     for [k = 1:words(names)] of(word(names, k), 'plain') \
       using (place(k, $1)):(-4.6):(sprintf('%d', $1)) \
       with labels font small textcolor rgb '#666666', \
     for [k = 1:words(names)] for [mesh in meshes] of(word(names, k), mesh) \
       using (place(k, $1)):(100 * ($2 - 1)) with points pt 7 ps 0.9 \
       lc rgb shade(mesh)
