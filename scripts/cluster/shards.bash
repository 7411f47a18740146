# shellcheck disable=SC2034 # drivers read what is set here
# A study in shards, for the drivers beside this file: their arguments, which shards are not complete, the merge. Knows
# pontoon's folders and exit statuses. What starts a shard is told by the driver that reads this:
#   option NAME [VALUE...]  takes an option of its own and sets `taken` to the words that it took; fails where it is none
#   check                   refuses what its own options cannot have
#   start K...              runs shards to their ends, good or not, with their output in `answer` and `errors` of each; fails
#                           where they could not be started at all
# Words after `--` are left to it in `more`.

program=$(basename "$0")
cluster=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$cluster/../tools.bash"
study='' shards='' out='' threads=1 resubmit=3 pontoon=${PONTOON:-} instructions=()
more=()

# shards beyond this do not fit a command line
most_shards=10000

note() { printf '%s: %s\n' "$program" "$*" >&2; }
refuse() { note "$@"; exit 2; }
give_up() { note "$@"; exit 3; }

# A driver's first lines are its help.
help() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }

# Refuses an option without a value, or whose value is no whole number from a least one up.
value() { (($# > 1)) || refuse "$1 takes a value"; }
number() {
  value "${@:2}"
  if [[ ! $3 =~ ^(0|[1-9][0-9]{0,5})$ ]] || (($3 < $1)); then
    refuse "$2: found $3, allowed: a whole number from $1"
  fi
}

arguments() {
  while (($#)); do
    case $1 in
      --) more=("${@:2}") && break ;;
      --*=*) set -- "${1%%=*}" "${1#*=}" "${@:2}" ;;
    esac
    local taken=2
    case $1 in
      -h | --help) help && exit 0 ;;
      --shards) number 1 "$@" && shards=$2 ;;
      --threads) number 1 "$@" && threads=$2 ;;
      --resubmit) number 0 "$@" && resubmit=$2 ;;
      --out) value "$@" && out=$2 ;;
      --pontoon) value "$@" && pontoon=$2 ;;
      --any-instructions) instructions=(--any-instructions) && taken=1 ;;
      -*) option "$@" || refuse "$1: no option of this driver; --help tells them" ;;
      *) [[ -z $study ]] || refuse "one study, not both $study and $1" && study=$1 && taken=1 ;;
    esac
    shift "$taken"
  done
  [[ -n $study ]] || refuse 'no study; --help tells what to give'
  [[ -n $shards ]] || refuse 'no --shards'
  ((shards <= most_shards)) || refuse "--shards: found $shards, allowed: at most $most_shards"
  check
  find_pontoon
  # a study that is refused is refused before anything is submitted
  local plan status=0
  plan=$("$pontoon" plan "$study" --format json) || status=$?
  ((status == 0)) || exit "$status"
  if [[ -z $out ]]; then
    [[ $plan =~ \"study\":\ *\"([^\"]+)\" ]] || give_up "no name in the plan of $study: give --out"
    out=results/${BASH_REMATCH[1]}
  fi
  # shards start elsewhere
  study=$(realpath -s -- "$study")
  out=$(realpath -ms -- "$out")
}

find_pontoon() {
  if [[ -z $pontoon ]]; then
    pontoon=$built/pontoon
    [[ -x $pontoon ]] || refuse "$pontoon is not built: cargo build --profile $profile -p pontoon, or give --pontoon"
  fi
  local found
  found=$(command -v -- "$pontoon") && [[ -f $found && -x $found ]] || refuse "--pontoon: found $pontoon, allowed: the program"
  pontoon=$(realpath -s -- "$found")
}

folder() { printf '%s/shards/%s-of-%s' "$out" "$1" "$shards"; }

# What a shard's processes said: the errors of all of them, and the answer of the last one, which has none unless it came to
# its end.
errors() { printf '%s/logs/%s-of-%s.err' "$out" "$1" "$shards"; }
answer() { printf '%s/logs/%s-of-%s.out' "$out" "$1" "$shards"; }

# The shards that are not done: their folders do not say that they are complete, or they say so of the study as it was before,
# since no process of this driver came to its end there.
incomplete() {
  local k said
  # asks a shared file system for the folder's files as they are now
  ls "$out/logs" >/dev/null || return
  for ((k = 0; k < shards; k++)); do
    said=$("$pontoon" status "$(folder "$k")" --format json 2>/dev/null) || said=''
    [[ $said =~ \"state\":\ *\"complete\" && -s $(answer "$k") ]] || echo "$k"
  done
}

# Shards with a comma between them, to be told or submitted.
commas() { local IFS=,; printf '%s' "$*"; }

tell_errors() {
  local k
  for k in "$@"; do
    [[ -s $(errors "$k") ]] || continue
    note "shard $k, last in $(errors "$k"):"
    tail -n 1 "$(errors "$k")" >&2
  done
}

merge() {
  local k names=() status=0
  for ((k = 0; k < shards; k++)); do names+=("$k-of-$shards"); done
  cd "$out/shards" || return 3
  "$pontoon" merge "${names[@]}" --out "$out" --quiet "${instructions[@]}" || status=$?
  return "$status"
}

# All of it: shards started, those that are not complete started again, the merge. Ends with the status of the merge.
drive() {
  arguments "$@"
  mkdir -p "$out/shards" "$out/logs" || give_up "$out: no folder of results can be made there"
  local todo round left status=0
  # all of them: a folder that is complete is so for the study that it was run with, which may have grown since
  rm -f "$out"/logs/*-of-"$shards".out
  mapfile -t todo < <(seq 0 $((shards - 1)))
  for ((round = 0; ; round++)); do
    start "${todo[@]}" || give_up 'could not go on; what the shards did is kept, the same command goes on from there'
    left=$(incomplete) || give_up "$out/logs cannot be read"
    [[ -n $left ]] || break
    mapfile -t todo <<<"$left"
    if ((round == resubmit)); then
      tell_errors "${todo[@]:0:5}"
      give_up "shards $(commas "${todo[@]}") of $shards are not complete after $((round + 1)) rounds"
    fi
    note "shards $(commas "${todo[@]}") of $shards are not complete: submitted again"
  done
  merge || status=$?
  exit "$status"
}
