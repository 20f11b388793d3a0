# Completion of spindrift's commands, options and files for bash. Installed into share/bash-completion/completions.
_spindrift() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]:-} before=${COMP_WORDS[COMP_CWORD-1]}
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "run check grid study import reference report profile replay picture film help --help --version" -- "$word"))
    return
  fi
  case $before in
    --set | --until | --seconds | --rate | --time | --windows | --ranks | --threads | --nodes | --network | --skew) return ;;
    --fluid) COMPREPLY=($(compgen -W "air sea" -- "$word")); return ;;
    --camera) COMPREPLY=($(compgen -W "scene side front top rotor" -- "$word")); return ;;
  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$("${COMP_WORDS[0]}" "$command" --help 2>/dev/null | grep -oE -- '--[a-z-]+' | sort -u)" -- "$word"))
    return
  fi
  case $command in
    run | check | grid | study | profile) COMPREPLY=($(compgen -f -X '!*.toml' -- "$word") $(compgen -d -- "$word")) ;;
    import) COMPREPLY=($(compgen -f -X '!*.fst' -- "$word") $(compgen -f -X '!*.yaml' -- "$word") $(compgen -d -- "$word")) ;;
    report | picture | film) COMPREPLY=($(compgen -d -- "$word")) ;;
    replay) COMPREPLY=($(compgen -f -X '!*.jsonl' -- "$word") $(compgen -d -- "$word")) ;;
    help) COMPREPLY=($(compgen -W "run check grid study import reference report profile replay picture film" -- "$word")) ;;
  esac
}
complete -o filenames -F _spindrift spindrift
