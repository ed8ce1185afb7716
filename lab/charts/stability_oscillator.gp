# Growth per step of an oscillator with drag, a panel for a method. Both axes
# are divided by the force evaluations of a step, so that all panels have the
# same ones: equal distances are equal work.
key = 1
key_is_method = 1
height = 560
load 'lab/charts/style.gp'
load 'lab/charts/palette.gp'

# Columns: 1 method, 2 dt omega, 3 dt gamma, 4 measured, empty on the boundary.
of(m, condition) = data(sprintf('$1 == "%s" && %s '. \
  '{print $2 / %d "," $3 / %d "," $4}', m, condition, evaluations(m), \
  evaluations(m)))
measured(m) = of(m, '$4 != ""')
# Of each boundary a point in each square of 1/20, seen as it is drawn.
boundary(m) = of(m, sprintf('$4 == "" && !seen[int(20 * $2 / %d) "," '. \
  'int(20 * $3 / %d)]++', evaluations(m), evaluations(m)))
widest(m, column) = real(system(rows(sprintf('$1 == "%s" && $4 != "" && '. \
  '$%d > x {x = $%d} END {print x}', m, column, column)))) / evaluations(m)

# Where growth begins with next to no drag, by theory; of two the least.
limit(m) = real(system(rows(sprintf('$1 == "%s" && $4 == "" && $3 < 0.02 && '. \
  '(!x || $2 < x) {x = $2} END {print x + 0}', m)))) / evaluations(m)
others = 0
do for [m in names] {
  if (m ne 'verlet' && m ne 'symplectic-euler' && limit(m) > others) {
    others = limit(m)
  }
}
eval headline(sprintf('Without drag verlet and symplectic-euler are stable '. \
  'to dt omega = %.2g, others to %.2g or less for equal work', \
  limit('verlet'), others), \
  'An oscillator of frequency omega [1/s] with drag gamma [1/s]. White: '. \
  'bounded; colored: grows; gray: not measured; dots: bound by theory.')
set multiplot
eval "set palette defined (0 'white', 0.02 'white', ".viridis.")"
shade(g) = g > 1 ? log10(g) : -1
set cbrange [-0.02:1]
set cbtics ('1' 0, '2' log10(2), '5' log10(5), '10' 1) scale 0.5
unset key
unset grid
set xrange [0:2.6]
set yrange [0:2.4]
set xtics 1
set ytics 1
do for [k = 1:words(names)] {
  m = word(names, k)
  row = (k - 1) / 4
  col = (k - 1) % 4
  set lmargin at screen 0.065 + 0.218 * col
  set rmargin at screen 0.065 + 0.218 * col + 0.2
  set tmargin at screen row == 0 ? 0.84 : 0.44
  set bmargin at screen row == 0 ? 0.55 : 0.15
  set object 1 rectangle from graph 0, graph 0 to graph 1, graph 1 \
    fc rgb '#e8e8e8' fs solid noborder behind
  set title m.(evaluations(m) > 1 ? sprintf(' (%d force evaluations)', \
    evaluations(m)) : '') offset 0, -0.7 noenhanced font ',11'
  set xlabel row == 1 ? 'dt omega/evaluations' : '' offset 0, 0.4
  set ylabel col == 0 ? 'dt gamma/evaluations' : '' offset 0.5, 0
  set format y col == 0 ? '%g' : ''
  if (k == words(names)) {
    set colorbox user origin 0.945, 0.15 size 0.014, 0.69
    set label 4 "growth\nper step" at screen 0.985, 0.9 right font small
  } else {
    unset colorbox
  }
  if (0 == int(system(rows(sprintf('$1 == "%s" && $4 > 1.000001 {++n} END '. \
      '{print n + 0}', m))))) {
    set label 5 'stable everywhere here' at graph 0.5, 0.5 center front font ',11'
  }
  plot measured(m) using 1:2:(shade($3)) with image, \
       boundary(m) using 1:2 with points pt 7 ps 0.25 lc rgb 'black'
  unset label
}
unset multiplot
