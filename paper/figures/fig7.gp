# Figure 7: log10 |sigma_xy| of the run of Figure 6; bodies white.
width = 17; height = 12.4
load "paper/figures/style.gp"
inner_radius = 0.5
load "paper/figures/annulus.gp"
columns = 3; rows = 2
# The cells of the view alone, so that the range ends where they do: an image that is cut is drawn displaced.
set xrange [*:*]
set yrange [*:*]
set autoscale fix
in_view(file) = sprintf("< awk -F, '/^#/ {next} !header++ || ($1*$1 < 36.01 && $2*$2 < 36.01)' %s", file)
set object 2 front
unset key
unset object 1
set cbrange [-4:1]
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725")
unset colorbox
array times[6] = ["0", "2", "3.9", "4.1", "6", "8"]
set multiplot
do for [k = 1:6] {
  eval panel(k)
  # Room for the colour scale below both rows.
  set tmargin at screen 1 - 0.458 * row_of(k) - 0.035
  set bmargin at screen 1 - 0.458 * (row_of(k) + 1) + 0.005
  set label 1 "t = " . times[k] at graph 0, 1.035
  if (k == 6) {
    set colorbox horizontal user origin screen 0.25, 0.06 size screen 0.5, 0.018
    set cblabel "log_{10} |σ_{xy}|" offset 0,0.9
    set cbtics 1 offset 0,0.4
  }
  plot in_view(sprintf("%s/fig7_shear_stress/seed1_t%s.csv", results, times[k])) \
           using "x":"y":(column("inside") == 1 ? NaN : column("log10_abs_sigma_xy")) with image, \
       results . "/fig6_injection/seed1_snapshots.csv" \
                using (disc_at(real(times[k]))):"y":"radius" \
                with circles fillcolor rgb "white" fillstyle solid 1 border rgb "#444444" linewidth 0.4
}
unset multiplot
