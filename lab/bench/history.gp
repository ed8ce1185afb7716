# How the speed of a step went, from measurement to measurement.
#   gnuplot -e "csv='FILE.csv'; out='FILE.svg'; machine='NAME'" \
#     lab/bench/history.gp
set encoding utf8
set datafile separator ','
set terminal svg size 900,420 font 'DejaVu Sans,13' background '#ffffff'
set output out
commits = system("tail -n +2 ".csv." | cut -d, -f2 | uniq")
place(c) = sum [k = 1:words(commits)] (word(commits, k) eq c ? k : 0)
set xtics ()
do for [k = 1:words(commits)] { set xtics add (word(commits, k) k) }
set xrange [0.5:words(commits) + 0.5]
set yrange [0:*]
set grid ytics lc rgb '#dddddd'
set border 3
set tics nomirror
set key outside right top Left reverse samplen 3
set title '{/:Bold A step beside flat arrays}'
set label 1 machine at screen 0.98, 0.03 right font ',9' \
  textcolor rgb '#666666' noenhanced
set xlabel 'commit'
set ylabel 'time over that of the scalar loop'
of(real, nodes, step) = sprintf("< awk -F, '$3 == \"%s\" && $4 == \"%s\" && ".\
  "$5 == \"%s\" {print $2 \",\" $6}' %s", real, nodes, step, csv)
set style data linespoints
plot of('double', '10000', 'SymplecticEuler') \
       using (place(strcol(1))):2 lc rgb '#0072B2' pt 7 \
       title 'double, 10^4 nodes', \
     of('double', '1000000', 'SymplecticEuler') \
       using (place(strcol(1))):2 lc rgb '#0072B2' pt 6 dt 2 \
       title 'double, 10^6 nodes', \
     of('double', '10000', 'SymplecticEuler mixed') \
       using (place(strcol(1))):2 lc rgb '#D55E00' pt 9 \
       title 'double, 10^4 mixed', \
     of('float', '10000', 'SymplecticEuler') \
       using (place(strcol(1))):2 lc rgb '#009E73' pt 5 \
       title 'float, 10^4 nodes', \
     of('float', '1000000', 'SymplecticEuler') \
       using (place(strcol(1))):2 lc rgb '#009E73' pt 4 dt 2 \
       title 'float, 10^6 nodes'
