# The bodies of a run of simulate: its last state (png) or a movie of it (gif). A body in contact is green, with a dark edge
# and a dot; a fixed one red and hatched, with a cross. Set on the command line: here, the folder of this file; folder, of
# the run; kind and output_file; frames, how many states a movie has at most.
width = 9; height = 9.9
load here . "style.gp"
if (kind eq "gif") { set terminal gif animate delay 6 loop 0 size 480,528 font "DejaVu Sans Condensed,12" }

# The states, in a file of their own.
states = system("mktemp")
system(sprintf("awk -v frames=%d -f '%srun.awk' '%s/bodies.csv' '%s/trajectory.csv' > %s", frames, here, folder, folder, states))
set datafile separator whitespace
unset datafile columnheaders
array time[frames + 2]
stats states using (time[int($8) + 1] = $7) nooutput name "times"
stats states using (int($8) + 1) nooutput name "frame"
stats states using 1:2 nooutput name "centres"
stats states using 3 nooutput name "lengths"
stats states using 6 nooutput name "kinds"
number_of_kind(k) = int(system(sprintf("awk '$6 == %d' %s | wc -l", k, states)))

# Walls are in the record of the run.
recorded(key) = system(sprintf("sed -n 's/^%s = //p' '%s/run.txt' 2> /dev/null", key, folder))
outer = recorded("outer_radius"); inner = recorded("inner_radius")
if (strlen(outer)) {
  set object 1 circle at 0,0 size real(outer) fillstyle empty border rgb wall_colour linewidth 1.2
  middle_x = 0; middle_y = 0; half = 1.02 * real(outer)
} else {
  middle_x = 0.5 * (centres_min_x + centres_max_x); middle_y = 0.5 * (centres_min_y + centres_max_y)
  span_x = centres_max_x - centres_min_x; span_y = centres_max_y - centres_min_y
  half = 0.5 * (span_x > span_y ? span_x : span_y) + 0.6 * lengths_max
}
if (strlen(inner)) {
  set object 2 circle at 0,0 size real(inner) fillstyle empty border rgb wall_colour linewidth 1.2
}
set size ratio -1
@no_axes
set lmargin at screen 0.01; set rmargin at screen 0.99
set bmargin at screen 0.09; set tmargin at screen 0.99
set xrange [middle_x - half:middle_x + half]
set yrange [middle_y - half:middle_y + half]

# A bar of 1, 2 or 5 times a power of ten, about a fifth of the view.
power = 10**floor(log10(0.4 * half))
bar = 0.4 * half / power >= 5 ? 5 * power : 0.4 * half / power >= 2 ? 2 * power : power
set arrow 1 from graph 0.98,screen 0.035 rto -bar,0 nohead linewidth 2 front
set label 1 sprintf("%g", bar) at graph 0.98,screen 0.065 right
set key at screen 0.2,0.045 left center horizontal Left reverse samplen 0.5 width -1 maxrows 1

bodies(k, look) = sprintf("states index frame using (int($6) == %d ? $1 : NaN):2:3:4:5 with ellipses %s notitle, ", k, look)
centres(k, look) = sprintf("states index frame using (int($6) == %d ? $1 : NaN):2 with points %s notitle, ", k, look)
drawn = ""
if (number_of_kind(0) > 0) {
  drawn = drawn . bodies(0, "fillcolor rgb body_colour fillstyle solid border rgb '#777777'") \
          . "keyentry with points pointtype 7 pointsize 1.4 linecolor rgb body_colour title 'free', "
}
if (number_of_kind(1) > 0) {
  drawn = drawn . bodies(1, "fillcolor rgb contact_colour fillstyle solid border rgb 'black' linewidth 2") \
          . centres(1, "pointtype 7 pointsize 0.5 linecolor rgb 'black'") \
          . "keyentry with points pointtype 7 pointsize 1.4 linecolor rgb contact_colour title 'in contact', "
}
if (number_of_kind(2) > 0) {
  drawn = drawn . bodies(2, "fillcolor rgb fixed_colour fillstyle pattern 4 border rgb fixed_colour") \
          . centres(2, "pointtype 2 pointsize 0.7 linecolor rgb 'black'") \
          . "keyentry with points pointtype 2 pointsize 1.2 linecolor rgb fixed_colour title 'fixed', "
}
drawn = drawn[1:strlen(drawn) - 2]

first = kind eq "gif" ? 0 : int(frame_max) - 1
do for [frame = first:int(frame_max) - 1] {
  set label 2 sprintf("t = %.4g", time[frame + 1]) at screen 0.02,screen 0.045 left
  eval "plot " . drawn
}
system(sprintf("rm -f %s", states))
