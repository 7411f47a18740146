# What the trials beside this file share: a small study in five shards, undisturbed and through a driver, one shard's process
# killed on the way. Knows pontoon's folders; does not know an engine. Whoever reads this has `set -euo pipefail`.

cluster=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$cluster/../tools.bash"
shards=5
driver=''
work=$(mktemp -d)
out=$work/results

fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# Ends what a trial started, come what may; `end_engine` is the trial's own.
end() {
  local status=$?
  trap '' INT TERM
  if [[ -n $driver ]] && kill -TERM "$driver" 2>/dev/null; then wait "$driver" || true; fi
  if declare -F end_engine >/dev/null; then end_engine || true; fi
  if ((status && status != 130)); then tail -n 5 "$work"/*.log "$out"/logs/*.err >&2 2>/dev/null || true; fi
  rm -rf "$work"
  exit "$status"
}
trap end EXIT
trap 'exit 130' INT TERM

program
export PONTOON_CACHE_DIR=$work/cache

# A few hundred crossings of a coarse bridge, at a time step so small that a shard can be met in its middle.
small_study() {
  cp "$root/studies/bridges/smoke.json" "$work/bridge.json"
  cat >"$work/study.json" <<'END'
{
  "name": "trial",
  "bridge": "bridge.json",
  "vehicle": { "footprint_length_m": 3.35, "track_y_m": [-1.4, 1.4], "inertia": "local" },
  "analysis": { "kind": "crossing", "time_step_s": 0.0005, "tail_s": 1.0 },
  "design": [ { "grid": { "gap_tension_m": { "linspace": [0.0, 0.03, 12] }, "gap_compression_m": 0.0055,
                          "speed_m_s": [10, 12, 14, 16, 18, 20], "load_n": { "linspace": [5e4, 2e5, 4] } } } ],
  "record": { "histories": { "positions": [2], "joints": [] } }
}
END
}

# The study in one process, to compare with.
undisturbed() { "$PONTOON" run "$work/study.json" --out "$work/undisturbed" --quiet >/dev/null; }

# Starts a driver on the study; later words are its own.
drive() {
  "$cluster/$1" "$work/study.json" --shards "$shards" --out "$out" "${@:2}" >"$work/driver.log" 2>&1 &
  driver=$!
}

# Waits for a driver's good end.
driven() {
  local status=0
  wait "$driver" || status=$?
  driver=''
  grep -E '^(slurm|hyperqueue):' "$work/driver.log" >&2 || true
  ((status == 0)) || fail "the driver ended with status $status"
}

# Waits until a shard has done some of its jobs; `pid` is then its process.
in_the_middle() {
  local folder=$out/shards/$1-of-$shards said deadline=$((SECONDS + 120))
  while :; do
    ((SECONDS < deadline)) || fail "shard $1 did not begin"
    kill -0 "$driver" 2>/dev/null || fail "the driver ended before shard $1 was in its middle"
    # not before the shard's process holds its folder
    if [[ -s $folder/lock ]] && said=$("$PONTOON" status "$folder" --format json 2>/dev/null) &&
      [[ $said =~ \"state\":\ *\"running\" && $said =~ \"done\":\ *([0-9]+) ]] && ((BASH_REMATCH[1] > 0)); then
      read -r _ pid _ <"$folder/lock"
      return
    fi
    sleep 0.02
  done
}

kill_in_the_middle() {
  in_the_middle "$1"
  [[ $(readlink "/proc/$pid/exe") == "$PONTOON" ]] || fail "process $pid of shard $1 is not pontoon"
  kill -KILL "$pid"
  echo "shard $1: process $pid killed"
}

# Refuses a merged study none of whose processes ended in a way, or whose tables are not those of the undisturbed one.
ended() { grep -Eq "\"ended\": *\"$1\"" "$out/manifest.json" || fail "no process of the merged study $1: it ran undisturbed"; }
same_tables() {
  local names table
  names=$(cd "$work/undisturbed" && ls -- *.parquet *.csv)
  [[ $(cd "$out" && ls -- *.parquet *.csv) == "$names" ]] || fail 'other tables than those of the undisturbed run'
  for table in $names; do
    cmp "$work/undisturbed/$table" "$out/$table" || fail "$table differs"
  done
  echo "$shards shards through $1: $(wc -w <<<"$names") tables, the same to the last byte"
}
