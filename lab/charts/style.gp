# What all charts share. Given: csv, the file of data; height [pixels], and
# width if it is not 1000; out, the file to write, an SVG; scene, or '' for all
# rows of csv; key, the column of csv that names the method, and key_is_method,
# 0 if it names something else. Makes: names, the methods in csv, in the order
# of lab/charts/methods.csv; stops if one of them is not in that table.
set encoding utf8
set datafile separator ','
table = 'lab/charts/methods.csv'
column_of(k) = \
  system(sprintf("grep -v '^#' %s | cut -d, -f%d | tr '\\n' ' '", table, k))
in_table = column_of(1)
colors = column_of(2)
markers = column_of(3)
dashes = column_of(4)
index_in(list, name) = \
  sum [k = 1:words(list)] (word(list, k) eq name ? k : 0)
# An empty list of methods is still asked for the style of ''.
color(m) = m eq '' ? '#000000' : word(colors, index_in(in_table, m))
marker(m) = m eq '' ? 0 : int(word(markers, index_in(in_table, m)))
dash(m) = m eq '' ? 1 : int(word(dashes, index_in(in_table, m)))

# awk on the rows of the scene, as a command and as data.
rows(program) = sprintf("awk -F, '/^#/ || !head++ {if (!/^#/) next} ".\
  "!/^#/ && (\"%s\" == \"\" || $1 == \"%s\") && %s' %s", \
  scene, scene, program, csv)
data(program) = '< '.rows(program)
comment(what) = \
  system(sprintf("sed -n 's/^# %s: //p' %s | head -n 1", what, csv))
footer = comment('machine').'; '.comment('compiler').'; commit '.\
  comment('commit')

there = system(rows(sprintf("!seen[$%d]++ {print $%d}", key, key)))
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

if (!exists('width')) { width = 1000 }
set terminal svg size width,height dynamic background rgb 'white' \
  font 'DejaVu Sans,Arial,sans-serif,13'
set output out
set border 3 lw 1 lc rgb '#555555'
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set grid xtics ytics lc rgb '#e4e4e4' lw 1 dt 1
set dashtype 2 (10, 4)
set dashtype 3 (2, 4)
small = ',10'
set dashtype 4 (8, 3, 2, 3)

# A legend drawn by hand, as gnuplot's own can't be held in columns: entry k
# goes to column (k - 1)/rows of the lower part of the picture.
legend_rows = 4
legend_width = 0.198
legend_left = 0.025
legend_top = 0.235
legend_x(k) = legend_left + legend_width * int((k - 1) / legend_rows)
legend_y(k) = legend_top - 0.042 * ((k - 1) % legend_rows)
