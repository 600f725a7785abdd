#!/bin/sh
# live-window.sh PICTURE RESULT PROGRAM ARGUMENTS...
# Runs a program that opens a window, and takes a picture of the screen on the way. When the file RESULT is there the window
# has to stay, and is closed, with the program $DROP_FILES. Ends as the program does.
picture=$1 result=$2
shift 2
"$@" &
program=$!
window=$(timeout 20 xdotool search --sync --onlyvisible --name "$(basename "$1")" | head -1)
sleep 3
import -window root "$picture"
timeout 60 sh -c 'until [ -e "$0" ]; do sleep 0.1; done' "$result"
sleep 1
kill -0 $program || { echo "live-window.sh: the window did not stay" >&2; exit 1; }
"$DROP_FILES" "$window"
wait $program
