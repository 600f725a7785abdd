#!/bin/bash
# view-window.sh OUTPUT PROGRAM ARGUMENTS... -- STEPS...
# Runs a program that opens a window, does one step after the other, and ends the program. A step "X Y WORDS" clicks there
# and waits until the program has said the words once more; "drag X Y X2 Y2 WORDS" drags once; "picture FILE" takes one of the screen. What the program says goes to
# OUTPUT. Fails if a window or words do not come.
output=$1 program=()
shift
while [[ $# -gt 0 && $1 != -- ]]; do program+=("$1"); shift; done
shift
: > "$output"
"${program[@]}" >> "$output" 2>&1 &
child=$!
trap 'kill $child 2> /dev/null; wait $child' EXIT
fail() { echo "view-window.sh: $*" >&2; cat "$output" >&2; exit 1; }

window=$(timeout 120 xdotool search --sync --onlyvisible --name "^$(basename "${program[0]}")\$" | head -1)
[[ -n $window ]] || fail "no window"
for step in "$@"; do
  if [[ $step == "picture "* ]]; then import -window root "${step#picture }"; continue; fi
  drag=
  if [[ $step == "drag "* ]]; then read -r _ x y x2 y2 words <<< "$step"; drag=1; else read -r x y words <<< "$step"; fi
  before=$(grep -c -- "$words" "$output")
  for ((i = 0; ; i++)); do
    # A click may come before the first frame, or while meshes are made: again every few seconds.
    [[ $drag && $i -eq 0 ]] && xdotool mousemove --window "$window" "$x" "$y" sleep 0.2 mousedown 1 sleep 0.2 \
      mousemove --window "$window" "$x2" "$y2" sleep 0.2 mouseup 1
    [[ ! $drag ]] && ((i % 50 == 0)) && xdotool mousemove --window "$window" "$x" "$y" sleep 0.2 mousedown 1 sleep 0.2 mouseup 1
    (($(grep -c -- "$words" "$output") > before)) && break
    if ((i == 1000)) || ! kill -0 $child; then fail "no '$words' after a click at $x $y"; fi
    sleep 0.1
  done
done
