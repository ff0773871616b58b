# Figure 10: effective viscosity from the paper's starts: raw (faint) and smoothed (solid); open markers: the published
# curves where they were read.
width = 17; height = 6.2
load "paper/figures/style.gp"
columns = 3.0
set xrange [0:2]
set yrange [0.95:1.8]
set xtics 0.5
set ytics 0.1
set xlabel "revolutions of the outer cylinder" offset 0,0.5
set key top right samplen 1
set bmargin at screen 0.17
set tmargin at screen 0.97
run(phi, lambda) = sprintf("%s/fig10_effective_viscosity/phi%d_lambda%d_paper.csv", results, phi, lambda)
colour(phi, lambda) = tint(lambda_colour(lambda), phi)
faint(phi, lambda) = colour(phi, lambda) + 0xb0000000
published_at(phi, lambda) = sprintf("f10-%d-%d-", phi, lambda)
place(start) = strstrt(strcol("id"), start) == 1 ? real(substr(strcol("id"), strlen(start) + 1, -1)) : NaN
array lambdas[3] = [1, 3, 6]

set multiplot
do for [k = 1:3] {
  lambda = lambdas[k]
  set lmargin at screen 0.065 + 0.313 * (k - 1)
  set rmargin at screen 0.065 + 0.313 * k - 0.02
  set ylabel (k == 1 ? "effective viscosity" : "") offset 0.5,0
  set format y k == 1 ? "%.1f" : ""
  set label 1 sprintf("λ = %d", lambda) at graph 0.04, 0.94
  fractions = lambda == 6 ? "5 10" : "5 10 15"
  plot for [phi in fractions] run(int(phi), lambda) \
           using "revolutions":"raw" with lines linewidth 0.5 linecolor rgb faint(int(phi), lambda) notitle, \
       for [phi in fractions] run(int(phi), lambda) \
                using "revolutions":"smoothed" \
                with lines linewidth 1.6 linecolor rgb colour(int(phi), lambda) title "φ = " . phi . " %", \
       for [phi in fractions] reference . "/fig10_effective_viscosity.csv" \
                using (place(published_at(int(phi), lambda))):"value" \
                with points pointtype 6 pointsize 0.6 linewidth 1 linecolor rgb colour(int(phi), lambda) \
                title (phi eq "5" ? "published" : "")
}
unset multiplot
