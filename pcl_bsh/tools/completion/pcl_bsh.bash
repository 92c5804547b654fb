# SPDX-License-Identifier: BSD-3-Clause
# Completion for bash: the subcommands and options that a program's own --help lists, and files. Installed under each
# program's name.
_pcl_bsh() {
  local word="${COMP_WORDS[COMP_CWORD]}" command=("$1") subcommands options
  subcommands="$("$1" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')"
  if ((COMP_CWORD == 1)) && [[ "$word" != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$subcommands" -- "$word")
  elif [[ -n "$subcommands" ]] && grep -qx -- "${COMP_WORDS[1]}" <<<"$subcommands"; then
    command+=("${COMP_WORDS[1]}")
  fi
  [[ "$word" == -* ]] || return 0 # what is no option is a file, or a value that only the user knows
  options="$("${command[@]}" --help 2>/dev/null | sed -n 's/^  \(-[^ ]*\).*/\1/p' | tr ',' '\n' | sed 's/\.TAG.*/./')"
  mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  [[ "${#COMPREPLY[@]}" != 1 || "${COMPREPLY[0]}" != *. ]] || compopt -o nospace
}

complete -o bashdefault -o default -F _pcl_bsh pcl_bsh_accuracy pcl_bsh_arm pcl_bsh_certify pcl_bsh_collide pcl_bsh_gauge pcl_bsh_made_robot \
  pcl_bsh_pipeline pcl_bsh_scene pcl_bsh_self_filter pcl_bsh_site pcl_bsh_tunnel pcl_bsh_view
