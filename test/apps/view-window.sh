#!/bin/bash
# view-window.sh OUTPUT PROGRAM ARGUMENTS... -- STEPS...
# Runs a program that opens a window, does one step after the other, and ends the program. A step "X Y WORDS" clicks there
# and waits until the program has said the words once more; "drag X Y X2 Y2 WORDS" drags once; "drop FILE WORDS" drops
# the file onto the window, with the program $DROP_FILES; "picture FILE" takes one of the screen. Without waiting for words:
# "touch X Y" clicks, "enter X Y TEXT" enters, "wheel X Y N" turns the wheel N times forward there, "key NAME" presses a key;
# each is on the screen half a second later. What the program says goes to OUTPUT. Fails if a window or words do not come.
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
press() { xdotool mousemove --window "$window" "$x" "$y" sleep 0.2 mousedown 1 sleep 0.2; }
enter() { xdotool sleep 0.2 key ctrl+a sleep 0.2 type "$text" && xdotool sleep 0.2 key Return; }
for step in "$@"; do
  kind=click
  case $step in
    "picture "*) import -window root "${step#picture }"; continue ;;
    "touch "*) read -r kind x y <<< "$step"; press; xdotool mouseup 1 sleep 0.5; continue ;;
    "enter "*) read -r kind x y text <<< "$step"; press; xdotool mouseup 1; enter; sleep 0.5; continue ;;
    "wheel "*) read -r kind x y n <<< "$step"
      xdotool mousemove --window "$window" "$x" "$y" sleep 0.2 click --repeat "$n" --delay 100 4 sleep 0.5; continue ;;
    "key "*) xdotool key "${step#key }" sleep 0.5; continue ;;
    "drag "*) read -r kind x y x2 y2 words <<< "$step" ;;
    "drop "*) read -r kind file words <<< "$step" ;;
    *) read -r x y words <<< "$step" ;;
  esac
  before=$(grep -c -- "$words" "$output")
  for ((i = 0; ; i++)); do
    # A click may come before the first frame, or while meshes are made: again every few seconds.
    if [[ $kind == drop ]]; then
      ((i > 0)) || timeout 60 "$DROP_FILES" "$window" "$file" || fail "cannot drop $file"
    elif ((i % 50 == 0)) && [[ $kind != drag || $i -eq 0 ]]; then
      press
      [[ $kind == drag ]] && xdotool mousemove --window "$window" "$x2" "$y2" sleep 0.2
      xdotool mouseup 1
    fi
    (($(grep -c -- "$words" "$output") > before)) && break
    if ((i == 1000)) || ! kill -0 $child; then fail "no '$words' after '$step'"; fi
    sleep 0.1
  done
done
