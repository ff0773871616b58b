#!/bin/sh
# Runs every command of README.md, in its order, on a fresh Debian 12 without a locale: as a user without sudo, who is
# told what to install, then as root, who gets it installed, then as the user again. To be run as root where the machine
# may be changed, in a chroot for instance:
#   debootstrap bookworm ROOT && cp -r . ROOT/package && chroot ROOT sh /package/tests/bare_machine.sh
# The argument `full` runs the commands as they stand, which takes hours. Without it the coarse cases stand for `reproduce`,
# `reproduce-all` is left out, and figures, report and movies are made of what is there.
set -eu
cd "$(dirname "$0")/.."
[ "$(id -u)" = 0 ] || { echo 'tests/bare_machine.sh has to be run as root' >&2; exit 2; }
full=${1:-}
for variable in LANG LANGUAGE $(env | sed -n 's/^\(LC_[A-Z]*\)=.*/\1/p'); do unset "$variable"; done
id newcomer > /dev/null 2>&1 || useradd -m newcomer
command -v make > /dev/null || { apt-get update -q && apt-get install -q -y --no-install-recommends make; } > /dev/null

# copy FOLDER OWNER: the package as it comes, without anything built.
copy() {
  mkdir -p "$1"
  tar --exclude=./build --exclude=./results --exclude=./.git -cf - . | tar -xf - -C "$1"
  chown -R "$2" "$1"
}

commands() { awk '/^    (make|build)/ { sub(/^ +/, ""); sub(/  +#.*/, ""); print }' README.md; }

shorter() {
  case $1 in
    *reproduce-all*) ;;
    *' reproduce') echo "$1-quick" ;;
    *figures\ paper* | *movies*) echo "$1 MISSING=allow" ;;
    *) echo "$1" ;;
  esac
}

# run USER FOLDER COMMAND: what it prints is shown if it fails.
run() {
  began=$(date +%s)
  if su "$1" -s /bin/sh -c "cd '$2' && $3" > /tmp/bare_machine.out 2>&1 < /dev/null; then
    echo "$1: $3: $(($(date +%s) - began)) s; $(tail -n 1 /tmp/bare_machine.out)"
  else
    cat /tmp/bare_machine.out
    echo "$1: $3: failed"
    return 1
  fi
}

run_all() {
  commands | while read -r line; do
    [ "$full" = full ] || line=$(shorter "$line")
    [ -z "$line" ] || run "$1" "$2" "$line" || exit 1
  done
}

copy /home/newcomer/first newcomer
if ! command -v g++ > /dev/null; then
  if run newcomer /home/newcomer/first 'make deps' > /tmp/bare_machine.deps; then
    echo 'make deps of a user without sudo succeeded on a machine without a compiler'
    exit 1
  fi
  grep -q 'apt install' /tmp/bare_machine.deps || { cat /tmp/bare_machine.deps; exit 1; }
  echo 'newcomer: make deps says what to install'
fi
copy /root/package root
run_all root /root/package
copy /home/newcomer/package newcomer
run_all newcomer /home/newcomer/package
echo 'every command of the README ran as root and as a user without sudo'
