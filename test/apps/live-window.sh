#!/bin/sh
# live-window.sh PICTURE PROGRAM ARGUMENTS...
# Runs a program that opens a window, and takes a picture of the screen on the way. Ends as the program does.
picture=$1
shift
"$@" &
program=$!
timeout 20 xdotool search --sync --onlyvisible --name "$(basename "$1")" > /dev/null
sleep 3
import -window root "$picture"
wait $program
