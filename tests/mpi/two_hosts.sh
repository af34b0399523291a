#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs a scene on two hosts that reach each other over TCP alone, and compares with one process:
#   two_hosts.sh RECKON WORK_FOLDER
# The hosts are two network namespaces of this machine with a cable between them, each with a host
# name of its own, so the ranks share neither memory nor loopback. Ends with 77 where the system
# does not let us make namespaces.
set -euo pipefail

reckon=$1
work=$2
first=reckon-$$-a
second=reckon-$$-b

skip() {
  echo "skipped: $1"
  exit 77
}
[[ $(id -u) -eq 0 ]] || skip "network namespaces need root"
for tool in ip unshare mpirun; do
  command -v "$tool" >/dev/null || skip "there is no $tool"
done
ip netns add "$first" 2>/dev/null || skip "network namespaces are not allowed here"
trap 'ip netns del "$first" 2>/dev/null; ip netns del "$second" 2>/dev/null' EXIT
ip netns add "$second"
ip link add cable netns "$first" type veth peer name cable netns "$second" 2>/dev/null ||
  skip "virtual network cables are not allowed here"
ip -n "$first" address add 10.77.0.1/24 dev cable
ip -n "$second" address add 10.77.0.2/24 dev cable
for host in "$first" "$second"; do
  ip -n "$host" link set cable up
  ip -n "$host" link set lo up
done

rm -rf "$work"
mkdir -p "$work"
# mpirun calls this instead of ssh: AGENT ADDRESS COMMAND...
cat >"$work/agent" <<END
#!/usr/bin/env bash
shift
exec ip netns exec $second unshare --uts sh -c 'hostname host-b; eval "\$0"' "\$*"
END
chmod +x "$work/agent"

cat >"$work/scene.toml" <<END
[contact]
normal_stiffness = "2 GN/m^3"
[body]
gravity = [0, 0, -9.81]
[[grains]]
library = "grains.h5"
[grains.fill]
count = 200
velocity = [0, 0, -1]
box = { low = [0, 0, 0], high = ["9 mm", "9 mm", "60 mm"] }
[[wall]]
name = "box"
box = { low = [0, 0, 0], high = ["9 mm", "9 mm", "60 mm"], open_top = true }
[time]
steps = 3000
[output]
checkpoint_interval = 1000
END
"$reckon" grains generate --count 3 --voxels-per-diameter 14 --nodes 150 -o "$work/grains.h5" >/dev/null
scene=$work/scene.toml
"$reckon" run "$scene" --out "$work/one" --quiet
ip netns exec "$first" unshare --uts sh -c 'hostname host-a; exec "$0" "$@"' \
  mpirun --oversubscribe --host 10.77.0.1:2,10.77.0.2:1 -np 3 \
  --mca plm_rsh_agent "$work/agent" --mca btl tcp,self \
  --mca btl_tcp_if_include 10.77.0.0/24 --mca oob_tcp_if_include 10.77.0.0/24 \
  "$reckon" run "$scene" --out "$work/three" --threads 1
"$reckon" diff "$work/one" "$work/three"
grep -q '"machines": 2' "$work/three/performance.json"
