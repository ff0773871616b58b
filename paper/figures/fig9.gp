# Figure 9: order parameter of the suspensions between cylinders: the paper's start bold, other starts thin; dashed: bodies
# that do not interact; open markers: the published curves where they were read.
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
run(phi, lambda, start) = sprintf("%s/couette_run/phi%d_lambda%d_%s_series.csv", results, phi, lambda, start)
starts(phi, lambda) = system(sprintf("ls %s | sed 's/.*_lambda._//; s/_series.csv//' | grep -v _", run(phi, lambda, "*")))
colour(phi, lambda) = tint(lambda_colour(lambda), phi)
published_at(phi, lambda) = sprintf("f9-%d-%d-", phi, lambda)
place(start) = strstrt(strcol("id"), start) == 1 ? real(substr(strcol("id"), strlen(start) + 1, -1)) : NaN

set multiplot
do for [lambda in "3 6"] {
  lambda = int(lambda)
  set tmargin at screen (lambda == 3 ? 0.985 : 0.535)
  set bmargin at screen lambda == 3 ? 0.565 : 0.115
  set xlabel (lambda == 3 ? "" : "revolutions of the outer cylinder") offset 0,0.3
  set format x lambda == 3 ? "" : "%g"
  set label 1 sprintf("λ = %d", lambda) at graph 0.03, 0.93
  fractions = lambda == 3 ? "5 10 15" : "5 10"
  plot for [phi in fractions] for [start in starts(int(phi), lambda)] run(int(phi), lambda, start) \
           using "revolutions":"order_parameter" \
           with lines linewidth (start eq "paper" ? 1.6 : 0.4) linecolor rgb colour(int(phi), lambda) \
           title (start eq "paper" ? "φ = " . phi . " %" : ""), \
       results . "/fig9_order_parameter/single_body.csv" \
                using "revolutions":sprintf("lambda%d", lambda) \
                with lines dashtype 2 linewidth 1 linecolor rgb "#666666" title "no interaction", \
       for [phi in fractions] reference . "/fig9_order_parameter.csv" \
                using (place(published_at(int(phi), lambda))):"value" \
                with points pointtype 6 pointsize 0.6 linewidth 1 linecolor rgb colour(int(phi), lambda) \
                title (phi eq "5" ? "published" : "")
}
unset multiplot
