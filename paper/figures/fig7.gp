# Figure 7: log10 |sigma_xy| of the run of Figure 6; bodies white.
width = 17; height = 13
load "paper/figures/style.gp"
load "paper/figures/annulus.gp"
columns = 3; rows = 2
set xrange [-6:6]
set yrange [-6:6]
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
  plot sprintf("%s/fig7_shear_stress/seed1_t%s.csv", results, times[k]) using "x":"y":(column("inside") == 1 ? NaN : column("log10_abs_sigma_xy")) with image
}
unset multiplot
