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
window=$(timeout 20 xdotool search --sync --onlyvisible --name 'MRPT project' | head -n 1)
sleep 2
xdotool windowmove "$window" 0 0 windowsize "$window" 1200 780
sleep 1
xdotool mousemove "$x" "$y" click 1
sleep 1
[ "$scroll" = 0 ] || xdotool click --repeat "$scroll" --delay 20 5
sleep 1
import -window root "$picture"
