# Completion of tribound for bash: commands, options, case files.

_tribound()
{
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local commands="init import mesh info schema check run sweep judge report verify study" command= word candidates=

  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ " $commands " == *" $word "* ]]; then
      command=$word
      break
    fi
  done

  case $previous in
    --directory | --restart)
      mapfile -t COMPREPLY < <(compgen -d -- "$current")
      compopt -o filenames 2>/dev/null
      return ;;
    --table)
      mapfile -t COMPREPLY < <(compgen -f -X '!*.csv' -- "$current"; compgen -d -- "$current")
      compopt -o filenames 2>/dev/null
      return ;;
    --solution)
      mapfile -t COMPREPLY < <(compgen -f -- "$current" | grep -E '[.](csv|msh|vtu|pvtu|vtk|frd|med)$'; compgen -d -- "$current")
      compopt -o filenames 2>/dev/null
      return ;;
    --jobs) candidates="1 2 4 8" ;;
    --refinements) candidates="1 2 3 4 5" ;;
    --set | --accept | --field | --stress | --step | --load-step | --number | --size | --merge | --region-array | --boundaries) return ;;
    *)
      case $command in
        "") candidates="$commands --help --version" ;;
        init) candidates="block hertz dam --directory --help" ;;
        import) candidates="--directory --accept --quiet --help" ;;
        mesh) candidates="--size --merge --ignore-elements --region-array --boundaries --quiet --help" ;;
        info | schema) candidates="--help" ;;
        report) candidates="--pdf --help" ;;
        check) candidates="--set --quiet --json --help" ;;
        run) candidates="--set --quiet --restart --help" ;;
        study) candidates="--set --quiet --help" ;;
        judge) candidates="--set --quiet --solution --interpolate --field --stress --steps --step --load-step --number --accept --help" ;;
        sweep) candidates="--set --table --jobs --resume --help" ;;
        verify) candidates="--set --quiet --refinements --help" ;;
      esac ;;
  esac

  if [[ $command =~ ^(check|run|sweep|judge|verify|study)$ && $current != -* && ! $previous =~ ^--(refinements|jobs)$ ]]; then
    mapfile -t COMPREPLY < <(compgen -f -X '!*.toml' -- "$current"; compgen -d -- "$current")
    compopt -o filenames 2>/dev/null
  elif [[ $command == report && $current != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
    compopt -o filenames 2>/dev/null
  elif [[ $command == import && $current != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -f -X '!*.inp' -- "$current"; compgen -d -- "$current")
    compopt -o filenames 2>/dev/null
  elif [[ $command == mesh && $current != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
    compopt -o filenames 2>/dev/null
  else
    mapfile -t COMPREPLY < <(compgen -W "$candidates" -- "$current")
  fi
}

complete -F _tribound tribound
