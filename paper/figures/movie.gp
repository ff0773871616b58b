# A moving picture of a run of simulate, bodies in contact green, fixed ones red. Set on the command line beside what
# style.gp needs: folder, of the run; bodies, its file of bodies; half, half the width of the view; walls, the radii of
# circular walls; stride, the states from one frame to the next.
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
array fixed[count]
stats bodies using (n = int(column(0)) + 1, fixed[n] = column("fixed"), a[n] = column("a"), b[n] = column("b")) \
      nooutput name "given"
# Runs of earlier builds have rows of the inner wall, which is no body of the file.
x_of(body) = body < given_records ? column("x") : NaN
length(body) = body < given_records ? 2 * a[int(body) + 1] : 0
breadth(body) = body < given_records ? 2 * b[int(body) + 1] : 0
force(component) = valid(component) ? column(component) : 0  # empty in the final configuration
colour(body, force_x, force_y) = body < given_records && fixed[int(body) + 1] == 1 ? fixed_colour : \
                                 force_x**2 + force_y**2 > 0 ? contact_colour : body_colour

set xrange [-half:half]
set yrange [-half:half]
do for [k = 1:words(walls)] {
  set object k circle at 0,0 size real(word(walls, k)) fillstyle empty border rgb wall_colour linewidth 1.2
}
do for [frame = 0:frames - 1:stride] {
  plot trajectory every ::(frame * count)::((frame + 1) * count - 1) \
           using (x_of(column("body"))):"y":(length(column("body"))):(breadth(column("body"))):(column("theta") * degrees) \
                 :(colour(column("body"), force("fx"), force("fy"))) with ellipses linecolor rgb variable
}
