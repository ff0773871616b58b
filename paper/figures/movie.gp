# A moving picture of a run of simulate, bodies in contact green. Set on the command line beside what style.gp needs:
# folder, of the run; bodies, its file of bodies; half, half the width of the view; walls, the radii of circular walls.
width = 9; height = 9
load "paper/figures/style.gp"
unset key
set size ratio -1
@no_axes
set margins 0, 0, 0, 0

trajectory = folder . "/trajectory.csv"
stats trajectory using "body" nooutput name "row"
count = int(row_max) + 1
frames = int(row_records / count)
array a[count]
array b[count]
stats bodies using (a[int(column(0)) + 1] = column("a"), b[int(column(0)) + 1] = column("b")) nooutput name "given"
# By the body's number, from 0. The inner wall is the last body of the trajectory and no body of the file.
is_given(k) = k < given_records
length(k) = is_given(k) ? 2 * a[k + 1] : 0
breadth(k) = is_given(k) ? 2 * b[k + 1] : 0

set xrange [-half:half]
set yrange [-half:half]
do for [k = 1:words(walls)] {
  set object k circle at 0,0 size real(word(walls, k)) fillstyle empty border rgb wall_colour linewidth 1.2
}
do for [frame = 0:frames - 1] {
  plot trajectory every ::(frame * count)::((frame + 1) * count - 1) using (is_given(int(column("body"))) ? column("x") : NaN):"y":(length(int(column("body")))):(breadth(int(column("body")))):(column("theta") * degrees):(column("fx")**2 + column("fy")**2 > 0 ? contact_colour : body_colour) with ellipses linecolor rgb variable
}
