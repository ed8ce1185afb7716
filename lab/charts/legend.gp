# After the last panel of a multiplot: the legend. Given: names, and entries, a
# list of further ones, "marker|color|text" with _ for blanks, separated by
# blanks.
unset object
unset label
unset arrow
unset logscale
unset border
unset tics
unset grid
unset xlabel
unset ylabel
unset key
unset title
set lmargin at screen 0
set rmargin at screen 1
set tmargin at screen 1
set bmargin at screen 0
set xrange [0:1]
set yrange [0:1]
do for [k = 1:words(names)] {
  m = word(names, k)
  set arrow k from legend_x(k), legend_y(k) to legend_x(k) + 0.04, \
    legend_y(k) nohead lc rgb color(m) dt dash(m) lw 1.6
  set label 2 * k - 1 '' at legend_x(k) + 0.02, legend_y(k) \
    point pt marker(m) ps 0.9 lc rgb color(m)
  set label 2 * k m at legend_x(k) + 0.05, legend_y(k) noenhanced
}
do for [i = 1:words(entries)] {
  k = words(names) + i
  entry = word(entries, i)
  bar = strstrt(entry, '|')
  second = bar + strstrt(entry[bar + 1:*], '|')
  shade = entry[bar + 1:second - 1]
  set label 2 * k - 1 '' at legend_x(k) + 0.02, legend_y(k) \
    point pt int(entry[1:bar - 1]) ps (entry[1:bar - 1] eq '6' ? 2 : 1) \
    lc rgb shade lw 1.5
  caption = ''
  rest = entry[second + 1:*].'_'
  while (strlen(rest) > 0) {
    caption = caption.' '.rest[1:strstrt(rest, '_') - 1]
    rest = rest[strstrt(rest, '_') + 1:*]
  }
  set label 2 * k caption[2:*] at legend_x(k) + 0.05, legend_y(k) noenhanced
}
set label 1000 footer at 0.985, 0.025 right font small \
  textcolor rgb '#666666' noenhanced
plot NaN notitle
unset multiplot
