# Where an oscillator with drag is stable: the boundary of each method. Both axes
# are divided by the force evaluations of a step: equal distances are equal
# work.
key = 1
key_is_method = 1
height = 470
load 'lab/charts/style.gp'

# Columns: 1 method, 2 dt omega, 3 dt gamma, 4 measured, empty on the boundary.
boundary(m) = data(sprintf('$1 == "%s" && $4 == "" {print $2 / %d "," '. \
  '$3 / %d}', m, evaluations(m), evaluations(m)))
# Where growth begins with next to no drag, by theory; of two the least.
limit(m) = real(system(rows(sprintf('$1 == "%s" && $4 == "" && $3 < 0.02 && '. \
  '(!x || $2 < x) {x = $2} END {print x + 0}', m)))) / evaluations(m)
others = 0
do for [m in names] {
  if (evaluations(m) > 1 && limit(m) > others) {
    others = limit(m)
  }
}
eval headline(sprintf('For equal work verlet is stable to dt omega = %.2g, '. \
  'higher orders to %.2g or less', limit('verlet'), others), \
  'An oscillator of frequency omega [1/s] with drag gamma [1/s]. A method is '. \
  "stable on the origin's side of its line.")
set tmargin at screen 0.86
set bmargin at screen 0.17
set lmargin at screen 0.09
set rmargin at screen 0.97
unset key
set xrange [0:2.6]
set yrange [0:2.4]
set xlabel 'dt omega/(force evaluations of a step)'
set ylabel 'dt gamma/(force evaluations of a step)'
set label 1 'verlet' at 2.25, 1.4 left textcolor rgb color('verlet')
set label 2 'symplectic-euler' at 0.1, 1.84 left \
  textcolor rgb color('symplectic-euler')
set label 3 'forward-euler: between its lines' at 1.36, 1.6 left \
  textcolor rgb color('forward-euler')
set label 4 'rk4' at 0.22, 0.87 left textcolor rgb color('rk4')
set label 5 'yoshida4' at 0.51, 0.35 right textcolor rgb color('yoshida4')
set label 6 'srkn6b' at 0.87, 0.3 left textcolor rgb color('srkn6b')
set label 7 'pefrl: not in the arch' at 0.9, 0.07 left \
  textcolor rgb color('pefrl')
set label 8 'implicit-euler: everywhere' at 1.62, 2.3 left \
  textcolor rgb color('implicit-euler')
plot for [m in names] boundary(m) using 1:2 with points pt 7 ps 0.3 \
  lc rgb color(m)
