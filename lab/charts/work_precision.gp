# Error against work for one scene: force sweeps at the left, time at the right.
#   gnuplot -e "csv='FILE.csv'; scene='grid1'; out='grid1.svg'" \
#     lab/charts/work_precision.gp
key = 2
key_is_method = 1
height = 640
load 'lab/charts/style.gp'

# Columns: 5 dt/limit, 7 sweeps, 9 median of seconds, 10 error, 11 floor,
# 13 status, 14 reason. col is 7 or 9.
of(m, condition, col) = data(sprintf( \
  '$2 == "%s" && %s {print $%d "," $10}', m, condition, col))
good(m, col) = of(m, '$13 == "ok" && $10 >= 10 * $11', col)
grey(m, col) = of(m, '$13 == "ok" && $10 < 10 * $11', col)
largest(m, col) = of(m, '$13 == "ok" && $5 > 0 && $5 <= 1 && !n++', col)
# A failed run stands where its sweeps would be; its time would be that of the
# method's other runs, a sweep.
failed(m, col, status) = data(sprintf( \
  '$2 == "%s" {if ($13 == "ok") {a += $9; b += $7} '. \
  'else if ($13 == "%s") s[++n] = $7} END {for (k = 1; k <= n; ++k) ' . \
  'print %s "," %g}', m, status, col == 7 ? 's[k]' : 's[k] * a / b', \
  top * 10 ** (0.1 * index_in(names, m))))
# The methods that have such a row.
with(condition) = \
  system(rows('('.condition.') && !seen[$2]++ {print $2}'))
timed(condition) = system(rows('$13 == "ok" {t[$2] = 1} '.condition. \
  ' {f[$2] = 1} END {for (m in f) if (t[m]) print m}'))
number(program) = real('0'.system(rows(program)))

floor_at = number('!n++ {print $11}')
norm = system(rows('!n++ {print $12}'))
# The floor of single precision, in a file beside csv.
single_csv = csv[1:strlen(csv) - strlen('work_precision.csv')].'float_floor.csv'
single = system(sprintf("sed -n 's/e-0/e-/; ".\
  "s/^# single precision floor %s: //p' %s", scene, single_csv))
eval 'single_at = '.(strlen(single) ? word(single, 1) : '0')
worst = number('$13 == "ok" && $10 > e {e = $10} END {print e}')
bottom = 10 ** floor(log10(floor_at) - 0.3)
top = 10 ** (ceil(log10(worst > 1e3 ? 1e3 : worst)) + 0.2)
about = comment('scene '.scene)
about = about[1:strstrt(about, '; error:') - 1]
why = system(rows('$13 == "failed" {sub(/^[^:]*: /, "", $14); '. \
  'sub(/ (takes|does|is|left|after|;|at t) .*/, "", $14); '. \
  'sub(/.s method/, "", $14); gsub(/ /, "_", $14); print $14}').' | sort -u | head -n 1')
believed = with('$13 == "ok" && $10 >= 10 * $11')
disbelieved = with('$13 == "ok" && $10 < 10 * $11')
stable = with('$13 == "ok" && $5 > 0 && $5 <= 1')
diverged = with('$13 == "diverged"')
stopped = with('$13 == "failed"')
diverged_timed = timed('$13 == "diverged"')
stopped_timed = timed('$13 == "failed"')

set multiplot
set label 1 '{/:Bold '.scene.'}: '.about at screen 0.5, 0.965 center
set logscale xy
set format '10^{%T}'
set yrange [bottom:top * 30]
set tmargin at screen 0.925
set bmargin at screen 0.35
unset key
set object 1 rectangle from graph 0, first bottom to graph 1, \
  first 10 * floor_at fc rgb '#ececec' fs solid noborder behind
do for [panel = 1:2] {
  col = panel == 1 ? 7 : 9
  if (panel == 1) {
    set lmargin at screen 0.085
    set rmargin at screen 0.515
    set xlabel 'force sweeps (solving systems not counted)' offset 0, 0.3
    set ylabel 'error: '.norm.' [m]' offset 1, 0
  } else {
    set lmargin at screen 0.56
    set format y ''
    set rmargin at screen 0.98
    set xlabel 'time of a run [s], median' offset 0, 0.3
    unset ylabel
    unset label 1
  }
  set label 4 'within 10 floors: not to be believed' \
    at graph 0.01, first 10 * floor_at left \
    offset 0, -0.7 font small textcolor rgb '#666666' front
  if (single_at > 0) {
    set arrow 5 from graph 0, first single_at to graph 1, first single_at \
      nohead lc rgb '#555555' dt 3 lw 1.4
    # Below its line, unless that of the floor is there.
    set label 5 panel == 1 ? 'single precision: '.single : '' \
      at graph 0.01, first single_at left \
      offset 0, (single_at > 2 * floor_at ? -0.7 : 0.5) \
      font small textcolor rgb '#333333' front
  }
  diverged_there = col == 7 ? diverged : diverged_timed
  failed_there = col == 7 ? stopped : stopped_timed
  plot for [m in believed] good(m, col) using 1:2 with linespoints \
         lc rgb color(m) pt marker(m) dt dash(m) lw 1.6 ps 0.8, \
       for [m in disbelieved] grey(m, col) using 1:2 with points \
         lc rgb '#aaaaaa' pt marker(m) ps 0.7, \
       for [m in stable] largest(m, col) using 1:2 with points \
         lc rgb color(m) pt 6 lw 1.4 ps 2, \
       for [m in diverged_there] failed(m, col, 'diverged') using 1:2 \
         with points lc rgb color(m) pt 2 lw 1.8 ps 0.9, \
       for [m in failed_there] failed(m, col, 'failed') using 1:2 \
         with points lc rgb color(m) pt 1 lw 1.8 ps 1.1, \
       floor_at with lines lc rgb '#777777' dt 2 lw 1.2
}
entries = '6|#222222|largest_stable_step 2|#222222|diverged 1|#222222|'. \
  (strlen(why) ? why : 'step').'_fails'.' 7|#aaaaaa|within_10_floors'
load 'lab/charts/legend.gp'
