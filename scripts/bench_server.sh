#!/usr/bin/env bash
# Compares `stipple serve` with nginx (Debian's, 2 workers, sendfile, tcp_nopush off, tcp_nodelay on) on random
# ranges of one 2 GiB cloud, kept-alive connections, in turns, and prints a table: requests a second, 99 % latency,
# processor time a request (the server's alone), resident memory. Ratios are stipple / nginx of one round; the
# table has their medians and extremes. Needs wrk and nginx: scripts/install_dependencies.sh --with-server-bench
#   scripts/bench_server.sh [--rounds 3] [--seconds 3] [--ranges "4096 65536 1048576"]
#                           [--connections "16 64 256 1000"] [--tls] [-- OPTIONS OF serve]
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build/bench
scripts/install_dependencies.sh --with-server-bench
. scripts/environment.sh
rounds=3 seconds=3 ranges="4096 65536 1048576" connections="16 64 256 1000" scheme=http
serve_options=()
while [ $# -gt 0 ]; do
  case "$1" in
    --rounds) rounds=$2; shift 2 ;;
    --seconds) seconds=$2; shift 2 ;;
    --ranges) ranges=$2; shift 2 ;;
    --connections) connections=$2; shift 2 ;;
    --tls) scheme=https; shift ;;
    --) shift; serve_options=("$@"); break ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
done
ulimit -n "$(ulimit -Hn)"
work=$PWD/build/bench
stipple=$PWD/build/release/client/headless/stipple
configure_and_build release stipple pad_cloud
large=$work/www/clouds/large.stipple
if [ "$(stat -c %s "$large" 2>/dev/null)" != 2147483648 ]; then
  mkdir -p "$work/www/clouds"
  "$stipple" synth "$work/small.las" --points 2000 --scene terrain --seed 1 >/dev/null
  "$stipple" convert "$work/small.las" -o "$large" --progress none >/dev/null
  build/release/tests/bench/pad_cloud "$large" 2147483648
fi
cat "$large" >/dev/null # into the page cache

nginx_tls= listen_ssl=
if [ "$scheme" = https ]; then
  [ -e "$work/key.pem" ] || openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 30 \
    -subj /CN=localhost -keyout "$work/key.pem" -out "$work/cert.pem" 2>/dev/null
  serve_options+=(--cert "$work/cert.pem" --key "$work/key.pem")
  listen_ssl=" ssl"
  nginx_tls="ssl_certificate $work/cert.pem; ssl_certificate_key $work/key.pem; ssl_protocols TLSv1.2 TLSv1.3;"
fi
nginx_port=18019
cat >"$work/nginx.conf" <<END
daemon off; worker_processes 2; pid $work/nginx.pid; error_log $work/nginx.log; user $(id -un) $(id -gn);
events { worker_connections 4096; }
http {
  access_log off; sendfile on; tcp_nopush off; tcp_nodelay on;
  keepalive_timeout 600; keepalive_requests 1000000000; default_type application/octet-stream;
  server { listen 127.0.0.1:$nginx_port$listen_ssl; root $work/www; $nginx_tls }
}
END
cat >"$work/ranges.lua" <<'END'
local size, total = tonumber(os.getenv("RANGE_BYTES")), 2147483648
local requests, at = {}, 0
init = function()
  math.randomseed(os.time())
  for i = 1, 8192 do
    local first = math.random(0, total - size)
    requests[i] = wrk.format("GET", nil, { Host = "localhost", Range = "bytes=" .. first .. "-" .. first + size - 1 })
  end
end
request = function()
  at = at % #requests + 1
  return requests[at]
end
done = function(summary, latency)
  local errors = summary.errors
  io.write(string.format("RESULT %d %.6f %.3f %.3f %d %.0f\n", summary.requests, summary.duration / 1e6, latency:percentile(50) / 1e3,
    latency:percentile(99) / 1e3, errors.connect + errors.read + errors.write + errors.status + errors.timeout, summary.bytes))
end
END

"$stipple" serve "$large" --port 0 --json --connections-per-client 4096 "${serve_options[@]}" >"$work/serve.json" &
ours=$!
nginx -c "$work/nginx.conf" -p "$work" &
theirs=$!
trap 'kill $ours $theirs 2>/dev/null || true; wait 2>/dev/null || true' EXIT
until [ -s "$work/serve.json" ] && [ -s "$work/nginx.pid" ]; do sleep 0.1; done
our_port=$(sed 's/.*"port":\([0-9]*\).*/\1/' "$work/serve.json")
address() { [ "$1" = ours ] && echo "$scheme://localhost:$our_port" || echo "$scheme://localhost:$nginx_port"; }
processes() { [ "$1" = ours ] && echo "$ours" || pgrep -P "$theirs"; }
# Seconds of processor time, and MB resident, of a server.
cpu() { for p in $(processes "$1"); do cat "/proc/$p/stat"; done | awk -v tick="$(getconf CLK_TCK)" '{ s += $14 + $15 } END { print s / tick }'; }
rss() { for p in $(processes "$1"); do cat "/proc/$p/status"; done | awk '/VmRSS/ { s += $2 } END { print s / 1024 }'; }

# measure SERVER RANGE CONNECTIONS -> requests/s, p99 ms, µs a request, MB, errors
measure() {
  local before after result
  before=$(cpu "$1")
  result=$(RANGE_BYTES=$2 wrk -t2 -c"$3" -d"${seconds}s" --timeout 30s -s "$work/ranges.lua" "$(address "$1")/clouds/large.stipple" | grep RESULT)
  after=$(cpu "$1")
  awk -v r="$result" -v b="$before" -v a="$after" -v m="$(rss "$1")" -v size="$2" 'BEGIN {
    split(r, f, " ")
    if (f[7] < f[2] * size) f[6] += 1 # short answers
    printf "%.0f %.3f %.3f %.1f %d\n", f[2] / f[3], f[5], (a - b) * 1e6 / f[2], m, f[6] }'
}
median() { sort -g | awk '{ v[NR] = $1 } END { printf "%s", v[int((NR + 1) / 2)] }'; }

printf '| range | connections | requests/s | nginx | ratio | p99 ms | nginx | ratio | µs CPU a request | nginx | ratio | RSS MB | nginx |\n'
printf '|---|---|---|---|---|---|---|---|---|---|---|---|---|\n'
failed=0
for range in $ranges; do
  for count in $connections; do
    rows=$work/rows
    : >"$rows"
    for ((round = 0; round < rounds; ++round)); do
      if ((round % 2 == 0)); then
        a=$(measure ours "$range" "$count") b=$(measure theirs "$range" "$count")
      else
        b=$(measure theirs "$range" "$count") a=$(measure ours "$range" "$count")
      fi
      echo "$a $b" >>"$rows"
    done
    column() { awk "{ print $1 }" "$rows" | median; }
    spread=$(awk '{ r = $1 / $6; if (NR == 1 || r < l) l = r; if (r > h) h = r } END { printf "%.2f-%.2f", l, h }' "$rows")
    printf '| %s | %s | %.0f | %.0f | **%.2f** (%s) | %.2f | %.2f | %.2f | %.1f | %.1f | %.2f | %.0f | %.0f |\n' "$range" "$count" \
      "$(column '$1')" "$(column '$6')" "$(column '$1/$6')" "$spread" "$(column '$2')" "$(column '$7')" "$(column '$2/$7')" \
      "$(column '$3')" "$(column '$8')" "$(column '$3/$8')" "$(column '$4')" "$(column '$9')"
    awk '$5 > 0 || $10 > 0 { bad = 1 } END { exit bad }' "$rows" || { echo "errors or short answers: $(awk '{ print $5, $10 }' "$rows" | tr '\n' ';')"; failed=1; }
  done
done
exit $failed
