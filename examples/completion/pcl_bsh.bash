# SPDX-License-Identifier: BSD-3-Clause
# Completion for bash: the options that a program's own --help lists, and files. Installed under each program's name.
_pcl_bsh() {
  local word="${COMP_WORDS[COMP_CWORD]}"
  [[ "$word" == -* ]] || return 0 # what is no option is a file, or a value that only the user knows
  local options
  options="$("$1" --help 2>/dev/null | sed -n 's/^  \(-[^ ]*\).*/\1/p' | tr ',' '\n' | sed 's/\.TAG.*/./')"
  mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  [[ "${#COMPREPLY[@]}" != 1 || "${COMPREPLY[0]}" != *. ]] || compopt -o nospace
}

complete -o bashdefault -o default -F _pcl_bsh pcl_bsh_accuracy pcl_bsh_certify pcl_bsh_collide pcl_bsh_pipeline \
  pcl_bsh_scene pcl_bsh_tunnel pcl_bsh_view
