# Figure 8: initial configurations between the cylinders.
width = 17; height = 4.6
load "paper/figures/style.gp"
inner_radius = 5
load "paper/figures/annulus.gp"
columns = 4; rows = 1
unset key
array phi[4] = [5, 5, 10, 10]
array lambda[4] = [3, 6, 3, 6]
set multiplot
do for [k = 1:4] {
  eval panel(k)
  set bmargin at screen 0.08
  set label 1 sprintf("φ = %d %%, λ = %d", phi[k], lambda[k]) at graph 0.5, -0.04 center
  plot sprintf("%s/couette_run/phi%d_lambda%d_paper/bodies.csv", results, phi[k], lambda[k]) \
           using "x":"y":(2 * column("a")):(2 * column("b")):(column("theta") * degrees) \
           with ellipses linecolor rgb lambda_colour(lambda[k])
}
unset multiplot
