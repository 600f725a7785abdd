# Completion for the programs of mrpt_semantic_octree, from what their --help says: options, commands, and the
# values that an option can have. Where these do not fit, files.
_mrpt_semantic_octree() {
  local word=$2 before=$3 help values
  COMPREPLY=()
  help=$({ "$1" --help-all || "$1" --help; } 2>/dev/null) || return
  values=
  if [[ $before =~ ^--?[a-z0-9-]+$ ]]; then # else it may be a file's name, and mean something to sed
    values=$(sed -n "s/^ *\\(-., *\\)\\?${before}[ ,].*{\\([a-z0-9_,]*\\)}.*/\\2/p" <<<"$help" | head -n 1)
  fi
  if [[ -n $values ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${values//,/ }" -- "$word")
  elif [[ $word == -* ]]; then
    values=$(grep -oE '^ +(-., *)?-[^ ]*' <<<"$help" | tr ',' ' ')
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word" | sort -u)
  elif [[ $COMP_CWORD == 1 ]]; then
    values=$(sed -n '/^Subcommands:/I,$s/^\([a-z0-9-]*\)$/\1/p' <<<"$help")
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
  fi
}
complete -o default -F _mrpt_semantic_octree rawlog2semantic-map semantic-map-compress semantic-map-drive \
  semantic-map-edit semantic-map-export semantic-map-info semantic-map-merge semantic-map-plan semantic-map-receive \
  semantic-map-ros2 semantic-map-send semantic-map-view dataset2rawlog synth-rawlog
