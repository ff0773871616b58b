# Figure 1: a bounded domain with an inner wall and two bodies: names of curves, centres, angles and the normal.
width = 8.5; height = 6.5
load "paper/figures/style.gp"
unset key
unset border
unset tics
set size ratio -1
set xrange [-5.3:5.3]
set yrange [-4.1:4.1]
set parametric
set trange [0:2*pi]
set samples 400
set style arrow 1 head filled size screen 0.012,20 linewidth 1 linecolor rgb "black"

# A body with centre (x, y) and angle theta.
a = 1.1; b = 0.5
x1 = -2.2; y1 = 0.6; theta1 = 0.6
x2 = 2.2; y2 = 1.2; theta2 = -0.5
ellipse_x(x, theta, t) = x + a * cos(t) * cos(theta) - b * sin(t) * sin(theta)
ellipse_y(y, theta, t) = y + a * cos(t) * sin(theta) + b * sin(t) * cos(theta)
# The outer wall, and its normal.
wall_x(t) = 5 * cos(t)
wall_y(t) = 3.8 * sin(t) + 0.12 * cos(3 * t)

do for [k = 1:2] {
  x = value(sprintf("x%d", k)); y = value(sprintf("y%d", k)); theta = value(sprintf("theta%d", k))
  set arrow from x, y to x + 1.9, y nohead dashtype 3 front
  set arrow from x, y to x + 1.9 * cos(theta), y + 1.9 * sin(theta) nohead front
  set label sprintf("θ_%d", k) at x + 1.6, y + 0.8 * theta front left
  set label sprintf("c_{γ%d}", k) at x + 0.02, y - 0.24 center front
  set label sprintf("γ_%d", k) at x - 0.3, y + 0.95 front center
}
set label "Γ_0" at 4.0, -3.3 left
set label "Γ_1" at 1.35, -2.2 left
set label "c_{Γ1}" at 0.1, -1.7 left front
set label "Ω" at -2.6, -2.0 center font ",10"
t0 = 2.45
set arrow from wall_x(t0), wall_y(t0) to wall_x(t0) - 0.48, wall_y(t0) + 0.52 arrowstyle 1
set label "n" at wall_x(t0) - 0.62, wall_y(t0) + 0.3 right
set arrow from 0.9 * cos(3.6), -1.7 + 0.9 * sin(3.6) to 0.35 * cos(3.6), -1.7 + 0.35 * sin(3.6) arrowstyle 1 front
set label "n" at -0.55, -1.75 center front
t1 = 1.9
set arrow from ellipse_x(x2, theta2, t1), ellipse_y(y2, theta2, t1) \
         to ellipse_x(x2, theta2, t1) - 0.15, ellipse_y(y2, theta2, t1) - 0.42 arrowstyle 1 front
set label "n" at ellipse_x(x2, theta2, t1) + 0.02, ellipse_y(y2, theta2, t1) - 0.22 left front

set label at x1, y1 point pointtype 7 pointsize 0.25 front
set label at x2, y2 point pointtype 7 pointsize 0.25 front
set label at 0, -1.7 point pointtype 7 pointsize 0.25 front
plot ellipse_x(x1, theta1, t), ellipse_y(y1, theta1, t) with filledcurves linecolor rgb body_colour, \
     ellipse_x(x2, theta2, t), ellipse_y(y2, theta2, t) with filledcurves linecolor rgb body_colour, \
     0.9 * cos(t), -1.7 + 0.9 * sin(t) with filledcurves linecolor rgb "#eeeeee", \
     ellipse_x(x1, theta1, t), ellipse_y(y1, theta1, t) with lines linecolor rgb "black", \
     ellipse_x(x2, theta2, t), ellipse_y(y2, theta2, t) with lines linecolor rgb "black", \
     0.9 * cos(t), -1.7 + 0.9 * sin(t) with lines linewidth 1.5 linecolor rgb wall_colour, \
     wall_x(t), wall_y(t) with lines linewidth 1.5 linecolor rgb wall_colour
