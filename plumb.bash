# bash completion for plumb. Printed by plumb --completion from the definitions of the command line.
_plumb_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}
_plumb() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "demo review import geometry calibrate monitor simulate inject noise convert campaign verify model upgrade --help --version" -- "$cur"))
    return
  fi
  case ${COMP_WORDS[1]} in
    demo)
      case "$prev" in
        --out) _plumb_files; return ;;
        --seed) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --out --seed" -- "$cur"))
      fi ;;
    review)
      case "$prev" in
        --html|--gravity) _plumb_files; return ;;
        --jobs) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --html --gravity --jobs --notes --json" -- "$cur"))
      else
        _plumb_files
      fi ;;
    import)
      case "$prev" in
        --out|--gravity) _plumb_files; return ;;
        --message|--align) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --out --message --align --rates --gravity" -- "$cur"))
      else
        _plumb_files
      fi ;;
    geometry)
      case "$prev" in
        --calibration|--plots) _plumb_files; return ;;
        --name|--samples|--noise) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --name --calibration --samples --noise --plots --check --json" -- "$cur"))
      else
        _plumb_files
      fi ;;
    calibrate)
      case "$prev" in
        --on-bad-row) COMPREPLY=($(compgen -W "skip stop" -- "$cur")); return ;;
        --array|--log|--motion|--calibration|--from|--out|--plots) _plumb_files; return ;;
        --form|--uncertainty|--instance|--export|--date|--serial|--known-attitude|--hold-out|--temperature-order|--use-range-degc|--roll-axis|--roll-axis-deviation-deg) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --array --log --motion --calibration --from --form --uncertainty --instance --export --out --date --serial --on-bad-row --known-attitude --paper --hold-out --temperature-order --use-range-degc --keep-outliers --roll-axis --roll-axis-deviation-deg --plots --suggest --json --verbose" -- "$cur"))
      fi ;;
    monitor)
      case "$prev" in
        --on-bad-row) COMPREPLY=($(compgen -W "skip stop" -- "$cur")); return ;;
        --array|--calibration|--log|--events|--verdicts|--report|--motion|--inclination|--incidents|--snapshot-in|--roll-test|--snapshot-out) _plumb_files; return ;;
        --incident-rows|--host|--date) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --array --calibration --calibrate-first --log --follow --events --verdicts --every-sample --report --motion --inclination --incidents --incident-rows --snapshot-in --roll-test --snapshot-out --host --on-bad-row --date --limits --json" -- "$cur"))
      fi ;;
    simulate)
      case "$prev" in
        --out|--truth|--array-out|--calibration) _plumb_files; return ;;
        --seed|--flight|--duration|--fault) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --seed --out --truth --array-out --flight --duration --calibration --fault" -- "$cur"))
      else
        _plumb_files
      fi ;;
    inject)
      case "$prev" in
        --on-bad-row) COMPREPLY=($(compgen -W "skip stop" -- "$cur")); return ;;
        --array|--log|--out) _plumb_files; return ;;
        --fault|--seed) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --array --log --fault --seed --out --on-bad-row" -- "$cur"))
      fi ;;
    noise)
      case "$prev" in
        --on-bad-row) COMPREPLY=($(compgen -W "skip stop" -- "$cur")); return ;;
        --array|--html|--plots) _plumb_files; return ;;
        --columns|--time|--rate|--unit|--block|--per-octave) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --array --columns --time --rate --unit --block --per-octave --html --plots --json --on-bad-row" -- "$cur"))
      else
        _plumb_files
      fi ;;
    convert)
      case "$prev" in
        --on-bad-row) COMPREPLY=($(compgen -W "skip stop" -- "$cur")); return ;;
        --array) _plumb_files; return ;;
        --log|--out) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --array --log --out --on-bad-row" -- "$cur"))
      fi ;;
    campaign)
      case "$prev" in
        --out|--replay) _plumb_files; return ;;
        --threads|--seed|--scenarios|--every) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --out --resume --threads --seed --scenarios --every --replay --json" -- "$cur"))
      else
        _plumb_files
      fi ;;
    verify)
      case "$prev" in
        --array|--limits|--calibration|--stations|--out|--compare|--test-results|--assurance|--traceability|--reuse|--resources) _plumb_files; return ;;
        --days-since-calibration|--known-attitude|--scenarios|--seed|--analysis|--threads) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --array --limits --calibration --days-since-calibration --stations --known-attitude --scenarios --thorough --seed --out --compare --test-results --assurance --traceability --reuse --analysis --resources --threads --pdf --json" -- "$cur"))
      fi ;;
    model)
      case "$prev" in
        --format) COMPREPLY=($(compgen -W "markdown dot json" -- "$cur")); return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --format" -- "$cur"))
      fi ;;
    upgrade)
      case "$prev" in
        --output) return ;;
      esac
      if [[ $cur == -* ]]; then
        COMPREPLY=($(compgen -W "--help -h --output --in-place" -- "$cur"))
      else
        _plumb_files
      fi ;;
  esac
}
complete -F _plumb plumb
