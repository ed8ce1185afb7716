# How a method fails, and a cure, against time.
#   gnuplot -e "csv='charts/failures.csv'; scene='verlet'; \
#     out='charts/failure-verlet'; kind='svg'" charts/failures.gp
# Solid: what fails; dashed: the cure; dotted: further runs; gray: the truth.
key = 2
key_is_method = 1
width = 720
height = 380
load 'charts/style.gp'

axis = comment('axis '.scene)
logarithmic = int(word(axis, 4))
unit = axis[strlen(word(axis, 1).word(axis, 2).word(axis, 3).word(axis, 4)) + \
  5:*]
first(k, what) = system(rows(sprintf('$4 == "%s" {print %s; exit}', k, what)))
labeled(k, what) = \
  system(rows(sprintf('$4 == "%s" && $7 != "" {print %s; exit}', k, what)))
count(k) = int(system(rows(sprintf('$4 == "%s" {++n} END {print n}', k))))
run(k) = data(sprintf('$4 == "%s" {print $5 "," $6}', k))
lost(k) = data(sprintf( \
  '$4 == "%s" && $9 != "" {print $5 "," ($6 > %s ? %s : $6)}', \
  k, word(axis, 3), word(axis, 3)))
true_runs = system(rows('$3 == "true" && !seen[$4]++ {print $4}'))
runs = system(rows('$3 != "true" && !seen[$4]++ {print $4}'))
role(k) = first(k, '$3')
shade(k) = role(k) eq 'true' ? '#777777' : color(first(k, '$2'))
dashes_of(k) = role(k) eq 'fails' ? 1 : role(k) eq 'cure' ? 2 : 3
weight(k) = role(k) eq 'fails' ? 2.6 : 1.8

set title '{/:Bold '.scene.'}: '.comment('title '.scene).\
  "\n{".(kind eq 'svg' ? '/=11' : '/=15').' '.comment('caption '.scene).'}' \
  offset 0, -0.3
unset key
set lmargin 11
set rmargin 3
set bmargin 4.6
set xlabel 'time [s]' offset 0, 0.3
set ylabel unit offset 0.5, 0
# real('1e-06') is refused.
eval sprintf('set xrange [0:%s]', word(axis, 1))
eval sprintf('set yrange [%s:%s]', word(axis, 2), word(axis, 3))
if (logarithmic) {
  set logscale y
  set format y '10^{%T}'
}
set style textbox opaque noborder margins 0.4, 0.2
do for [k in true_runs.' '.runs] {
  eval sprintf("set label %d '%s' at %s left offset 0.7, %s boxed front ". \
    "textcolor rgb '%s' noenhanced", k + 1, labeled(k, '$7'), \
    labeled(k, '$5 "," $6'), labeled(k, '$8'), shade(k))
}
set label 100 footer at screen 0.985, 0.035 right font small \
  textcolor rgb '#666666' noenhanced
plot for [k in true_runs] run(k) using 1:2 with lines lc rgb '#b8b8b8' lw 5, \
     for [k in runs] run(k) using 1:2 with linespoints lc rgb shade(k) \
       pt marker(first(k, '$2')) ps 0.8 pi 1 + count(k) / 12 \
       dt dashes_of(k) lw weight(k), \
     for [k in runs] lost(k) using 1:2 with points lc rgb shade(k) pt 2 \
       lw 2.2 ps 1.6
