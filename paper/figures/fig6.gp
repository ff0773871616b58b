# Figure 6: injection until t = 4 and back until t = 8: fixed bodies red, bodies in contact green; last panel: start
# (filled) and end (outlines).
width = 17; height = 11.4
load "paper/figures/style.gp"
inner_radius = 0.5
load "paper/figures/annulus.gp"
columns = 3; rows = 2
set xrange [-6:6]
set yrange [-6:6]
unset key
unset object 1
file = results . "/fig6_injection/seed1_snapshots.csv"
colour_of(fixed, contact) = fixed == 1 ? fixed_colour : contact == 1 ? contact_colour : body_colour
set multiplot
do for [k = 1:5] {
  t = 2 * (k - 1)
  eval panel(k)
  set label 1 sprintf("t = %d", t) at graph 0.02, 0.96
  plot file \
           using (disc_at(t)):"y":"radius":(colour_of(column("fixed"), column("in_contact"))) \
           with circles linecolor rgb variable
}
eval panel(6)
set label 1 "t = 0 and t = 8"
plot file using (disc_at(0)):"y":"radius":(colour_of(column("fixed"), 0)) with circles linecolor rgb variable, \
     file using (column("fixed") == 1 ? NaN : disc_at(8)):"y":"radius" \
              with circles fillstyle empty border linecolor rgb "black"
unset multiplot
