# The look of all charts. Given: out, the file to write, an SVG; width and
# height [pixels].
set encoding utf8
set datafile separator ','
set terminal svg size width,height dynamic background rgb 'white' \
  font 'DejaVu Sans,Arial,sans-serif,12'
set output out
set border 3 lw 1 lc rgb '#555555'
set tics nomirror out scale 0.5 textcolor rgb '#222222'
set grid xtics ytics back lc rgb '#eeeeee' lw 1 dt 1
set dashtype 2 (10, 4)
set dashtype 3 (2, 4)
set style textbox opaque noborder margins 0.3, 0.1 fillcolor rgb 'white'
small = ',11'
