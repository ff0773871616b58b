# Figure 7: log10 |sigma_xy| of the run of Figure 6, of the flow (above) and what the paper plotted (below); bodies white.
# Above each panel the median, in brackets the published one.
width = 17; height = 7.9
load "paper/figures/style.gp"
unset key
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725")
set cbrange [-4:1]
unset colorbox
set size ratio -1
inner_radius = 0.5
load "paper/figures/annulus.gp"
unset object 1
set object 2 front
set border
# The cells of the view alone, so that the range ends where they do: an image that is cut is drawn displaced.
set xrange [*:*]
set yrange [*:*]
set autoscale fix
in_view(file) = sprintf("< awk -F, '/^#/ {next} !header++ || ($1*$1 < 36.01 && $2*$2 < 36.01)' %s", file)
array times[6] = ["0", "2", "3.92", "4.08", "5.92", "7.92"]
medians = results . "/fig7_shear_stress/paper.csv"
published_median(t) = system(sprintf("awk -F, '$4 == \"plotted_median_at_%s\" {printf \" (%%.2f)\", $6}' %s/fig7_shear_stress.csv", \
                                     t, reference))
set multiplot
do for [row = 0:1] {
  quantity = row == 0 ? "stress" : "plotted"
  do for [k = 1:6] {
    set lmargin at screen 0.04 + 0.16 * (k - 1)
    set rmargin at screen 0.04 + 0.16 * (k - 1) + 0.152
    set tmargin at screen 0.93 - 0.41 * row
    set bmargin at screen 0.93 - 0.41 * row - 0.327
    set xtics -6, 3, 6 offset 0, 0.4
    set ytics -6, 3, 6 offset 0.6, 0
    set format x row == 1 ? "%g" : ""
    set format y k == 1 ? "%g" : ""
    stats medians using sprintf("%s_median_at_%s", quantity, times[k]) nooutput
    value = sprintf("%.2f", STATS_min) . (row == 1 ? published_median(times[k]) : "")
    set label 1 (row == 0 ? "t = " . times[k] . ":  " : "") . value at graph 0.5, 1.08 center
    if (row == 1 && k == 6) {
      set colorbox horizontal user origin screen 0.27, 0.095 size screen 0.5, 0.022
      set cblabel "log_{10} |σ_{xy}|" offset 0,0.9
      set cbtics 1 offset 0,0.4
    }
    plot in_view(sprintf("%s/fig7_shear_stress/paper_t%s.csv", results, times[k])) \
             using "x":"y":(column("log10_" . quantity)) with image, \
         results . "/fig6_injection/paper_snapshots.csv" using (disc_at(real(times[k]))):"y":"radius" \
             with circles fillcolor rgb "white" fillstyle solid 1 border rgb "#444444" linewidth 0.3
  }
}
unset multiplot
