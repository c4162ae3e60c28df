# Bash completion for dupin: commands, options and what their values may be are asked from `dupin --help` itself.
_dupin() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} dupin=${COMP_WORDS[0]}
  if [ "$COMP_CWORD" -eq 1 ]; then
    local commands
    commands=$("$dupin" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
    COMPREPLY=($(compgen -W "$commands --help --version" -- "$word"))
    return
  fi
  local help
  help=$("$dupin" "${COMP_WORDS[1]}" --help 2>/dev/null)
  if [[ $before == -* ]]; then
    # A value that the help lists as {one,other} or TEXT:{one,other}.
    local values
    values=$(grep -E -- "(^|[ ,])$before[ ,]" <<<"$help" | sed -n 's/.*{\([^}]*\)}.*/\1/p' | head -n 1 | tr ',' ' ')
    if [ -n "$values" ]; then
      COMPREPLY=($(compgen -W "$values" -- "$word"))
      return
    fi
  fi
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(grep -oE -- '(^|[ ,])--?[a-z][a-z-]*' <<<"$help" | tr -d ', ' | sort -u)" -- "$word"))
    return
  fi
  COMPREPLY=($(compgen -f -- "$word"))
}
complete -o filenames -F _dupin dupin
