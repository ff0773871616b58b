# Figure 5: the annulus of the injection experiment at t = 0, fixed bodies red, and the flow through the walls.
width = 8.5; height = 8.5
load "paper/figures/style.gp"
inner_radius = 0.5
load "paper/figures/annulus.gp"
set lmargin at screen 0.02
set rmargin at screen 0.98
set bmargin at screen 0.02
set tmargin at screen 0.98
set xrange [-11.5:11.5]
set yrange [-11.5:11.5]
unset key
do for [k = 0:11] {
  set arrow from 10 * cos(k * pi / 6), 10 * sin(k * pi / 6) \
           to 11.2 * cos(k * pi / 6), 11.2 * sin(k * pi / 6) head filled size screen 0.012,20
}
do for [k = 0:5] {
  set arrow from 0.5 * cos(k * pi / 3), 0.5 * sin(k * pi / 3) \
           to 1.1 * cos(k * pi / 3), 1.1 * sin(k * pi / 3) head filled size screen 0.006,20 front
}
set label "Q/(2πR_{out})" at 7.1, 8.9 left
set label "Q/(2πR_{in})" at 0, -6.6 center
set arrow from 0, -6.2 to 0.25, -0.75 nohead linewidth 0.6 front
plot results . "/fig6_injection/paper_snapshots.csv" \
         using (disc_at(0)):"y":"radius":(column("fixed") == 1 ? fixed_colour : body_colour) \
         with circles linecolor rgb variable
