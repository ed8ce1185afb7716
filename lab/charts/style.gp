# What the charts share that gnuplot draws by a script. Given: csv, the file of
# data; scene, or '' for all rows of csv; out; height; key, the column of csv
# that names the method, and key_is_method, 0 if it names something else.
# Makes: names, the methods in csv, in the order of lab/charts/methods.csv;
# stops if one of them is not in that table.
width = 800
load 'lab/charts/terminal.gp'
table = 'lab/charts/methods.csv'
column_of(k) = \
  system(sprintf("grep -v '^#' %s | cut -d, -f%d | tr '\\n' ' '", table, k))
in_table = column_of(1)
colors = column_of(2)
per_step = column_of(4)
index_in(list, name) = \
  sum [k = 1:words(list)] (word(list, k) eq name ? k : 0)
# An empty list of methods is still asked for the style of ''.
color(m) = m eq '' ? '#000000' : word(colors, index_in(in_table, m))
evaluations(m) = int(word(per_step, index_in(in_table, m)))

# awk on the rows of the scene, as a command and as data.
rows(program) = sprintf("awk -F, '/^#/ || !head++ {if (!/^#/) next} ".\
  "!/^#/ && (\"%s\" == \"\" || $1 == \"%s\") && %s' %s", \
  scene, scene, program, csv)
data(program) = '< '.rows(program)
comment(what) = \
  system(sprintf("sed -n 's/^# %s: //p' %s | head -n 1", what, csv))
footer = strlen(comment('commit')) ? comment('machine').'; '. \
  comment('compiler').'; commit '.comment('commit') : \
  system(sprintf("sed -n 's/^# //p' %s | head -n 1", csv))

# eval headline(MESSAGE, ABOUT): what the chart says, of what it says so, and
# in the corner by what it was measured.
headline(message, about) = sprintf( \
  "set label 901 \"{/:Bold=15 %s}\" at screen %g, screen %g left front; ". \
  "set label 902 \"%s\" at screen %g, screen %g left front ". \
  "font ',11' textcolor rgb '#666666'; ". \
  "set label 903 \"%s\" at screen %g, screen %g right front ". \
  "font ',11' textcolor rgb '#666666' noenhanced", \
  message, 20. / width, 1 - 22. / height, \
  about, 20. / width, 1 - 43. / height, \
  footer, 1 - 15. / width, 14. / height)

there = key > 0 ? system(rows(sprintf("!seen[$%d]++ {print $%d}", key, key))) \
  : 'none'
if (words(there) == 0) { exit error csv.': no rows of '.scene }
names = ''
do for [m in in_table] {
  if (index_in(there, m) > 0) { names = names.' '.m }
}
do for [m in there] {
  if (key_is_method && index_in(in_table, m) == 0) {
    exit error csv.': '.m.' has no line in '.table
  }
}
