# Error against time and against force evaluations, our methods and the peers':
#   gnuplot -e "csv='FILE.csv'; out='FILE.svg'" lab/bench/peers/chart.gp
# Ours are solid, the libraries' dashed.
set encoding utf8
set datafile separator ','
ours = 'symplectic-euler verlet pefrl srkn6b srkn11b'
ours_color = '#000000 #0072B2 #D55E00 #009E73 #CC79A7'
ours_marker = '5 7 13 11 15'
theirs = 'odeint-verlet odeint-m4 odeint-dopri5 gsl-rk8pd gsl-msadams arkode-dopri cvode-adams cvode-bdf cvode-bdf2'
theirs_color = '#009E73 #E69F00 #E69F00 #56B4E9 #56B4E9 #000000 #0072B2 #D55E00 #CC79A7'
theirs_marker = '3 4 6 8 10 12 14 1 2'
of(m) = sprintf("< awk -F, '$1 == \"%s\" && $8 == \"ok\"' %s | sort -t, -k3,3n", m, csv)
floor = system(sprintf("awk -F, '$8 == \"ok\" {print $7; exit}' %s", csv)) + 0
footer = system(sprintf("sed -n 's/^# //p' %s", csv))

set terminal svg size 1000,620 dynamic background rgb 'white' \
  font 'DejaVu Sans,Arial,sans-serif,13'
set output out
set multiplot
set border 3 lc rgb '#555555'
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1 dt 1
set logscale xy
set format '10^{%T}'
set yrange [1e-12:1e-1]
set object 1 rect from graph 0, first 1e-12 to graph 1, first 10 * floor \
  fc rgb '#dddddd' fs solid noborder behind
set tmargin at screen 0.89
set bmargin at screen 0.32
set label 1 'grid1 with diagonals, t = 0.25 s: our methods and those of odeint, SUNDIALS, GSL' \
  at screen 0.5, screen 0.965 center
set label 2 footer at screen 0.99, screen 0.015 right textcolor rgb '#777777'
unset key
set lmargin at screen 0.115
set rmargin at screen 0.53
set xlabel 'force evaluations'
set ylabel 'RMS error of the positions [m]'
plot for [k = 1:words(ours)] of(word(ours, k)) using 3:6 with linespoints \
       lc rgb word(ours_color, k) pt int(word(ours_marker, k)) ps 0.7 lw 1.5, \
     for [k = 1:words(theirs)] of(word(theirs, k)) using 3:6 with linespoints \
       lc rgb word(theirs_color, k) pt int(word(theirs_marker, k)) ps 0.7 lw 1.5 dt 2
unset label 1
unset label 2
set lmargin at screen 0.58
set rmargin at screen 0.98
set xlabel 'seconds, least of the repeats'
unset ylabel
set format y ''
set key at screen 0.52, screen 0.21 center top maxrows 4 width -2 samplen 3
plot for [k = 1:words(ours)] of(word(ours, k)) using 4:6 with linespoints \
       lc rgb word(ours_color, k) pt int(word(ours_marker, k)) ps 0.7 lw 1.5 \
       title word(ours, k), \
     for [k = 1:words(theirs)] of(word(theirs, k)) using 4:6 with linespoints \
       lc rgb word(theirs_color, k) pt int(word(theirs_marker, k)) ps 0.7 lw 1.5 dt 2 \
       title word(theirs, k)
unset multiplot
