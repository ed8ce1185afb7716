# What a linear system costs by conjugate gradients, by a Cholesky factor and by
# what the methods choose, against dt omega.
key = 0
key_is_method = 0
height = 470
load 'lab/charts/style.gp'

of(K, solver, tolerance) = sprintf("< awk -F, '$1 == \"%s\" && $4 == \"%s\" " \
  ."&& $5 == \"%s\"' %s", K, solver, tolerance, csv)
# The longest step, as dt omega, to which conjugate gradients to 1e-8 are as fast.
until(K) = real(system(sprintf("awk -F, '$1 == \"%s\" && $5 == \"1e-08\" ". \
  "{t[$4, $2] = $9; if ($4 == \"gradients\") s[$2]} END {for (x in s) ". \
  "if (t[\"gradients\", x] <= t[\"cholesky\", x] && x + 0 > m) m = x + 0; ". \
  "print m + 0}' %s", K, csv)))
least = until('10000')
do for [K in '1e+06 1e+08'] { if (until(K) < least) { least = until(K) } }
eval headline(sprintf('Conjugate gradients (10^{-8}) are faster than a '. \
  'Cholesky factor up to dt omega = %g', least), 'One linear system of '. \
  'implicit Euler, 100 x 100 nodes: median of five and their range. '. \
  '10^{-8}, 10^{-3}: relative residual. Light blue dips with its iterations.')
set multiplot
set logscale xy
set xrange [0.8:1e5]
set yrange [1:2000]
set format x '10^{%T}'
set format y '%g'
set tmargin at screen 0.8
set bmargin at screen 0.33
set xlabel 'dt omega'
set ylabel 'time of a solution [ms]' offset 1, 0
unset key
do for [k = 1:3] {
  K = word('10000 1e+06 1e+08', k)
  set title 'K [N/m] = '.word('10^4 10^6 10^8', k) offset 0, -0.6
  set lmargin at screen 0.09 + 0.305 * (k - 1)
  set rmargin at screen 0.36 + 0.305 * (k - 1)
  if (k == 2) { unset label; unset ylabel; set format y '' }
  if (k == 3) { set key at screen 0.62, screen 0.19 center top maxrows 2 \
    width -9 samplen 3 }
  plot \
    of(K, 'gradients', '1e-08') using 2:(1e3 * $9):(1e3 * $8):(1e3 * $10) \
      with yerrorlines lc rgb '#0072B2' pt 7 ps 0.5 lw 1.5 \
      title 'conjugate gradients to 10^{-8}', \
    of(K, 'gradients', '0.001') using 2:(1e3 * $9):(1e3 * $8):(1e3 * $10) \
      with yerrorlines lc rgb '#56B4E9' pt 5 ps 0.5 lw 1.5 dt 2 \
      title 'conjugate gradients to 10^{-3}', \
    of(K, 'automatic', '1e-08') using 2:(1e3 * $9) with points \
      lc rgb '#222222' pt 6 ps 1.2 lw 1.2 title 'automatic, to 10^{-8}', \
    of(K, 'automatic', '0.001') using 2:(1e3 * $9) with points \
      lc rgb '#009E73' pt 4 ps 1.2 lw 1.2 title 'automatic, to 10^{-3}', \
    of(K, 'cholesky', '1e-08') using 2:(1e3 * $9):(1e3 * $8):(1e3 * $10) \
      with yerrorlines lc rgb '#D55E00' pt 9 ps 0.5 lw 2.5 \
      title 'Cholesky factor'
}
unset multiplot
