# Figure 2: two discs in shear. Top: start and path of the left disc without contact forces. Bottom left: its height
# above the other disc for several minimum separations. Bottom right: its final displacement.
width = 8.5; height = 8
load "paper/figures/style.gp"
folder = results . "/fig2_shear_separation/"
array separation[5] = ["0", "2", "2.1", "2.5", "3"]
set print $ends
print "separation_over_h,displacement"
do for [d in "0 1 2 2.1 2.5 2.75 3"] {
  stats folder . "delta" . d . "h.csv" using "displacement" nooutput
  print d . "," . sprintf("%.6g", STATS_mean)
}
set print
# Of the cases delta2h and published_2h.
separation_of(name) = between(name, substr(name, 1, 5) eq "delta" ? "delta" : "published_", "h")
set multiplot

set size ratio -1
set lmargin at screen 0.12
set rmargin at screen 0.98
set tmargin at screen 0.985
set bmargin at screen 0.80
set xrange [-9:9]
set yrange [-1.2:2.4]
set xtics 4
set ytics 1
set xlabel "x" offset 0,0.8
set ylabel "y" offset 0.5,0
set key top right
plot folder . "delta0h_trajectory.csv" \
         using "left_x":"left_y" with lines linewidth 1.5 linecolor rgb marked_colour title "no contact forces", \
     "" using (column("time") == 0 ? column("left_x") : NaN):(column("left_y")):(0.5) \
              with circles linecolor rgb marked_colour notitle, \
     "" using (column("time") == 0 ? column("right_x") : NaN):(column("right_y")):(0.5) \
              with circles linecolor rgb body_colour notitle

set size noratio
set tmargin at screen 0.67
set bmargin at screen 0.12
set rmargin at screen 0.51
set xrange [-8:8]
set yrange [0.45:1.4]
set ytics 0.2
set format y "%.1f"
set xlabel "x of the left disc" offset 0,0.3
set ylabel "y_{left} − y_{right}" offset 0.5,0
set key at graph 1.035, graph 0.98 top right samplen 0.6 Left reverse font ",6"
plot for [k = 1:5] folder . "delta" . separation[k] . "h_trajectory.csv" \
         using "left_x":"difference_y" \
         with lines linewidth 1.4 linecolor rgb delta_colour[k] \
         title "δ = " . separation[k] . (separation[k] eq "0" ? "" : "h")

set lmargin at screen 0.68
set rmargin at screen 0.98
set xrange [-0.15:3.15]
set yrange [0.055:0.175]
set xtics 1
set ytics 0.02
set format y "%.2f"
set xlabel "δ/h"
set ylabel "displacement" offset 0.8,0
set key inside top left font ",7"
plot $ends \
         using "separation_over_h":"displacement" \
         with linespoints linewidth 1.4 pointtype 7 pointsize 0.3 linecolor rgb marked_colour title "here", \
     reference . "/fig2_shear_separation.csv" \
              using (is_read_off("displacement") ? separation_of(strcol("case")) : NaN):(read_off("displacement")) \
              with points pointtype 6 pointsize 0.5 linecolor rgb published title "published"
unset multiplot
