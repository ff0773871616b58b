# Figure 4: the Taylor-Green suspension at t = 0, 15, 30, and the path of the coloured body for three time steps, with
# dots where a contact force acts on it.
width = 8.5; height = 8.8
load "paper/figures/style.gp"
folder = results . "/fig4_taylor_green/"
a = 0.475; b = 0.1
colour_of(marked, contact) = marked == 1 ? marked_colour : contact == 1 ? contact_colour : body_colour
at(t) = abs(column("time") - t) < 0.02 ? column("x") : NaN
array time_step[3] = ["0.025", "0.0125", "0.00625"]
set multiplot

set size ratio -1
set xrange [-2.7:2.7]
set yrange [-2.7:2.7]
@no_axes
array left[3] = [0.01, 0.51, 0.01]
array bottom[3] = [0.5, 0.5, 0.0]
do for [k = 1:3] {
  t = 15 * (k - 1)
  set lmargin at screen left[k]
  set rmargin at screen left[k] + 0.48
  set bmargin at screen bottom[k] + 0.01
  set tmargin at screen bottom[k] + 0.49
  set label 1 sprintf("t = %d", t) at graph 0.03, 0.95
  plot folder . "dt0.025_snapshots.csv" \
           using (at(t)):"y":(2*a):(2*b):(column("theta") * degrees):(colour_of(column("coloured"), column("in_contact"))) \
           with ellipses linecolor rgb variable notitle
}

unset label 1
set border
set xtics 1 nomirror
set ytics 1 nomirror
set xlabel "x" offset 0,0.8
set ylabel "y" offset 0.3,0
set lmargin at screen 0.60
set rmargin at screen 0.985
set bmargin at screen 0.085
set tmargin at screen 0.46
set xrange [-1.7:1.7]
set yrange [-1.7:1.7]
unset key
set label 2 "Δt" at screen 0.6, screen 0.483
array place[3] = [0.65, 0.745, 0.858]
do for [k = 1:3] {
  set label 2 + k time_step[k] at screen place[k], screen 0.483 textcolor rgb step_colour[k]
}
plot for [k = 1:3] folder . "dt" . time_step[k] . "_track.csv" \
         using "x":"y" with lines linewidth 1 linecolor rgb step_colour[k], \
     for [k = 1:3] folder . "dt" . time_step[k] . "_track.csv" \
              using (column("in_contact") == 1 ? column("x") : NaN):"y" \
              with points pointtype 7 pointsize 0.2 linecolor rgb step_colour[k] notitle
unset multiplot
