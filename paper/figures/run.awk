# From bodies.csv and trajectory.csv of a run to what run.gp draws: about `frames` states at equal distances, the last one
# always; of frames = 1 only that, each a block of rows, a body each,
#   x y length breadth degrees kind time frame
# kind: 0 free, 1 in contact during the step from the state (from the last one there is none: during the step that led to
# it), 2 fixed.
BEGIN { FS = ","; count = 0; last = "none" }
{ sub(/\r$/, ""); gsub(/"/, "") }
/^[ \t]*(#|$)/ { next }
FILENAME != file {  # the names of the columns
  file = FILENAME; ++files
  for (name in column) delete column[name]
  for (k = 1; k <= NF; ++k) { name = $k; gsub(/[^a-z_0-9]/, "", name); column[name] = k }
  next
}
files == 1 {
  a[count] = $column["a"]; b[count] = $column["b"]; fixed[count] = "fixed" in column ? $column["fixed"] : 0
  ++count
  next
}
{
  body = $column["body"]
  if (body >= count) next  # the inner wall, in files of earlier builds
  step = $column["step"]
  if (step != last) { last = step; ++states }
  force = $column["fx"]
  if (force != "") touched[body] = force != 0 || $column["fy"] != 0 || $column["torque"] != 0
  kind = fixed[body] == 1 ? 2 : touched[body] ? 1 : 0
  rows[states] = rows[states] sprintf("%.9g %.9g %.9g %.9g %.9g %d %.9g", $column["x"], $column["y"], 2 * a[body], \
                                      2 * b[body], $column["theta"] * 57.295779513082323, kind, $column["time"]) "\n"
}
END {
  stride = int((states - 1) / frames) + 1
  for (k = 1; k <= states; ++k) {
    if (k != states && (frames == 1 || (k - 1) % stride != 0)) continue
    n = split(rows[k], row, "\n")
    for (i = 1; i < n; ++i) print row[i], shown + 0
    print "\n"
    ++shown
  }
}
