# What adviser_suite found: predicted against real error, and chosen against
# best cost, a dot a scene that got advice.
#   gnuplot -e "csv='FILE.csv'; out='FILE.svg'" lab/advice/adviser.gp
set encoding utf8
set datafile separator ','
set terminal svg size 1000,480 font 'DejaVu Sans,13' background '#ffffff'
set output out
set multiplot layout 1,2
set logscale xy
set format xy '10^{%L}'
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set key top left Left reverse samplen 2
advised = "< awk -F, '!/^#/ && $8 > 0' ".csv
set title '{/:Bold Error over tolerance}'
set xlabel 'predicted'
set ylabel 'real'
set xrange [1e-3:3]
set yrange [1e-6:30]
plot 1 lc rgb '#D55E00' lw 2 title 'the tolerance', \
     x lc rgb '#999999' dt 2 title 'real as predicted', \
     advised using ($5/$3):($7/$3 < 1e-6 ? 1e-6 : $7/$3) with points pt 7 \
       ps 0.6 lc rgb '#0072B2' notitle
set title '{/:Bold Work: spring evaluations}'
set xlabel 'best choice in hindsight'
set ylabel 'chosen'
set autoscale xy
plot x lc rgb '#999999' dt 2 title 'the same', \
     1.5*x lc rgb '#D55E00' lw 2 title '1.5 times as much', \
     advised using 9:8 with points pt 7 ps 0.6 lc rgb '#0072B2' notitle
