# Suspensions between two circular walls: shared by the figures of the annuli. Angles in degrees, diameters in lengths.
set size ratio -1
set object 1 circle at 0,0 size 10 fillstyle empty border rgb wall_colour linewidth 1.2
@no_axes
set xrange [-10.2:10.2]
set yrange [-10.2:10.2]

# The discs of a file of snapshots at a time; its inner wall, a larger disc, is not among them.
disc_at(t) = abs(column("time") - t) < 1e-6 && column("radius") < 0.4 ? column("x") : NaN
set object 2 circle at 0,0 size inner_radius fillstyle empty border rgb wall_colour linewidth 1.2

# Panels of a multiplot from the top left, `columns` by `rows`; k counts from 1.
panel(k) = sprintf("set lmargin at screen %g; set rmargin at screen %g; ", \
                   column_of(k) / columns + 0.005, (column_of(k) + 1) / columns - 0.005) . \
           sprintf("set tmargin at screen %g; set bmargin at screen %g", \
                   1 - row_of(k) / rows - 0.005, 1 - (row_of(k) + 1) / rows + 0.005)
column_of(k) = 1.0 * ((k - 1) % columns)
row_of(k) = 1.0 * ((k - 1) / columns)
