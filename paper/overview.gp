# The picture of the README, from the results of two of the cases, in the package's folder:
#   build/simulate experiments/cases/drop.txt
#   build/simulate experiments/cases/ring.txt fields_at=2 field_points=240
#   gnuplot paper/overview.gp
set terminal pngcairo size 1000,450 font "DejaVu Sans,11"
set output "paper/overview.png"
set multiplot
set size ratio -1
unset key; unset tics; unset colorbox; unset border
set style fill solid 0.9 border lc rgb "#222222"
set datafile separator ","
set palette defined (0 "#ffffff", 0.25 "#c6dbef", 0.6 "#6baed6", 1 "#08519c")

# Columns of the bodies' file, then those of trajectory.csv at one step.
drop(step) = "< tail -n +2 experiments/cases/drop_bodies.csv > results/cases/a.csv; grep '^".step.",' results/cases/drop/trajectory.csv | paste -d, results/cases/a.csv -"
set lmargin at screen 0.01; set rmargin at screen 0.54
set xrange [-5.7:5.7]
do for [k = 0:1] {
  set tmargin at screen k == 0 ? 0.92 : 0.46
  set bmargin at screen k == 0 ? 0.48 : 0.02
  set yrange [-2.3:2.3]
  set title k == 0 ? "a dense drop in an extension, t = 0 and 1" : ""
  plot drop(50 * k) using 9:10:(2*$1):(2*$2):($11*180/pi) with ellipses units xx fc rgb "#d95f02"
}

ring(lines) = "< tail -n +2 experiments/cases/ring_bodies.csv > results/cases/a.csv; grep '^100,' results/cases/ring/trajectory.csv | head -18 | paste -d, results/cases/a.csv - | ".lines
set lmargin at screen 0.56; set rmargin at screen 0.99; set tmargin at screen 0.92; set bmargin at screen 0.02
set xrange [-3.6:3.6]; set yrange [-3.6:3.6]; set cbrange [0:3]
set title "discs that injected fluid presses into a ring, and its speed"
plot "results/cases/ring/fields_2.csv" every ::1 using 1:2:($9 == 0 ? sqrt($3**2 + $4**2) : NaN) with image, \
     ring("head -12") using 10:11:(2*$1):(2*$2):(0) with ellipses units xx fc rgb "#888888", \
     ring("tail -6") using 10:11:(2*$1):(2*$2):(0) with ellipses units xx fc rgb "#d95f02", \
     "+" every ::0::0 using (0):(0):(0.5) with circles fc rgb "#444444"
