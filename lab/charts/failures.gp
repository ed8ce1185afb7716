# How a method fails, and a cure, against time.
# Solid: what fails; dashed: the cure; dotted: further runs; gray: the truth.
key = 2
key_is_method = 1
height = 400
load 'lab/charts/style.gp'

axis = comment('axis '.scene)
logarithmic = int(word(axis, 4))
unit = axis[strlen(word(axis, 1).word(axis, 2).word(axis, 3).word(axis, 4)) + \
  5:*]
# The role, the method (- for the true motion) and the points of each run.
roles = system(rows('!seen[$4]++ {print $3}'))
methods = system(rows('!seen[$4]++ {print $2 == "" ? "-" : $2}'))
run(k, condition) = data(sprintf('$4 == %d && %s {print $5 "," $6}', k - 1, \
  condition))
lost(k) = data(sprintf( \
  '$4 == %d && $9 != "" {print $5 "," ($6 > %s ? %s : $6)}', \
  k - 1, word(axis, 3), word(axis, 3)))
label_of(k) = system(rows(sprintf( \
  '$4 == %d && $7 != "" {print $5 "," $6 " left offset 0.7," $8 "|" $7}', \
  k - 1)))
method(k) = word(methods, k)
role(k) = word(roles, k)
# A cure by the same method is of another color.
shade(k) = method(k) eq '-' ? '#777777' : \
  role(k) eq 'cure' && method(k) eq method(1) ? '#444444' : color(method(k))
dash_of(k) = role(k) eq 'fails' ? 1 : role(k) eq 'cure' ? 2 : 3
weight(k) = role(k) eq 'fails' ? 2.6 : 1.8
n = words(roles)

diverged = int(system(rows('$9 != "" {++n} END {print n + 0}')))
eval headline(scene.': '.comment('title '.scene), comment('caption '.scene). \
  (diverged ? '. Cross: the run diverged and was stopped.' : ''))
set tmargin 4.6
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
  set format y '1e%T'
}
set style textbox opaque noborder margins 0.4, 0.2
do for [k = 1:n] {
  text = label_of(k)
  bar = strstrt(text, '|')
  eval sprintf("set label %d '%s' at %s boxed front textcolor rgb '%s' ". \
    'noenhanced', k, text[bar + 1:*], text[1:bar - 1], shade(k))
}
plot for [k = 1:n] run(k, '$3 == "true"') using 1:2 with lines \
       lc rgb '#b8b8b8' lw 5, \
     for [k = 1:n] run(k, '$3 != "true"') using 1:2 with lines \
       lc rgb shade(k) dt dash_of(k) lw weight(k), \
     for [k = 1:n] lost(k) using 1:2 with points lc rgb shade(k) pt 2 \
       lw 2.2 ps 1.6
