# The common look of the figures. Set on the command line: kind (pdf, png or gif), output_file, results, reference; by a
# script before it loads this file: width, height in cm. Column width is 8.5.

look = 'enhanced color rounded font "DejaVu Sans Condensed,7"'
if (kind eq "pdf") {
  eval sprintf("set terminal pdfcairo %s fontscale 0.85 linewidth 0.7 size %gcm,%gcm", look, width, height)
}
if (kind eq "png") {
  eval sprintf("set terminal pngcairo %s fontscale 2.4 pointscale 2.4 linewidth 1.8 size %d,%d", look, 79*width, 79*height)
}
if (kind eq "gif") { set terminal gif animate delay 6 loop 0 size 480,480 font "DejaVu Sans Condensed,12" }
set output output_file
set encoding utf8

set datafile separator ","
set datafile columnheaders
set border linewidth 0.7
set tics scale 0.6 nomirror
set errorbars 0
set key samplen 1.6 spacing 1.05
set style fill solid 1 noborder
set style ellipse units xx

# One colour for one thing.
contact_colour  = 0x228833                      # bodies in contact
fixed_colour    = 0xcc3311                      # bodies that do not move
body_colour     = 0xbbbbbb
marked_colour   = 0xee7733                      # the body that a figure follows
wall_colour     = 0x000000
published       = "#000000"                     # published values: open markers
array delta_colour[5] = ["#440154", "#3b528b", "#21918c", "#5ec962", "#c8a000"]  # separations 0 to 3h
array step_colour[3] = ["#000000", "#5577cc", "#ddaa33"]                        # time steps, coarse to fine
lambda_colour(lambda) = lambda == 1 ? 0x118888 : lambda == 3 ? 0xaa3377 : 0x0044aa  # aspect ratios
# An area fraction by how much white is mixed in: 5 % light, 15 % full. A single body, and raw data: see the scripts.
tint(colour, phi) = 65536 * mix(colour / 65536, phi) + 256 * mix(colour / 256 % 256, phi) + mix(colour % 256, phi)
mix(channel, phi) = int(255 - (255 - channel) * (phi == 5 ? 0.5 : phi == 10 ? 0.72 : 1.0))

# Published values are read from the reference tables: rows with this quantity that were read off a figure of the paper.
# The abscissa is the number in the name of the case, between two texts.
is_read_off(quantity) = strcol("quantity") eq quantity && strcol("source") eq "paper_figure"
read_off(quantity) = is_read_off(quantity) ? column("value") : NaN
case_of(quantity, before, behind) = is_read_off(quantity) ? between(strcol("case"), before, behind) : NaN
between(name, before, behind) = real(substr(name, strlen(before) + 1, strlen(name) - strlen(behind)))

no_axes  = 'unset border; unset tics; unset xlabel; unset ylabel'
degrees  = 180 / pi
