# Reads what `gcov --stdout --branch-counts --demangled-names --relative-only` says of all objects and prints, for each
# file of src/, the share of its lines and functions that were executed in any of them, and the functions never called.

/^ *-: *0:Source:/ { file = $0; sub(/.*Source:/, "", file); next }
file !~ /^src\// { next }

/^function .* called [0-9]+ returned/ {
  name = $0
  sub(/^function /, "", name)
  calls = name
  sub(/ called [0-9]+ returned.*/, "", name)
  sub(/.* called /, "", calls)
  key = file SUBSEP name
  functions[key] += calls + 0
  next
}

/^ *([0-9]+[*]?|#####|=====|%%%%%|[$][$][$][$][$]): *[0-9]+:/ {
  split($0, part, ":")
  key = file SUBSEP part[2] + 0
  lines[key] += part[1] + 0  # "#####" counts as 0
}

END {
  for (key in lines) {
    split(key, part, SUBSEP)
    files[part[1]] = 1
    all[part[1]]++
    if (lines[key] > 0) hit[part[1]]++
  }
  for (key in functions) {
    split(key, part, SUBSEP)
    all_functions[part[1]]++
    if (functions[key] > 0) hit_functions[part[1]]++
    else never[part[1] ": " part[2]] = 1
  }
  sort = "sort"
  for (file in files) {
    printf "%-28s %5d lines %6.1f %%  %4d functions %6.1f %%\n", file, all[file], 100 * hit[file] / all[file],
           all_functions[file], all_functions[file] ? 100 * hit_functions[file] / all_functions[file] : 100 | sort
    total += all[file]; total_hit += hit[file]
    total_functions += all_functions[file]; total_hit_functions += hit_functions[file]
  }
  close(sort)
  printf "%-28s %5d lines %6.1f %%  %4d functions %6.1f %%\n\nnever called:\n", "all", total, 100 * total_hit / total,
         total_functions, 100 * total_hit_functions / total_functions
  for (name in never) print "  " name | sort
  close(sort)
}
