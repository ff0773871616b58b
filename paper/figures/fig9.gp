# Figure 9: order parameter of the suspensions between cylinders: the first seed bold, others thin; dashed: bodies that do
# not interact; markers: published means over the second revolution, with its range.
width = 8.5; height = 9.5
load "paper/figures/style.gp"
set xrange [0:2]
set yrange [-0.45:1.05]
set xtics 0.5
set ytics 0.2
set ylabel "order parameter S" offset 2,0
set lmargin at screen 0.12
set rmargin at screen 0.97
set key bottom right maxrows 3 samplen 1
series(phi, lambda, seed) = sprintf("%s/couette_run/phi%d_lambda%d_seed%s_series.csv", results, phi, lambda, seed)
seeds(phi, lambda) = system(sprintf("ls %s | sed 's/.*seed//; s/_series.csv//'", series(phi, lambda, "[0-9]")))
colour(phi, lambda) = tint(lambda_colour(lambda), phi)
mean(phi, lambda) = column("phi") == phi && column("lambda") == lambda ? 1.5 : NaN

set multiplot
do for [lambda in "3 6"] {
  lambda = int(lambda)
  set tmargin at screen (lambda == 3 ? 0.985 : 0.535)
  set bmargin at screen lambda == 3 ? 0.565 : 0.115
  set xlabel (lambda == 3 ? "" : "revolutions of the outer cylinder") offset 0,0.3
  set format x lambda == 3 ? "" : "%g"
  set label 1 sprintf("λ = %d", lambda) at graph 0.03, 0.93
  fractions = lambda == 3 ? "5 10 15" : "5 10"
  plot for [phi in fractions] for [seed in seeds(int(phi), lambda)] series(int(phi), lambda, seed) \
           using "revolutions":"order_parameter" \
           with lines linewidth (seed eq "1" ? 1.6 : 0.5) linecolor rgb colour(int(phi), lambda) \
           title (seed eq "1" ? "φ = " . phi . " %" : ""), \
       results . "/fig9_order_parameter/single_body.csv" \
                using "revolutions":sprintf("lambda%d", lambda) \
                with lines dashtype 2 linewidth 1 linecolor rgb "#666666" title "no interaction", \
       for [phi in fractions] results . "/table2_order_parameter/table.csv" \
                using (mean(int(phi), lambda)):"published":(0.5) \
                with xerrorbars pointtype 6 pointsize 0.5 linewidth 0.7 linecolor rgb published \
                title (phi eq "5" ? "published mean" : "")
}
unset multiplot
