# Growth of a tiny disturbance against stretch and step, a panel for a method.
key = 1
key_is_method = 1
height = 560
load 'lab/charts/style.gp'
load 'lab/charts/palette.gp'

# Columns: 1 method, 2 stretch, 3 dt/safe, 4 predicted limit/safe, 5 growth.
growth(m) = data(sprintf('$1 == "%s" {print $2 "," $3 "," $5}', m))
limit(m) = data(sprintf('$1 == "%s" && !seen[$2]++ {print $2 "," $4}', m))
least = 0.005
shade(g) = g > least ? log10(g) : -9

eval headline('The predicted limit is where disturbances begin to grow', \
  'A tiny disturbance of a stretched sheet. Line: the predicted limit; '. \
  'dashed: the safe one. Left of 1 the sheet buckles.')
set multiplot
eval "set palette defined (0 'white', 0.05 'white', ".viridis.")"
set cbrange [log10(least) - 0.05 * (log10(3) - log10(least)) / 0.95:log10(3)]
set cbtics ('1.01' log10(log(1.01)), '1.1' log10(log(1.1)), \
  '1.5' log10(log(1.5)), '3' log10(log(3)), '10' log10(log(10))) scale 0.5
unset key
unset grid
set xrange [0.9:2.5]
set yrange [0.5:2]
set xtics 1, 0.5, 2
set ytics 0.5
left = 0.085
step_x = 0.28
do for [k = 1:words(names)] {
  m = word(names, k)
  row = (k - 1) / 3
  col = (k - 1) % 3
  set lmargin at screen left + step_x * col
  set rmargin at screen left + step_x * col + 0.25
  set tmargin at screen row == 0 ? 0.83 : 0.43
  set bmargin at screen row == 0 ? 0.53 : 0.13
  set title m offset 0, -0.6 noenhanced
  set xlabel row == 1 ? 'length/rest length' : '' offset 0, 0.4
  set ylabel col == 0 ? 'dt/(safe dt)' : '' offset 0.5, 0
  set format y col == 0 ? '%g' : ''
  if (k == words(names)) {
    set colorbox user origin 0.93, 0.12 size 0.014, 0.72
    set label 4 "growth\nper step" at screen 0.99, 0.9 right font small
  } else {
    unset colorbox
  }
  set label 3 'buckles' at 0.945, 0.75 center rotate by 90 font small \
    textcolor rgb 'white' front
  set label 5 'grows' at 1.75, 1.75 center textcolor rgb 'white' front
  set label 6 'bounded' at 1.75, 0.75 center front
  plot growth(m) using 1:2:(shade($3)) with image, \
       limit(m) using 1:2 with lines lc rgb 'white' lw 5, \
       limit(m) using 1:2 with lines lc rgb 'black' lw 2, \
       1 with lines lc rgb '#555555' dt 2 lw 1
  unset label
}
unset multiplot
