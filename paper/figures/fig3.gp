# Figure 3: pathlines of the left disc from three heights, delta = 3h. Top: whole paths. Bottom left: next to the other
# disc, with contact forces (solid) and without (dashed). Bottom right: heights at the end over heights at the start. Where
# paths coincide all three are seen: those below are wider.
width = 8.5; height = 8
load "paper/figures/style.gp"
folder = results . "/fig3_pathlines/"
array height_of[3] = ["0.75", "0.755", "0.76"]
colour_of(k) = delta_colour[2 * k - 1]
width_of(k) = 3.9 - 1.1 * k
set print $ends
print "start_y,end_y"
do for [k = 1:3] {
  stats folder . "y" . height_of[k] . ".csv" using "end_y" nooutput
  print height_of[k] . "," . sprintf("%.6g", STATS_mean)
}
set print
set multiplot

set lmargin at screen 0.13
set rmargin at screen 0.98
set tmargin at screen 0.98
set bmargin at screen 0.63
set xrange [-8:22]
set yrange [0.73:1.04]
set xtics 4
set ytics 0.1
set format y "%.1f"
set xlabel "x of the left disc" offset 0,0.5
set ylabel "y" offset 0.5,0
set key top right
plot for [k = 1:3] folder . "y" . height_of[k] . "_trajectory.csv" \
         using "left_x":"left_y" with lines linewidth width_of(k) linecolor rgb colour_of(k) title "from y = " . height_of[k]

set tmargin at screen 0.48
set bmargin at screen 0.12
set rmargin at screen 0.52
set xrange [-1.5:1.5]
set yrange [0.97:1.035]
set xtics 1
set ytics 0.02
set format y "%.2f"
set ylabel "y" offset 1,0
unset key
plot for [k = 1:3] folder . "y" . height_of[k] . "_trajectory.csv" \
         using "free_left_x":"free_left_y" with lines dashtype 2 linewidth 0.8 linecolor rgb colour_of(k), \
     for [k = 1:3] folder . "y" . height_of[k] . "_trajectory.csv" \
              using "left_x":"left_y" with lines linewidth width_of(k) linecolor rgb colour_of(k)

set lmargin at screen 0.70
set rmargin at screen 0.98
set xrange [0.7475:0.7625]
set yrange [0.768:0.786]
set xtics 0.005 font ",6"
set ytics 0.005
set format y "%.3f"
set format x "%.3f"
set xlabel "y at the start"
set ylabel "y at the end" offset 0.5,0
set key top left Left reverse samplen 1
plot $ends \
         using "start_y":"end_y" \
         with linespoints linewidth 1.4 pointtype 7 pointsize 0.3 linecolor rgb marked_colour title "here", \
     reference . "/fig3_pathlines.csv" \
              using (case_of("end_y", "y", "")):(read_off("end_y")) \
              with points pointtype 6 pointsize 0.5 linecolor rgb published title "published"
unset multiplot
