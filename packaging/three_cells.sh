#!/usr/bin/env bash
# Three simulated cells and a broker on this computer, to try what a plant's systems are told (docs/guide/plant.md).
#
#   packaging/three_cells.sh [FOLDER]
#
# FOLDER (three_cells if none is given) gets a folder of each cell, with its history and its messages. Needs mosquitto, and
# a partsight that was built with --features plant. From the environment:
#   PARTSIGHT   the program to run; partsight if not set
#   MQTT_PORT   where mosquitto listens; 1883 if not set
#   CELL_PORTS  where the cells listen, "30101 30102 30103" if not set
# Only programs on this computer can connect. Ctrl-C ends all.
set -euo pipefail
# Each program in a process group of its own: Ctrl-C reaches this script alone, which ends the cells before the broker.
set -m

partsight=${PARTSIGHT:-partsight}
mqtt_port=${MQTT_PORT:-1883}
read -r -a ports <<<"${CELL_PORTS:-30101 30102 30103}"
parts=(fender front_door trunk_lid)
calibration=$(cd "$(dirname "$0")" && pwd)/simulated_cell.toml
# Debian has mosquitto where only root's path leads.
PATH=$PATH:/usr/sbin

fail() {
    printf 'error: %s\n  to do: %s\n' "$1" "$2" >&2
    exit 2
}

case "${1:-}" in
-h | --help)
    # The comment at the top of this file.
    sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"
    exit
    ;;
-*) fail "there is no option $1" "Give a folder or nothing; --help explains the rest" ;;
esac
[ "${#ports[@]}" = 3 ] || fail "CELL_PORTS names ${#ports[@]} ports" "Name three, such as \"30101 30102 30103\""
command -v mosquitto >/dev/null || fail "there is no mosquitto" "Install it: sudo apt install mosquitto"
command -v "$partsight" >/dev/null || fail "there is no program $partsight" "Name it: PARTSIGHT=target/release/partsight"
mkdir -p "${1:-three_cells}"
folder=$(cd "${1:-three_cells}" && pwd)

cells=()
broker=
# Ends what was started: first the cells, which take leave of the broker.
stop() {
    trap '' INT TERM HUP
    for pids in "${cells[*]}" "$broker"; do
        [ -n "$pids" ] || continue
        # Some may have ended already.
        kill -INT $pids 2>/dev/null || true
        wait $pids || true
    done
}
trap stop EXIT
trap 'exit 0' INT TERM HUP

printf 'listener %s 127.0.0.1\nallow_anonymous true\n' "$mqtt_port" >"$folder/mosquitto.conf"
mosquitto -c "$folder/mosquitto.conf" >"$folder/mosquitto.log" 2>&1 </dev/null &
broker=$!
for i in 0 1 2; do
    name=cell$((i + 1))
    mkdir -p "$folder/$name"
    XDG_DATA_HOME=$folder/$name "$partsight" serve --source "simulated,fps=2:${parts[i]}" --as kuka \
        --calibration "$calibration" --listen "ascii=${ports[i]}" \
        --mqtt "mqtt://127.0.0.1:$mqtt_port/three_cells/$name" >"$folder/$name/messages.log" 2>&1 </dev/null &
    cells+=("$!")
done

cat <<TEXT
Three simulated cells (${parts[*]}); their histories and messages are in $folder

  mosquitto_sub -p $mqtt_port -t 'three_cells/#' -v
  printf 'TRIGGER\n' | nc 127.0.0.1 ${ports[0]}     (or ${ports[1]}, ${ports[2]})

Ctrl-C ends all.
TEXT

# None of them ends by itself, unless something is wrong.
wait -n || true
for log in "$folder"/mosquitto.log "$folder"/cell?/messages.log; do
    printf '\n%s\n' "$log" >&2
    tail -n 5 "$log" >&2
done
fail "a program has ended by itself" "Read its messages above"
