# Figure 6: injection until t = 4 and back until t = 8: fixed bodies red, bodies in contact green; last panel: start
# (filled) and last frame (outlines). Open markers: published centres.
width = 17; height = 11.4
load "paper/figures/style.gp"
inner_radius = 0.5
load "paper/figures/annulus.gp"
columns = 3; rows = 2
set xrange [-6:6]
set yrange [-6:6]
unset key
unset object 1
file = results . "/fig6_injection/paper_snapshots.csv"
colour_of(fixed, contact) = fixed == 1 ? fixed_colour : contact == 1 ? contact_colour : body_colour
# Of each disc the row of x stands before that of y.
published_at(t) = sprintf("< awk -F, 'BEGIN {print \"x,y\"} $4 ~ /_x_at_%s$/ {x = $6} $4 ~ /_y_at_%s$/ {print x \",\" $6}' %s", \
                          t, t, reference . "/fig6_injection.csv")
marker = sprintf("with points pointtype 6 pointsize 0.45 linewidth 1 linecolor rgb '%s'", published)
array times[5] = ["0", "1.92", "3.92", "5.92", "7.92"]
set multiplot
do for [k = 1:5] {
  eval panel(k)
  set label 1 "t = " . times[k] at graph 0.02, 0.96
  eval "plot file using (disc_at(real(times[k]))):'y':'radius':(colour_of(column('fixed'), column('in_contact'))) " . \
       "with circles linecolor rgb variable" . (k == 1 ? "" : ", published_at(times[k]) using 'x':'y' " . marker)
}
eval panel(6)
set label 1 "t = 0 and t = 7.92"
plot file using (disc_at(0)):"y":"radius":(colour_of(column("fixed"), 0)) with circles linecolor rgb variable, \
     file using (column("fixed") == 1 ? NaN : disc_at(7.92)):"y":"radius" \
              with circles fillstyle empty border linecolor rgb "black"
unset multiplot
