#!/bin/sh
# viewer.sh PICTURE X Y SCROLL PROGRAM ARGUMENTS...
# Runs one of MRPT's viewers on the display it is given, clicks at a place of its window, turns the
# mouse's wheel, and takes a picture of the screen. RawLogViewer's tip of the day is switched off.
set -e
picture=$1 x=$2 y=$3 scroll=$4
shift 4
mkdir -p "$HOME/.RawLogViewer"
printf '[tips]\nshow=0\n' > "$HOME/.RawLogViewer/config.cfg"

"$@" &
viewer=$!
trap 'kill $viewer' EXIT

# Waits until the viewer has rested for a second, at most a minute: how long it works depends on what else runs.
rest() {
  resting=0 before=
  for _ in $(seq 120); do
    sleep 0.5
    now=$(awk '{ print $14 + $15 }' "/proc/$viewer/stat")  # processor time, 1/100 s
    if [ -n "$before" ] && [ $((now - before)) -le 1 ]; then resting=$((resting + 1)); else resting=0; fi
    [ "$resting" -lt 2 ] || return 0
    before=$now
  done
}

window=$(timeout 60 xdotool search --sync --onlyvisible --name 'MRPT project' | head -n 1)
rest
xdotool windowmove "$window" 0 0 windowsize "$window" 1200 780
rest
xdotool mousemove "$x" "$y" click 1
rest
[ "$scroll" = 0 ] || xdotool click --repeat "$scroll" --delay 20 5
rest
import -window root "$picture"
