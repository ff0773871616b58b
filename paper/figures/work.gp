# Work against error: Table 1's run with forward Euler and with higher orders, without contact and with a separation of 3h.
width = 8.5; height = 7
load "paper/figures/style.gp"
table = results . "/reversal/table.csv"
array label[5] = ["euler", "ab2", "rk3", "midpoint", "rk3, by error"]
array colour[5] = ["#000000", "#5577cc", "#ddaa33", "#aa3377", "#228833"]
array marker[5] = [6, 4, 8, 12, 10]
chosen(scheme, separation, by_error) = column("scheme") == scheme && column("separation_over_h") == separation && \
                                       (column("tolerance") > 0) == by_error
set logscale xy
set format y "10^{%T}"
set xrange [2e2:3e4]
set yrange [1e-7:1]
set ylabel "distance of the error from its limit" offset 1,0
set multiplot
set tmargin at screen 0.94
set bmargin at screen 0.30
do for [panel = 0:1] {
  separation = panel == 0 ? 0 : 3
  set lmargin at screen 0.13 + 0.45 * panel
  set rmargin at screen 0.55 + 0.43 * panel
  if (panel == 1) { set format y ""; unset ylabel }
  set xlabel "Stokes problems solved"
  set title (panel == 0 ? "without contact" : "with contact, δ = 3h") offset 0,-0.8
  if (panel == 0) { unset key } else { set key at screen 0.98,0.15 top right samplen 1 width -1 Left reverse maxrows 2 font ",6" }
  plot for [s = 1:5] table using (chosen(s == 5 ? 2 : s - 1, separation, s == 5) && !(separation == 0 && s == 4) ? \
                                  column("solves") : NaN):(column("off_limit")) \
         with linespoints linewidth 1.3 pointtype marker[s] pointsize 0.5 linecolor rgb colour[s] title label[s]
}
unset multiplot
